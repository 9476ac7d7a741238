# subsystems that hold equations, beside the same made of parts
# tolerance 1e-7
cat >leg.ct <<'END'
scene planar
gravity [0, -9.81]
subsystem leg frames=[A, B] terminals=[e]
  L1 = 0.4; L2 = 0.6
  m1 = 3; J1 = 0.04; m2 = 4; J2 = 0.12; g = 9.81
  K = 2; R = 1; L = 0.5
  unknown th1, th2, i1
  # Lagrange's equations of a double pendulum, by hand; B.fx is what the leg exerts
  internal (J1 + m1*L1^2/4 + J2 + m2*(L1^2 + L2^2/4 + L1*L2*cos(th2)))*th1'' \
    + (J2 + m2*(L2^2/4 + L1*L2/2*cos(th2)))*th2'' - m2*L1*L2/2*sin(th2)*(2*th1'*th2' + th2'^2) \
    + g*((m1/2 + m2)*L1*cos(th1) + m2*L2/2*cos(th1 + th2)) - K*i1 \
    - B.fx*(L1*sin(th1) + L2*sin(th1 + th2)) + B.fy*(L1*cos(th1) + L2*cos(th1 + th2)) + B.tz
  internal -2*((J2 + m2*(L2^2/4 + L1*L2/2*cos(th2)))*th1'' + (J2 + m2*L2^2/4)*th2'' \
    + m2*L1*L2/2*sin(th2)*th1'^2 + g*m2*L2/2*cos(th1 + th2) \
    - B.fx*L2*sin(th1 + th2) + B.fy*L2*cos(th1 + th2) + B.tz)
  internal L*i1' + R*i1 + K*th1' - e.v
  give B.x = A.x + L1*cos(th1) + L2*cos(th1 + th2)
  give B.y = A.y + L1*sin(th1) + L2*sin(th1 + th2), B.theta = th1 + th2
  give e.i = i1
end
END
sed -n '1,3p' leg.ct >parts.ct
cat >>parts.ct <<'END'
  L1 = 0.4; L2 = 0.6
  body l1 mass=3 inertia=0.04
  body l2 mass=4 inertia=0.12
  arm a1 l1 [-L1/2, 0]
  arm k1 l1 [L1/2, 0]
  arm k2 l2 [-L2/2, 0]
  arm B l2 [L2/2, 0]
  revolute th1 A a1
  revolute th2 k1 k2
  motor M th1 e 0 R=1 L=0.5 Kt=2 Kv=2
end
END
cat >robot.ct <<'END'
arm g1 ground [0, 0]
arm g2 ground [1, 0]
arm g0 ground [0.5, 0]
arm g3 g0 [0, sqrt(3)/2]
body m9 mass=8 inertia=0.0817
r = 0.4/sqrt(3)
arm p1 m9 [r*cos(210 deg), r*sin(210 deg)]
arm p2 m9 [r*cos(330 deg), r*sin(330 deg)]
arm p3 m9 [0, r]
vsource V v 0 20*sin(5*t)
use leg leg1 leg2 leg3 A=[g1, g2, g3] e=[v, v, w] L1=[0.4, 0.42, 0.4]
resistor Rw w 0 3
revolute h10 leg1.B p1
revolute h11 leg2.B p2
revolute h12 leg3.B p3
tree m9
init m9.x = 0.5, m9.y = 0.3, m9.theta = 0.1, m9.vx = 0, m9.vy = 0.1, m9.wz = 0
guess leg1.th1 = -1.34, leg1.th2 = 2.556, leg2.th1 = 0.754, leg2.th2 = -3.727, leg3.th1 = -3.434, leg3.th2 = 2.556
simulate 0.5 every=0.1 rtol=1e-11 atol=1e-12
print model.n, model.m, leg1.th1, leg2.th2, leg3.th1', m9.x, m9.theta, h10.fx, h12.fy, V.i, Rw.v, leg3.B.y
END
cotree -q parts.ct robot.ct >parts.out
cotree -q leg.ct robot.ct >given.out
cmp_numbers() {
    paste "$1" "$2" | awk -F'[=\t]' '{ split($2, a, " "); split($4, b, " ")
        if (a[1] == "" || (d = a[1] - b[1]) > 1e-6*(1 + sqrt(a[1]^2)) || d < -1e-6*(1 + sqrt(a[1]^2)))
            print "DIFFER:", $0 } END { print NR, "numbers" }'
}
cmp_numbers parts.out given.out
cut -d= -f2 given.out | tr -d ' ' | paste -sd' '
echo '--- saved, taken back, stored, changed'
cotree -q leg.ct robot.ct -e 'save "saved.ct"; store leg "leg.cts"; undo; redo; simulate 0.1 rtol=1e-11; print leg1.th1' \
    -e 'set leg1.L2 = 0.61; print leg1.B.theta' 2>&1 | tail -2
cotree -q saved.ct -e 'simulate 0.1 rtol=1e-11; print leg1.th1'
cotree -q -e 'scene planar; gravity [0, -9.81]; load "leg.cts"' robot.ct >loaded.out
cmp given.out loaded.out && echo same
echo '--- a series circuit by its charge, a source with a resistance, a pair of algebraic equations'
cat >circuit.ct <<'END'
subsystem rlc terminals=[e]
  R = 3; L = 0.02; C = 1e-3
  unknown q
  internal L*q'' + R*q' + q/C - e.v
  give e.i = q'
  init q = 1e-3
end
subsystem battery through=[o]
  E0 = 5
  unknown z
  internal z - o.i
  give o.v = E0 + 0.5*z
end
subsystem law terminals=[a, b]
  unknown x, y
  internal 2*x + y - a.v
  internal x - y + 0.1*b.v
  give a.i = x + y, b.i = y
end
vsource V a 0 sin(100*t)
use rlc s e=a
resistor R1 b c 3
inductor L1 c d 0.02
capacitor C1 d 0 1e-3
vsource V2 b 0 sin(100*t)
init C1.v = 1, L1.i = 0
use battery z
resistor Rz z.o f 2
use law w a=f b=g
resistor Rg g 0 7
simulate 0.1 rtol=1e-10 atol=1e-14
expect V.i ~ V2.i within 1e-9
expect s.q ~ C1.v*1e-3 within 1e-11
expect s.q' ~ L1.i within 1e-9
expect s.q'' ~ L1.v/0.02 within 1e-6
expect z.o.v ~ 5 - 0.5*Rz.i within 1e-12
expect 2*w.x + w.y ~ f.v within 1e-12
expect w.x - w.y + 0.1*g.v ~ 0 within 1e-12
expect w.y ~ -Rg.i within 1e-12
info s.q
check
END
cotree -q circuit.ct
echo '--- a force on what moves, against a lag'
cat >mount.ct <<'END'
scene planar
subsystem mount frames=[A]
  k = 20
  unknown s
  internal 3*s' + 5*s - k*(A.x - s)
  give A.fx = -k*(A.x - s), A.tz = -0.2*A.theta
end
body m mass=1 inertia=1
body n mass=1 inertia=1
planarjoint p ground m
planarjoint f ground n
use mount a A=m
lag c x 0 of=f.s1 k=20/25 T=3/25
force F n [-20*(n.x - x.v*1 [m/V]), 0]
torque T n -0.2*n.theta
init p.s1 = 1, f.s1 = 1, p.theta = 0.3, f.theta = 0.3
simulate 3 rtol=1e-10 atol=1e-12
expect a.s ~ x.v within 1e-8
expect m.x ~ n.x within 1e-8
expect m.theta ~ n.theta within 1e-8
END
cotree -q mount.ct && echo held
echo '--- a bead on y = u^2, turned with the tangent: energy, in two trees'
cat >bead.ct <<'END'
scene planar
gravity [0, -9.81]
subsystem wire frames=[B]
  unknown u
  internal B.fx + 2*u*B.fy + 2/(1 + 4*u^2)*B.tz
  give B.x = u, B.y = u^2, B.theta = atan(2*u)
end
use wire w
body m mass=2 inertia=0.3
weld j w.B m
init w.u = 0.8, w.u' = 0
output E = (1 + 4*w.u^2)*w.u'^2 + 0.15*(2*w.u'/(1 + 4*w.u^2))^2 + 2*9.81*w.u^2
tree j
simulate 2 rtol=1e-11 atol=1e-13
keep u = w.u
expect E ~ 2*9.81*0.64 within 1e-7
expect m.theta ~ atan(2*w.u) within 1e-12
tree m
simulate 2 rtol=1e-11 atol=1e-13
expect E ~ 2*9.81*0.64 within 1e-7
expect w.u ~ u within 1e-7
show forces
END
cotree -q bead.ct
echo '--- in space, two in one, an equation times -3'
cat >stage.ct <<'END'
scene spatial
subsystem stage frames=[B]
  m = 2; c = 50
  unknown x, y, z
  internal m*x'' + c*x + B.fx
  internal -3*(m*y'' + c*y + B.fy)
  internal m*z'' + 30*z + m*9.81 + B.fz
  give B.z = 2 + z
  give B.x = x, B.y = y
end
subsystem two frames=[C]
  use stage a b
  spring s a.B b.B k=5 length=0
  arm C b.B [1, 0, 0]
end
use two n
body p mass=1 inertia=[1, 1, 1]
weld h n.C p
init n.b.x = 0.2
set n.a.m = 2
simulate 1 rtol=1e-10 atol=1e-12
# of two masses, 2 and 3, on springs of 50 with one of 5 between
expect 2*n.a.x'' + 50*n.a.x ~ 5*(n.b.x - n.a.x) within 1e-9
expect 3*n.b.x'' + 50*n.b.x ~ 5*(n.a.x - n.b.x) within 1e-9
expect 2*n.a.x'^2 + 3*n.b.x'^2 + 50*(n.a.x^2 + n.b.x^2) + 5*(n.a.x - n.b.x)^2 ~ 55*0.04 within 1e-8
equilibrium > "rest.txt"
expect n.b.z ~ -2*9.81/30 within 1e-9
END
cotree -q stage.ct && echo held
echo '--- duals: a port in through= that is given an effort or a current, another that is given a voltage'
cat >base.ct <<'END'
scene planar
gravity [0, -9.81]
subsystem pendulum frames=[A, B] through=[A]
  m = 2; J = 0.3; L = 0.7; g = 9.81
  unknown th
  internal (J + m*L^2)*th'' + m*L*(cos(th)*A.x'' + sin(th)*A.ay) + m*g*L*sin(th) \
    + L*cos(th)*B.fx + L*sin(th)*B.fy + B.tz
  give A.fx = -m*(A.x'' + L*cos(th)*th'' - L*sin(th)*th'^2) - B.fx
  give A.fy = -m*(A.y'' + L*sin(th)*th'' + L*cos(th)*th'^2) - m*g - B.fy
  give B.x = A.x + L*sin(th), B.y = A.y - L*cos(th), B.theta = th
end
body cart mass=3 inertia=0.1
arm post ground [0.4, -1]
prismatic s ground cart axis=[0.8, 0.6, 0]
END
cat >dual.ct <<'END'
use pendulum p
weld w p.A cart
spring k p.B post k=30 length=0.2
init s = 0.2, p.th = 1, p.th' = 2
simulate 1 rtol=1e-11 atol=1e-13
print s, p.th, s', p.th', p.A.x, p.B.y, p.A_y, w.fx, w.fy, w.tz
END
cat >parts.ct <<'END'
body bob mass=2 inertia=0.3
arm top bob [0, 0.7]
revolute th cart top
spring k bob post k=30 length=0.2
init s = 0.2, th = 1, th' = 2
simulate 1 rtol=1e-11 atol=1e-13
print s, th, s', th', cart.x, bob.y, cart.y, -th.fx, -th.fy, -th.tz
END
cotree -q base.ct parts.ct >parts.out
for tree in 'tree joint' 'tree absolute' 'form augmented'; do
    cotree -q base.ct -e "$tree" dual.ct >dual.out
    cmp_numbers parts.out dual.out
done
cat >loose.ct <<'END'
subsystem mount frames=[A] through=[A]
  give A.fx = -50*A.x - 3*A.vx, A.fy = 2 - 50*A.y, A.fz = -50*(A.z - 1)
end
use mount m
body b mass=2 inertia=[1, 1, 1]
spherical j m.A b
init b.x = 0.3, b.z = 1, b.wz = 1
simulate 1 rtol=1e-10 atol=1e-12
keep x = b.x
keep y = b.y
expect x ~ 0.3*exp(-0.75)*(cos(sqrt(25 - 0.5625)) + 0.75/sqrt(25 - 0.5625)*sin(sqrt(25 - 0.5625))) within 1e-8
expect y ~ 0.04*(1 - cos(5)) within 1e-8
expect b.z ~ 1 within 1e-12
expect b.wz ~ 1 within 1e-12
END
cotree -q loose.ct && echo held
cat >currents.ct <<'END'
subsystem coil through=[e]
  unknown i1
  internal 2*i1' + 5*i1 - e.v
  give e.i = i1
end
subsystem battery terminals=[o]
  unknown z
  internal z - o.i
  give o.v = 5 + 0.5*z
end
use coil a
use battery b o=n
resistor R n a.e 1
init a.i1 = 0
simulate 1 rtol=1e-11 atol=1e-13
expect a.i1 ~ 5/6.5*(1 - exp(-6.5/2)) within 1e-9
expect R.i ~ a.i1 within 1e-9
expect n.v ~ 5 - 0.5*R.i within 1e-9
END
cotree -q currents.ct && echo held
echo '--- wrong'
try() {
    printf '%s\n' "$1" >wrong.ct
    echo "--- $1" | tail -n +2
    cotree -q wrong.ct 2>&1 && echo 'NOT REFUSED'
}
two() {
    try "scene planar
subsystem s frames=[A, B] terminals=[e]
$1
end
${2:-use s x A=ground e=n}"
}
moves='give B.x = u, B.y = 0, B.theta = 0, A.fx = 0, e.i = 0'
try 'unknown x'
try 'internal 2'
try 'give B.x = 2'
two "unknown u
internal u'' + B.fx
internal u
$moves"
two "unknown u, v
internal u'' + B.fx
$moves"
two "unknown u
internal u''^2 + B.fx
$moves"
two "unknown u
internal u''*B.fx + B.fx
$moves"
two "unknown u
internal u'' - B.fx
$moves"
two "unknown u
internal u'' + 2*B.fy
$moves"
two "unknown u, v
internal u'' + B.fx
internal v'' + 3*u'' + B.fy
give B.x = u, B.y = v, B.theta = 0, A.fx = 0, e.i = 0"
two "unknown u, v
internal u'' + sqrt(u - 50)*v'' + B.fx
internal v'' + 3*sqrt(u - 50)*u'' + B.fy
give B.x = u, B.y = v, B.theta = 0, A.fx = 0, e.i = 0"
two "unknown u, v
internal v'' + B.fy
internal u'' + B.fx
give B.x = u, B.y = v, B.theta = 0, A.fx = 0, e.i = 0"
two "unknown u
internal u'*u'' + B.fx
$moves"
two "unknown u
internal u' + B.fx
give B.x = u', B.y = 0, B.theta = 0, A.fx = 0, e.i = 0"
two "unknown u
internal u'' + B.fx
give B.x = u, B.y = 0, A.fx = 0, e.i = 0"
two "unknown u
internal u'' + B.fx
give B.x = u, B.y = 0, B.theta = 0, A.fx = 0"
two "unknown u
internal u'' + B.fx
$moves, B.fx = 2"
two "unknown u
internal u'' + B.fx
$moves, B.x = 2"
two "unknown u
internal u'' + B.fx
$moves, e.v = 2"
two "unknown u
internal u'' + B.fx
$moves, B.z = 2"
two "unknown u
internal u'' + B.fx
$moves, B.wz = 2"
two "unknown u
internal u'' + B.fx
$moves, C.x = 2"
two "unknown u
internal u'' + B.fz
$moves"
two "unknown u
internal u'' + B.fx
$moves
body b mass=1 inertia=1"
two "unknown u
unknown u
internal u'' + B.fx
$moves"
two "unknown A
internal A"
two "unknown u
internal u'' + B.fx + w
$moves"
two "unknown u
internal u''' + B.fx
$moves"
two "unknown u
internal u'' + B.fx
$moves" "body m mass=1 inertia=1
use s x A=m e=n"
two "body m mass=1 inertia=1
unknown u"
two "unknown u
internal u^2 - 2
give A.fx = u, B.fx = u, e.i = u"
two "give A.fx = 0, B.x = 1, B.y = 0, B.theta = 0, e.i = 0"
two "unknown u
internal u - e.v
give A.fx = 0, B.x = 1, B.y = 0, B.theta = 0, e.i = u"
two "unknown block
internal block'' + B.fx
give B.x = block, B.y = 0, B.theta = 0, A.fx = 0, e.i = 0"
# names of the parts that equations become
two "block = 2
unknown u
internal u'' + block*u + B.fx
$moves"
two "unknown e_source
internal e_source - e.v
give A.fx = 0, B.fx = 0, e.i = e_source"
two "unknown A_force
internal A_force' - A.x
give A.fx = -3*A_force, B.fx = 0, e.i = 0"
two "unknown u
internal u'' + 50*(u - A.x) + B.fx
give B.x = u, B.y = 0, B.theta = 0
give A.fx = 50*(u - A.x), e.i = 0" "body m mass=1 inertia=1
prismatic p ground m axis=x
use s x A=m e=n"
try "scene spatial
subsystem s frames=[A] through=[A]
give A.fx = 1, A.tz = 2
end"
try "scene planar
subsystem s frames=[A] through=[A]
A_x = 3
give A.fx = -A_x*A.x
end"
try "scene planar
subsystem s frames=[A] through=[A]
unknown A_theta
internal A_theta - 2
give A.fx = -A_theta
end"
try "scene planar
subsystem s frames=[A] through=[A]
body b mass=1 inertia=1
revolute h A b
end"
true
