# mechanisms at frames: a pendulum and a double pendulum, whose formulas are in textbooks; the leg of
# the paper (numbers: J^-T M J^-1 by hand); what has no such equivalent, and wrong uses
say() {
    echo "--- $1"
    printf '%s\n' "$2" "$1" >norton_line.ct
    cotree -q -k norton_line.ct 2>&1
}
cat >double.ct <<'MODEL'
scene planar
gravity [0, -9.81]
L = 0.5; m = 2; J = 0.1
body b1 mass=m inertia=J
arm p1 b1 [-L, 0]
arm r1 b1 [L, 0]
body b2 mass=1 inertia=0.2
arm p2 b2 [-0.3, 0]
arm r2 b2 [0.3, 0]
revolute h1 ground p1
revolute h2 r1 p2
init h1 = 30 deg, h2 = 40 deg, h1' = 2, h2' = -1
MODEL
cat >leg.ct <<'MODEL'
scene planar
gravity [0, -9.81]
subsystem leg frames=[A, B] terminals=[e]
  L1 = 0.4 m; L2 = 0.3 m; ma = 1 kg; mb = 2 kg; Ja = 0.1; Jb = 0.2; La = 0.1
  body m1 mass=ma inertia=Ja
  body m2 mass=mb inertia=Jb
  arm a1 m1 [-L1/2, 0]
  arm b1 m1 [L1/2, 0]
  arm a2 m2 [-L2/2, 0]
  arm B m2 [L2/2, 0]
  revolute h1 A a1
  revolute h2 b1 a2
  motor M h1 e 0 R=1 L=La Kt=0.5 Kv=0.5
end
MODEL
cat >one_leg.ct <<'MODEL'
source "leg.ct"
use leg leg1 A=ground e=v1
vsource E v1 0 5*sin(t)
init leg1.h1 = 30 deg, leg1.h2 = 40 deg
MODEL
cat >arm.ct <<'MODEL'
scene planar
gravity [0, -9.81]
body p mass=3 inertia=0.2
body b mass=m inertia=J
arm a b [-L, 0]
arm B b [L, 0]
revolute h p a
resistor R1 v1 n R
motor M h n 0 R=1 L=0 Kt=0.5 Kv=0.5
vsource E v1 0 5*sin(t)
init h = 20 deg, p.theta = 10 deg, p.theta' = 1
MODEL
sed -i '1i R = 2; m = 1.5; J = 0.1; L = 0.4' arm.ct
double='source "double.ct"'
leg='source "one_leg.ct"'
say 'show thevenin r1 of h1, b1' "$double"
say 'show norton r1 of h2, b2' "$double"
say 'show norton r1 of h2, b2 as latex' "$double"
say 'show thevenin r1.ax of h1, b1 as c' "$double"
say 'show thevenin r1 r2 at 0; print r1.ax, r2.ay' "$double"
say 'show norton leg1.B translation at 0' "$leg"
say 'show norton leg1.B translation' "$leg"
arm='source "arm.ct"'
say 'show norton p of h, b, M, R1' "$arm"
say 'show norton p of h, b, M, R1 networks=kept' "$arm"
say 'show thevenin B.alphaz of h, b, M, R1' "$arm"
say 'show thevenin B.alphaz of h, b, M, R1 at 0' "$arm"
say 'show norton p.ax p.ay B.alphaz of h, b at 0' "$arm"
say 'diode D n 0; show norton p of h, b, M, R1, D networks=kept' "$arm"
# a part that is attached to a frame inside an instance
hung='source "one_leg.ct"; body p mass=2 inertia=0.1; arm a p [0.1, 0]; revolute h leg1.B a'
say 'show thevenin p.ax p.ay of h, p; show norton p of p' "$hung"
echo "--- none of that kind"
say 'show norton r1 of h1, b1' "$double"
say 'show thevenin r1 of h2, b2' "$double"
say 'show norton leg1.B at 0' "$leg"
say 'driver D h1 = 2*t; driver D2 h2 = t; show norton r2.ax' "$double"
say 'diode D n 0; show norton p of h, b, M, R1, D networks=eliminated' "$arm"
echo "--- wrong uses"
say 'show norton r3' "$double"
say 'show norton' "$double"
say 'show norton ground' "$double"
say 'show norton r1 of' "$double"
say 'show norton r1 of h2, b3' "$double"
say 'show norton r1 of b2' "$double"
say 'show norton leg1.B of leg1.m2' "$leg"
say 'show norton r1.fx' "$double"
say 'show norton r1 r2.ax' "$double"
say 'show norton translation' "$double"
say 'show norton r1 translation rotation' "$double"
say 'show norton v1 0 at 0' "$leg"
say 'show norton r1 networks=gone' "$double"
say 'show mass at 0' "$double"
say 'show mass networks=kept' "$double"
say 'friction f h2 torque=1; show norton r1 of h2, b2, f' "$double"
:
