# what switches by time; figures of the energy are rounding
cat >model.ct <<'END'
# Switches that follow the time are found however often they switch in a run: the current of a coil
# at 1 V counts how long they were closed.
vsource V1 a 0 1
f = 40e3; D = 0.25
switch S1 a b when=t*f - floor(t*f) < D
diode D1 0 b
inductor L1 b 0 1
init L1.i = 0
# rows and samples in step with the periods
simulate 1 every=0.01
expect L1.i ~ D within 1e-9
expect L1.i ~ D/2 within 1e-9 at 0.5

# closed for a small part of each period
D = 0.004
simulate 0.05
expect L1.i ~ D*0.05 within 1e-9

# by a pulse, and by a sine
set S1.when = pulse(t, 0, 1, 0, 0, 0, 0.3/f, 1/f) > 0.5
simulate 0.3
expect L1.i ~ 0.09 within 1e-9
set S1.when = sin(2*pi*f*t) > 0.5
simulate 0.3
expect L1.i ~ 0.1 within 1e-9

# and what can't be determined is refused
set S1.when = sin(1e13*t) > 0
simulate 1
END
cotree model.ct 2>said.txt
echo "status $?"
sed 's/drift [0-9.e+-]* J/drift N J/' said.txt
