# Ctrl-C ends a sweep; the runs until then are a table
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 1
sweep L=range(0.2, 2, 1000000) keep=h : simulate 5 every=1
print "never"
END
cotree model.ct 2>errors &
sleep 2
kill -INT $!
wait $!
echo "$?"
sed 's/[0-9][0-9.]* s;/TIME s;/; s/[0-9][0-9]* runs/SOME runs/; s/in run [0-9]*/in run SOME/' errors
