# Ctrl-C ends a fit; the best values until then are kept. Many short runs: under the sanitizers too
# some of them are over when it is stopped, and never all: a figure has no sensitivities.
names=
for i in $(seq 150); do names="$names w$i"; done
cat >model.ct <<END
scene planar
gravity [0, -9.81]
L = 0.5 m
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 1
L = 0.3
$(for name in $names; do printf '%s = 1; ' "$name"; done)
fit L $names to=0.1 by=final(h) : simulate 1 method=rk4 step=1e-5
print "never"
END
cotree model.ct -e 'show fit' 2>errors &
sleep 4
kill -INT $!
wait $!
echo "$?"
sed 's/^run1.*//; s/in run [0-9]*/in run SOME/' errors
