# wrong uses of subsystems and ports: line, column, hint, and the model as it was
leg='scene planar
c = 2
body out mass=1 inertia=1
revolute hout ground out
subsystem leg frames=[A, B] terminals=[e] through=[o]
  L = 0.4 m
  body l mass=3 inertia=0.04
  arm a l [-L/2, 0]
  arm B l [L/2, 0]
  revolute th A a
  resistor R e o 10 ohm
  resistor Q o 0 10 ohm
end
'
try() {
    printf '%s%s\n' "$leg" "$1" >wrong.ct
    echo "--- $1"
    cotree -q wrong.ct 2>&1 && echo 'NOT REFUSED'
}
made='use leg l1 A=ground e=v'
try 'use lag l1 A=ground e=v'
try 'use leg l1 e=v'
try 'use leg l1 A=ground'
try "$made B=out"
try "$made o=w"
try "$made K=2"
try 'use leg l1 A=nowhere e=v'
try 'use leg l1 A=hout e=v'
try 'use leg l1 A=ground e=ground'
try 'use leg l1 l2 A=[ground, out, out] e=v'
try "$made L=3 kg"
try "$made L=hout"
try 'use leg out A=ground e=v'
try "$made; $made"
try "$made; spring k l1.l out k=1 length=1"
try "$made; motor M l1.th x 0 R=1 L=1 Kt=1 Kv=1"
try "$made; resistor R l1.x 0 1"
try "$made; use leg l2 A=l1.a e=v"
try "$made; print l1.l3.x"
try "$made; print l1.te"
try "$made; print l1"
try "$made; print leg"
try "$made; tree l1.l3"
try "$made; delete l1.th"
try "$made; delete leg"
try "$made; set l1.L = 2 kg"
try "$made; set l1.l.mass = -2"
try "$made; l1.L = 3"
try "$made L=c*1; c = l1.L"
try 'subsystem leg frames=[A]'
try 'subsystem s frames=[A, A]'
try 'subsystem s frames=[ground]'
try 'subsystem s ports=[A]'
try 'subsystem s frames=[A]
spring k out A k=1 length=1'
try 'subsystem s frames=[A]
body b mass=m1 inertia=1'
try 'subsystem s frames=[A]
body b mass=1 inertia=1
simulate 2'
try 'subsystem s frames=[A]
body b mass=1 inertia=1
end'
try 'subsystem s frames=[A]
body b mass=1 inertia=1
revolute h A b
arm A b [0, 1]'
try 'subsystem s frames=[A]
body b mass=1 inertia=1
revolute h A b
tree + h'
try 'subsystem s terminals=[a]
R = 1
R = 2'
try end
try 'subsystem s terminals=[a]
resistor R a 0 1
subsystem z'
try 'subsystem inner frames=[A]
m = 1
body b mass=m inertia=1
weld w A b
end
subsystem s frames=[A]
n = 2
use inner i A=A m=3*n - 5
end
use s a A=ground
use s b A=ground n=1'
try 'subsystem inner frames=[A]
body b mass=1 inertia=1
weld w A b
end
subsystem s frames=[A]
use inner i A=A
revolute h A i.b'
try "$made; use out l2"
try "$made; set l1.A = out"
try "$made; set leg.L = 2"
try "$made; use leg l2 A=l1 e=v"
try "$made; use leg l2 A=l2.B e=v"
try "$made; use leg l2 A=0 e=v"
try "$made; use leg l2 A=l1.B e=v L=t"
try "$made; use leg l2 A=l1.B e=v L=[1, 2, 3]"
try "$made; use leg l2 A=l1.B A=out e=v"
try "$made; use leg l2 l2 A=l1.B e=v"
try "$made; use"
try "$made; use leg"
try "$made; subsystem l1 frames=[A]"
try "$made; subsystem ground frames=[A]"
try "$made; driver D l1.th = t by=l1.tx"
try "$made; show cutsets l1.l4"
try 'subsystem s frames=[A]
use s i A=A'
try 'subsystem s frames=[A]
gravity [0, 1]'
try 'subsystem s frames=[A, 1]'
printf 'subsystem a frames=[A]\nrevolute h A q\nbody b mass=1 inertia=[1, 1, 1]\nrevolute h A b\nend
use a x A=ground\ninit x.h = 2\nprint x.h\n' >again.ct
echo '--- a wrong line, and the right one after it'
cotree -q -k again.ct 2>&1
try 'revolute l1.h ground out'
true
