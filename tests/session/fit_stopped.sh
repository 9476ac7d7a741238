# Ctrl-C ends a fit; the best values until then are kept
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 1
simulate 1 every=0.1
export csv h > "data.csv"
L = 0.3
w1 = 1; w2 = 1; w3 = 1; w4 = 1; w5 = 1; w6 = 1; w7 = 1; w8 = 1
fit L w1 w2 w3 w4 w5 w6 w7 w8 to=table("data.csv", t, "h") by=h : simulate 1 method=rk4 step=2e-6
print "never"
END
cotree model.ct -e 'show fit' 2>errors &
sleep 4
kill -INT $!
wait $!
echo "$?"
sed 's/^run1.*//; s/in run [0-9]*/in run SOME/' errors
