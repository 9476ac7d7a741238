# subsystems: made, looked at, changed, saved, taken back and done again
cat >rods.ct <<'END'
scene planar
gravity [0, -9.81]
k = 2
f(x) = k*x
subsystem rod frames=[A, B] terminals=[e] through=[o]
  L = 0.5 m
  g(x) = f(x) + L/1[m]
  body b mass=k inertia=0.02 # a comment
  arm a b [0, L/2]
  arm B b [0, -L/2]
  revolute h A a coord=th
  resistor R e o 10
  sensor s th' c 0 gain=g(2)
  resistor R2 c o \
    5
  output x2 = 2*b.x, y2 = B.y + A.y
  event ev when=th > 4 do=mark
  init th = 10 deg
  tree h
end
use rod u A=ground e=0
use rod v w A=[u.B, v.B] L=[0.3, 0.2] m e=[n, u.o]
vsource V n 0 1
init v.th = 1, u.th = 0.2
END
cat >look.ct <<'END'
show tree
print u.th, v.th, v.x2, v.y2 - v.B.y - u.B.y, w.b.x, v.L, v.o.v
END
cotree -q rods.ct look.ct
echo '--- set, save, and what that makes'
cotree -q -e 'source "rods.ct"; set v.L = 0.4; set w.b.mass = 3; set v.L = 0.45; save "saved.ct"' \
    -e 'print w.B.y; simulate 0.1; print w.B.y, v.h.fx'
cat saved.ct
cotree -q saved.ct -e 'print w.B.y; simulate 0.1; print w.B.y, v.h.fx; save "again.ct"'
cmp saved.ct again.ct
echo '--- a law and a parameter of the model reach inside'
cotree -q rods.ct -e 'f(x) = 3*k*x; print v.s.v; k = 4; print v.s.v; init u.th'"'"' = 1' \
    -e 'print u.s.v; show mass 2 2'
echo '--- told'
cotree -q rods.ct -e 'info v; info rod; info v.h; show params'
echo '--- offered'
cotree -q rods.ct -e 'complete use r' -e 'complete use rod z ' -e 'complete print v.' \
    -e 'complete set v.L' -e 'complete print v.h.f' -e 'complete delete v'
echo '--- back and forth'
cat >back.ct <<'END'
subsystem low terminals=[a] through=[b]
  R = 1 kohm
  resistor R1 a b R
  capacitor C1 b 0 1 uF
  init C1.v = 2
end
vsource E in 0 1
use low f g a=[in, f.b]
undo
undo
undo
undo
redo
redo
redo
print g.C1.v
init none
save "low.ct"
delete f
delete g
delete f
delete low
use low f a=in
undo
undo
use low f a=in
print f.C1.v
END
cotree -k back.ct 2>&1
cat low.ct
echo '--- in parts, and in a file that ends too early'
cotree -q -e 'subsystem s terminals=[a]' -e 'resistor R a 0 2' -e end -e 'use s x a=n' \
    -e 'isource I 0 n 3' -e 'print x.R.v'
printf 'R = 1\nsubsystem s terminals=[a]\nresistor R a 0 2\n' >early.ct
cotree early.ct 2>&1
echo "status $?"
cotree -e 'source "early.ct"' -i -e 'print R' 2>&1 </dev/null
echo '--- a terminal on which nothing stands'
cotree -e 'subsystem s terminals=[a]; vcvs E o 0 a 0 gain=2; resistor R o 0 1; end' 2>&1
cat >open.ct <<'END'
subsystem s terminals=[a]
  vsource E o 0 2*a.v
  resistor R o 0 1
end
use s x a=n
print model.n
show network
simulate 1
print x.R.i
vsource V n 0 3
print x.R.i
END
cotree -k open.ct 2>&1
true
echo '--- inside a definition, one bound to a port of the one before it'
cat >chain.ct <<'END'
scene planar
gravity [0, -9.81]
subsystem rod frames=[A, B] terminals=[e] through=[o]
  L = 1
  body l mass=1 inertia=0.1
  arm k l [-L/2, 0]
  arm B l [L/2, 0]
  revolute th A k
  resistor R1 e o 1
  resistor R2 o 0 th + 2
end
END
cat >nested.ct <<'END'
subsystem pair frames=[A, B] terminals=[e] through=[o]
  use rod a b A=[A, a.B] L=[1, 2] e=[e, a.o]
  arm B b.B [0.1, 0]
  resistor R b.o o 3
  resistor R0 o 0 4
end
subsystem four frames=[A] terminals=[e]
  use pair p q A=[A, p.B] e=[e, p.o]
  body m mass=2 inertia=1
  weld w q.B m
end
use four s A=ground e=n
vsource V n 0 5
init s.p.a.th = 0.1, s.p.b.th = 0.2, s.q.a.th = -0.3, s.q.b.th = 0.4
print s.m.x, s.m.y, s.q.b.R2.i, s.p.a.l.ay, s.q.b.th''
END
cat >flat.ct <<'END'
use rod a A=ground e=n
use rod b A=a.B L=2 e=a.o
arm C b.B [0.1, 0]
resistor Ra b.o o 3
resistor Rb o 0 4
use rod c A=C e=o
use rod d A=c.B L=2 e=c.o
arm D d.B [0.1, 0]
resistor Rc d.o p 3
resistor Rd p 0 4
body m mass=2 inertia=1
weld w D m
vsource V n 0 5
init a.th = 0.1, b.th = 0.2, c.th = -0.3, d.th = 0.4
print m.x, m.y, d.R2.i, a.l.ay, d.th''
END
cotree -q chain.ct nested.ct | sed 's/^.* = //' >nested.out
cotree -q chain.ct flat.ct | sed 's/^.* = //' >flat.out
cmp nested.out flat.out && wc -l <nested.out
printf 'subsystem s frames=[A]\nuse rod a b A=[A, a.B, A] e=0\nend\n' >count.ct
cotree -q chain.ct count.ct 2>&1
true
