# an instance inside another as a black box: its equations hold in a run, and its port's effort is
# minus the reaction of its joint
cat >inside.ct <<'END'
scene planar
gravity [0, -9.81]
subsystem inner frames=[A, B]
L = 1 m
body b mass=1 inertia=1
arm a b [-L/2, 0]
arm B b [L/2, 0]
revolute h A a
motor M h u 0 R=1 L=0.1 Kt=1 Kv=1
resistor R u 0 5
end
subsystem outer frames=[A]
D = 2
use inner i1 A=A L=D
use inner i2 A=i1.B
end
use outer o A=ground
END
cotree -q inside.ct -e 'show o.i1' -e 'show o.i2 internal' -e 'show o.i2 ports'
cat >holds.ct <<'END'
init o.i1.h = 0.4, o.i2.h = 0.7, o.i1.h' = 1, o.i2.h' = -2
simulate 1 every=0.1
expect 0.5*o.i1.L*o.i2.L*(o.i1.h'^2*cos(o.i1.h) + o.i1.h''*sin(o.i1.h))*sin(o.i1.h + o.i2.h) \
 - 0.5*o.i1.L*o.i2.L*(o.i1.h'^2*sin(o.i1.h) - o.i1.h''*cos(o.i1.h))*cos(o.i1.h + o.i2.h) \
 + (0.25*o.i2.L^2 + 1)*(o.i1.h'' + o.i2.h'') \
 ~ o.i2.M.i - 4.905*o.i2.L*cos(o.i1.h + o.i2.h) within 1e-9 at 0.7
expect 0.1*o.i2.M.i' ~ -o.i2.h' - 6*o.i2.M.i within 1e-9 at 0.7
expect (1 kg)*(0.5*o.i2.L*(o.i1.h' + o.i2.h')^2*cos(o.i1.h + o.i2.h) \
 + o.i1.L*(o.i1.h'^2*cos(o.i1.h) + o.i1.h''*sin(o.i1.h)) \
 + 0.5*o.i2.L*sin(o.i1.h + o.i2.h)*(o.i1.h'' + o.i2.h'')) ~ -o.i2.h.fx within 1e-9 at 0.7
END
cat inside.ct holds.ct | cotree -q && echo 'they hold'
echo '--- a number that was set inside it isn'"'"'t that of the definition'
cotree -q inside.ct -e 'set o.i1.b.mass = 3' -e 'show o.i1' 2>&1
cotree -q inside.ct -e 'set o.i1.b.mass = 3' -e 'show o.i2 internal' | head -1
echo '--- values of its parameters are symbols'
cotree -q inside.ct -e 'set o.i2.L = 3' -e 'show o.i2 internal' | tail -1
