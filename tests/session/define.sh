# values of the command line win over the file's
cat >p.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m; m = 1 kg
area = L^2
body b mass=m inertia=0
arm p b [0, L]
revolute h ground p
init h = 0.1 deg
L = 0.4 m
modes
print L, area
END
cotree -q -D L=0.7 p.ct -e 'expect modes.omega(1) ~ sqrt(9.81/0.7) within 1e-5'
cotree -q -D 'L=70 cm' --define m=2 p.ct -e 'print L, m' | tail -2
# statements, and what save writes, are unchanged; a sweep has values of its own
cotree -q -D L=0.7 p.ct -e 'set L = 2; undo; print L' -e 'save "s.ct"' -e 'sweep L=[1, 2] keep=p.y : assemble' \
    -e 'print sweep.value(1, L), L, b.y' | tail -4
grep 'L =' s.ct
for wrong in Q=1 L L=x L=0.7s L=1/0 m=-1 'L=1; m=2' 'body b'; do
    cotree -q -D "$wrong" p.ct 2>&1 >/dev/null; echo "$?"
done
cotree -q -D 2>&1; echo "$?"
echo 'k = 2; print k' | cotree -q -D k=3
echo 'print 1' | cotree -q -D k=3 2>&1; echo "$?"
