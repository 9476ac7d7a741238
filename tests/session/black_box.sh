# subsystems as black boxes: internal equations and what the ports give, of definitions and instances.
# Their formulas hold in a run; typed as given equations they are the same subsystem again.
show() {
    echo "--- $2"
    cotree -q -k "$1" -e "$2" 2>&1
}
cat >link.ct <<'MODEL'
scene planar
gravity [0, -9.81]
subsystem link frames=[A, B] terminals=[e]
  L = 0.5 m; m = 2 kg; J = 0.1
  body b mass=m inertia=J
  arm a b [-L, 0]
  arm B b [L, 0]
  revolute h A a
  motor M h e 0 R=1 L=0.1 Kt=0.5 Kv=0.5
end
body p mass=3 inertia=0.2
arm k p [0.2, 0.1]
use link S A=k e=v L=0.4
body q mass=1 inertia=0.05
arm l q [-0.3, 0]
revolute j S.B l
vsource V v 0 5*sin(t)
init p.x = 0, p.y = 0, p.x' = 0, p.y' = 0, p.theta = 0.3, p.theta' = 1, S.h = 0.5, S.h' = -1, j = 1
MODEL
show link.ct 'show link'
show link.ct 'show S internal'
show link.ct 'show S ports'
show link.ct 'show link ports as latex'
show link.ct 'show S as c'
echo "--- the formulas of a run"
{
    echo 'source "link.ct"; simulate 0.5'
    cotree -q link.ct -e 'show S' | sed 's/·/*/g; s/²/^2/g; s/θ/theta/g' |
        sed 's/S\.B\.f/j.f/g; s/S\.B\.tz/j.tz/g' >formulas.txt
    # the effort on what A is bound to: joint and motor act on k, too
    sed -n 's/^S\.A\.fx = \(.*\)/expect \1 ~ -S.h.fx within 1e-9/p; s/^S\.A\.fy = \(.*\)/expect \1 ~ -S.h.fy within 1e-9/p
            s/^S\.A\.tz = \(.*\)/expect \1 ~ -S.M.torque within 1e-9/p
            s/^S\.B\.\([xy]\) = \(.*\)/expect \2 ~ S.B.\1 within 1e-9/p; s/^S\.e\.i = \(.*\)/expect \1 ~ -V.i within 1e-9/p' formulas.txt
} >run.ct
cotree -q run.ct && grep -c '^expect' run.ct
# the same by its equations
cat >given.ct <<'MODEL'
scene planar
gravity [0, -9.81]
subsystem link frames=[A, B] terminals=[e] through=[A]
  L = 0.5 m; m = 2 kg; J = 0.1
  unknown h, i
  internal (L^2*m + J)*h'' + (L^2*m + J)*A.theta'' - L*m*sin(A.theta + h)*A.x'' + L*m*cos(A.theta + h)*A.y'' + 9.81*L*m*cos(A.theta + h) - 0.5*i - 2*L*sin(A.theta + h)*B.fx + 2*L*cos(A.theta + h)*B.fy + B.tz
  internal 0.1*i' - e.v + 0.5*h' + i
  give A.fx = L*m*(h' + A.theta')^2*cos(A.theta + h) - m*A.x'' + L*m*sin(A.theta + h)*A.theta'' + L*m*sin(A.theta + h)*h'' - B.fx
  give A.fy = m*(L*(h' + A.theta')^2*sin(A.theta + h) - 9.81) - m*A.y'' - L*m*cos(A.theta + h)*A.theta'' - L*m*cos(A.theta + h)*h'' - B.fy
  give A.tz = -9.81*L*m*cos(A.theta + h) + L*m*sin(A.theta + h)*A.x'' - L*m*cos(A.theta + h)*A.y'' + (-L^2*m - J)*A.theta'' + (-L^2*m - J)*h'' + 2*L*sin(A.theta + h)*B.fx - 2*L*cos(A.theta + h)*B.fy - B.tz
  give B.x = 2*L*cos(A.theta + h) + A.x, B.y = 2*L*sin(A.theta + h) + A.y, B.theta = A.theta + h
  give e.i = i
end
body p mass=3 inertia=0.2
arm k p [0.2, 0.1]
use link S e=v L=0.4
weld w S.A k
body q mass=1 inertia=0.05
arm l q [-0.3, 0]
revolute j S.B l
vsource V v 0 5*sin(t)
init p.x = 0, p.y = 0, p.x' = 0, p.y' = 0, p.theta = 0.3, p.theta' = 1, S.h = 0.5, S.h' = -1, j = 1
MODEL
show given.ct 'show link internal'
echo "--- runs of both"
for model in link given; do
    cotree -q $model.ct -e 'simulate 0.5; print p.x, p.y, p.theta, S.h, j, V.i' | grep =
done
cat >loop.ct <<'MODEL'
scene planar
gravity [0, -9.81]
subsystem four frames=[A, C, B]
  body b1 mass=1 inertia=0.1
  body b2 mass=2 inertia=0.2
  arm a1 b1 [-0.3, 0]
  arm c1 b1 [0.3, 0]
  arm a2 b2 [-0.4, 0]
  arm c2 b2 [0.4, 0]
  arm B b2 [0.1, 0.2]
  revolute h1 A a1
  revolute h2 c1 a2
  revolute h3 C c2
end
body o mass=1 inertia=1
revolute o1 ground o
driver D o1 = t
arm p1 ground [-0.5, 0]
arm p2 ground [0.3, 0]
use four S A=p1 C=p2
MODEL
echo "--- a loop inside: multipliers of the definition, and of the model"
show loop.ct 'show four'
show loop.ct 'show S ports'
echo "--- in space, on a moving base"
cat >space.ct <<'MODEL'
scene spatial
gravity [0, 0, -9.81]
subsystem rod frames=[A, B]
  body b mass=2 inertia=[0.1, 0.1, 0.1]
  arm a b [-0.2, 0, 0]
  arm B b [0.2, 0, 0]
  prismatic s A a axis=z
end
body p mass=3 inertia=[1, 1, 1]
use rod S A=p
MODEL
show space.ct 'show rod' | grep -v '^A\.[ft][xy]'
echo "--- circuits, and other domains"
for name in npn amplifier dc_drive quarter_car; do
    show "$TOP_SRCDIR/scripts/library/$name.ct" "show $name"
done
echo "--- instances inside, a value set later, dry friction"
cat >nested.ct <<'MODEL'
scene planar
gravity [0, -9.81]
subsystem rod frames=[A, B]
  L = 0.3; m = 1
  body b mass=m inertia=0.1
  arm a b [-L, 0]
  arm B b [L, 0]
  revolute h A a
end
subsystem two frames=[A, B]
  use rod u A=A
  use rod v A=u.B L=0.7
  arm B v.B [0.1, 0]
end
subsystem sticky frames=[A]
  body b mass=1 inertia=0.1
  revolute h A b
  friction f h torque=1
end
use two S A=ground
set S.v.m = 3
MODEL
show nested.ct 'show two internal'
show nested.ct 'show S ports'
show nested.ct 'show S.u'
show nested.ct 'show sticky'
echo "--- a velocity row inside"
cat >sled.ct <<'MODEL'
scene planar
subsystem sled frames=[A, B]
  body b mass=2 inertia=0.1
  arm a b [-0.3, 0]
  arm B b [0.3, 0]
  revolute h A a
  knife k ground B
end
MODEL
show sled.ct 'show sled'
echo "--- wrong uses"
show link.ct 'show S outside'
show link.ct 'show link ports internal'
show link.ct 'show S.b internal'
show link.ct 'show link at 1'
show link.ct 'show link networks=kept'
:
