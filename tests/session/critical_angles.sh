#!/bin/sh
# a sequence of three angles that starts half a degree from where it loses a freedom is told by joint
# and angle; Euler parameters of the same motion have nothing to tell
turns() {
    "$COTREE" -e 'gravity [0, 0, -9.81]' -e 'body b mass=1 inertia=[0.1, 0.1, 0.02]' \
        -e 'arm p b [0, 0, 0.5]' -e "spherical j ground p $1" -e 'tree joint' -e "$2" \
        -e 'simulate 0.1 every=0.01' 2>&1 | grep 'singular'
}
turns euler=zyx 'init j.a2 = 89.5 deg, j.a1 = 0, j.a3 = 0'
turns euler=zxz 'init j.a2 = 179.5 deg, j.a1 = 0, j.a3 = 0'
turns euler=zyx 'init j.a2 = 30 deg, j.a1 = 0, j.a3 = 0'
turns '' 'init j.q0 = 0.7, j.q1 = 0, j.q2 = 0.714142842854285, j.q3 = 0'
exit 0
