# what somebody who explores does: gives, takes back and forgets starts; asks by names; looks inside
# instances; gives a part too little inertia
say() {
    echo "--- $1"
    printf '%s\n' "$1" >explorer.ct
    cotree -q -k explorer.ct 2>&1
}
cat >pendulum.ct <<'MODEL'
scene planar
gravity [0, -9.81]
body b mass=2 inertia=0.1
arm a b [-0.3, 0]
revolute h ground a
MODEL
pendulum='source "pendulum.ct"'
say "$pendulum
init h = 30 deg
print h [deg]
init none
print h [deg]"
say "$pendulum
init h = 30 deg, h' = 2
print h [deg], h'
undo
print h [deg], h'
redo
print h [deg], h'"
say "$pendulum
init h = 30 deg
guess h = 50 deg
equilibrium
guess none
print h [deg]"
cat >filter.ct <<'MODEL'
R = 1 kohm; C = 1 uF
vsource E a 0 0
resistor R1 a b R
capacitor C1 b 0 C
MODEL
say 'source "filter.ct"
show transfer C1.v E
show transfer C1.v E symbolic
linearize inputs=[E] outputs=[C1.v] > "linear.txt"
show transfer C1.v E
show transfer R1.i E
show transfer C1.v R1
show transfer C2.v E'
say 'subsystem half terminals=[p, q]
  R = 5 ohm
  resistor R1 p q R
end
subsystem divider terminals=[p, q]
  use half upper p=p q=m
  use half lower p=m q=q R=7
end
use divider d p=x q=0
vsource V x 0 12
print d.upper.R, d.lower.R
show thevenin d.m 0
show norton d.m x
show thevenin d.k 0
show transfer d.m.v V
set d.lower.R = 3
print d.lower.R, d.m.v
resistor Rl d.m 0 5'
say "$pendulum
tree b
form embedded independent=[h]
show equations
form embedded independent=[b.x, b.y]
show equations"
say 'tank T1 p 0 A=2
gear g a 0 b 0 ratio=3
info T1
info g' | grep 'sign\|---'
beam='beam b length=1 mass_per_length=2 EIy=100 EIz=200 modes=[0, 2, 2, 0]'
say "$beam
revolute h ground b axis=x
simulate 1
init b.v1 = 0.1
simulate 1
set b.inertia_per_length = [0.01, 0, 0]
simulate 0.01 every=0.01"
say "$beam
modes"
say 'scene planar
body b mass=1 inertia=0
body c mass=1 inertia=1
revolute h ground b
revolute k b c
simulate 1'
say 'subsystem follower terminals=[p] through=[q]
  vcvs E q 0 p 0 gain=1
end
resistor R1 f.q 0 5
use follower f p=f.q
use follower f p=a
resistor R1 f.q 0 5'
echo '--- a diode by its slope, against its operating points beside'
cat >slope.ct <<'MODEL'
U = 2 V
vsource V a 0 U
resistor R a b 1 kohm
diode D b 0 Is=1e-14
linearize inputs=[V] outputs=[b.v] > "linear.txt"
keep slope = linear.D(1,1)
U = 2.001
op > "rest.txt"
keep above = b.v
U = 1.999
op > "rest.txt"
expect slope ~ (above - b.v)/0.002 within 1e-5*slope
MODEL
cotree -q slope.ct && echo held
say 'scene planar
beam b length=1 mass_per_length=2 EIz=100 modes=[0, 1]
revolute h ground b
arm tip b at=1
sensor s tip.y o 0
print h at 3
show derivation b.v1' | grep -v 'forces\|shapes\|^b'
say "$pendulum
simulate 1 every=0.5
draw mechanism at 2"
true
