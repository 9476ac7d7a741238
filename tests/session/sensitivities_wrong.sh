# what has no derivative along a run, and what to write instead
cat >wrong.ct <<'END'
scene planar
L = 0.5 m; A = 0.1; e = 0.8
gravity [0, -9.81]
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = A
print d(h)/d(L)
simulate 1
print d(h)/d(Q)
print d(h)/d(h)
print d(h)
print d(h, b)/d(L)
print d(max(h))/d(L)
print d(x9)/d(L)
print d(h)/d(L) at 3
print run4.h + d(run4.h)/d(L)
L = 0.6 m
print d(h)/d(L)
init none
driver D h = A*t
inverse 1
print d(h)/d(A)
clear
scene planar
e = 0.8
body b mass=1 inertia=1
prismatic s ground b axis=y
force F b [0, -9.81]
init s = 1
stop floor s low=0 e=e
simulate 1
print d(s)/d(e) at 0.6
expect d(s)/d(e) ~ 0 within 1e-12 at 0.3
clear
K = 2
vsource E a 0 sin(t)
resistor R1 a b 1
capacitor C1 b 0 1
gain G c 0 of=C1.v k=K period=0.1
simulate 1
print d(C1.v)/d(K)
END
cotree -k wrong.ct 2>&1 || true
