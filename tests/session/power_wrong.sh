# wrong uses of show power and of at
cat > wrong.ct << "END"
# topics of formulas have no instant, an instant lies in the run, powers have no other notation
scene planar
body m1 mass=2 inertia=0.1
revolute h1 ground m1
init h1' = 1
simulate 1
show mass at 1
show h1.fx at 1
show power at 2
show power at h1
show power m1
show power as c
print m1.pwr
show powr
END
cotree -k wrong.ct 2>&1
echo "status $?"
rm -f wrong.ct
