# Constraints that others repeat are named by joint, with what they repeat and what is left; a
# joint that no position lets close is refused with the reason. A parallelogram with a third crank
# has one freedom and one equation too many, a planar loop in space three.
cat >parallelogram.ct <<'END'
scene planar
body c1 mass=1 inertia=0.1
body c2 mass=1 inertia=0.1
body c3 mass=1 inertia=0.1
body rod mass=2 inertia=0.5
arm a1 c1 [1, 0]
arm a2 c2 [1, 0]
arm a3 c3 [1, 0]
arm b2 rod [2, 0]
arm b3 rod [1, 0]
arm g2 ground [2, 0]
arm g3 ground [1, 0]
revolute h1 ground c1
revolute h2 g2 c2
revolute h3 g3 c3
revolute k1 a1 rod
revolute k2 b2 a2
revolute k3 b3 a3
tree h1 h2 h3 k1
init h1 = 60 deg
guess h2 = 60 deg, h3 = 60 deg, k1 = -60 deg
check
END
cat >loop.ct <<'END'
body c mass=1 inertia=[0.1, 0.1, 0.1]
body r mass=2 inertia=[0.1, 0.3, 0.3]
body o mass=1 inertia=[0.1, 0.1, 0.1]
arm ca c [0.5, 0, 0]
arm ra r [LENGTH, 0, LIFT]
arm oa o [1, 0, 0]
arm g ground [1.2, 0, 0]
revolute h1 ground c axis=z
revolute h2 ca r axis=z
revolute h3 g o axis=z
revolute h4 ra oa axis=z
END
loop() { # LENGTH LIFT, statements
    sed "s/LENGTH/$1/; s/LIFT/$2/" loop.ct
    echo "$3"
}
run() {
    echo "== $1"
    cotree "$1" 2>&1 | grep -v 'constraints, \|assembled from' || true
}
run parallelogram.ct
loop 1.5 0 'tree h1 h2 h3
check
print h4.fz' >joints.ct
run joints.ct
loop 1.5 0 'tree absolute
guess c.q0 = 0.87, c.q3 = 0.5, r.x = 0.25, r.y = 0.43, o.x = 1.2, o.q0 = 0.8, o.q3 = 0.6
check' >bodies.ct
# which of the repeated rows is left out hangs on rounding
run bodies.ct | sed 's|redundant: .* repeats .*|redundant: ... repeats ...|' | uniq
loop 0.1 0 'arm oo o [-0.05, 0, 0]
delete h4
revolute h4 ra oo axis=z
tree h1 h2 h3
init h1 = 0
assemble' >short.ct
run short.ct
loop 1.5 0.3 'tree h1 h2 h3
assemble' >askew.ct
run askew.ct
