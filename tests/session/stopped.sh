# Ctrl-C in a script stops the run and the script, also with -k, and is status 1
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
body m1 mass=2 inertia=0.1
arm r1 m1 [0, 1]
revolute h1 ground r1
init h1 = 60 deg
simulate 1e7 every=1000
print "never"
END
cotree -k model.ct &
sleep 0.7
kill -INT $!
wait $!
echo "$?"
