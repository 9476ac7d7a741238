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
