# show structure: blocks of instances, what was derived and what was taken over; the paper's robot
# has 9 + 3 unknowns and 6 closures
robot() {
    sed '/^expect/d; /^simulate/d; /^export/d' "$TOP_SRCDIR/scripts/paper/6_parallel_forward.ct"
}
robot >robot.ct
echo '--- the robot: one leg derived'
cotree -q robot.ct -e 'show structure'
echo '--- the tree enters the third leg by its tip, and it has equations of its own'
cotree -q robot.ct -e 'tree m9 leg1.th1 leg1.th2 leg2.th1 leg2.th2 h12 leg3.th2' \
    -e 'show structure' | sed -n '6,11p'
echo '--- other lengths are other values; another number of a part is another expression'
cotree -q robot.ct -e 'set leg2.L1 = 0.45; set leg3.l1.mass = 5; show structure' | sed -n '6,11p'
echo '--- instances within instances'
cat >within.ct <<'END'
scene planar
subsystem link frames=[A, B]
  body b mass=1 inertia=0.1
  arm a b [-0.5, 0]
  arm B b [0.5, 0]
  revolute h A a
end
subsystem arm frames=[A, B]
  use link low A=A
  use link high A=low.B
  arm B high.B [0.4, 0]
end
use arm left right A=[ground, ground]
show structure
delete left
show structure
END
cotree -q within.ct
echo '--- what an edit leaves alone is recalled, what comes with it follows, and a mass is another one'
cat >>within.ct <<'END'
use arm other A=ground
show structure
set right.low.b.mass = 2
show structure
END
cotree -q within.ct | grep -A9 '^block' | sed -n '23,32p;34,43p'
echo '--- thirty legs: patterns of blocks'
{
    printf 'scene planar\nbody m mass=1 inertia=1\n'
    printf 'subsystem leg frames=[A, B]\nbody b mass=1 inertia=1\narm B b [1, 0]\n'
    printf 'body c mass=1 inertia=1\nrevolute h A b\nrevolute k b c\nend\n'
    for i in $(seq 30); do printf 'use leg leg%d A=ground\nrevolute h%d leg%d.B m\n' "$i" "$i" "$i"; done
    printf 'tree m'
    for i in $(seq 30); do printf ' leg%d.h leg%d.k' "$i" "$i"; done
    printf '\nshow structure\n'
} >many.ct
cotree -q many.ct | sed -n '4,7p;32,42p;66,76p'
echo '--- instances inside others and on their tips: one alone is pulled, by 12 (3.28024 - 0.4) N,'
echo '--- along the slide by 2.6/3.28024 of that; 1.9 kg'
cat >hung.ct <<'END'
scene planar
arm far ground [3, 2]
body cart mass=4 inertia=1
prismatic rail ground cart axis=x
subsystem inner frames=[A, tip]
  body b mass=1.3 inertia=0.07
  arm tip b [0.3, 0]
  prismatic h A b axis=x
end
subsystem outer frames=[A, tip]
  L = 0.4
  body b mass=1.9 inertia=0.06
  arm tip b [L, 0]
  prismatic h A b axis=x
  use inner i A=tip
end
use inner u0 A=cart
use outer u1 u2 u3 A=[cart, cart, cart] L=[0.4, 0.7, 0.3]
use inner u4 A=u2.tip
use inner u6 A=u3.tip
spring ends far u1.tip k=12 length=0.4
print u1.h'', u2.h'', u0.h''
END
cotree -q hung.ct
