# A coil's current that a transistor takes from a diode: the node between has no charge, so that its
# voltage jumps in less than any step. The node and the way out are named; with a capacitor there
# the run is that of ngspice 39 (mos level 1, the same start).
cat >nmos.ct <<'END'
subsystem nmos terminals=[d, g, s]
  VT = 2 V
  K = 5 [A/V^2]
  open(x) = max(x - VT, 0)^2
  isource channel d s K/2*(open(g.v - s.v) - open(g.v - d.v))
end
END
supply='vsource V1 in 0 5
vsource V2 g 0 10*ramp(t)/1e-6'
load='diode D1 sw out Is=1e-9
capacitor C1 out 0 100 uF
resistor R1 out 0 20'
coil='inductor L1 in sw 100 uH'
transistor='source "nmos.ct"
use nmos M1 d=sw g=g s=0'
law='isource Z sw 0 2.5*max(g.v - 2, 0)^2*tanh(sw.v/0.1)'
try() {
    printf '%s\n' "$supply" "$@" >model.ct
    cotree -q -k model.ct 2>said.txt
    echo "status $?"
    sed 's|at t = [^ ]* s|at t = N s|' said.txt
}
try "$coil" "$transistor" "$load" op 'simulate 1e-6'
try "$coil" "$law" "$load" op 'simulate 1e-6'
# through coils in series, whichever is the state
try 'inductor L1 in m 50 uH' 'inductor L2 m sw 50 uH' "$law" "$load" op 'simulate 1e-6'
try 'inductor L2 m sw 50 uH' 'inductor L1 in m 50 uH' "$law" "$load" op 'simulate 1e-6'
# the diode leads to a source; a node by another name
try 'inductor L1 in x 100 uH' 'diode D1 x out Is=1e-9' 'vsource V3 out 0 4.5' \
    'isource Z x 0 2.5*max(g.v - 2, 0)^2*tanh(x.v/0.1)' 'init L1.i = 0.2' 'simulate 1e-6'
# with a capacitor, from sw to 0
try "$coil" "$transistor" "$load" 'capacitor C2 sw 0 1 nF' \
    'init L1.i = 0.225128055, C1.v = 4.50256109, C2.v = 5' 'simulate 1e-6' \
    'expect L1.i ~ 0.2627324 within 1e-6' 'expect sw.v ~ 6.571184e-3 within 1e-8' \
    'expect sw.v ~ 2.342862e-2 within 1e-7 at 0.4e-6'
# a resistor takes the current: another cause has another hint
try 'inductor L1 y x 1' 'resistor R1 x 0 1' 'vsource V3 y 0 3/(0.5 - L1.i)' 'simulate 10'
