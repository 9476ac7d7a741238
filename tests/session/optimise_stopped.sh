# Ctrl-C ends an optimisation; the best values until then are kept. Many short runs, as in
# fit_stopped.
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
$(for name in $names; do printf '%s = 1; ' "$name"; done)
optimise L $names minimise=(h - 0.3)^2 : simulate 1 method=rk4 step=1e-5
print "never"
END
cotree model.ct -e 'show optimum' 2>errors &
sleep 4
kill -INT $!
wait $!
echo "$?"
sed 's/^run1.*//; s/in run [0-9]*/in run SOME/' errors
