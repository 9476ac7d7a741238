# figures of many runs: curves, families, histograms, maps
cat >m.ct <<'END'
scene planar
k = 10 [N/m]; m = 1 kg
body b mass=m inertia=1
prismatic s ground b axis=x
spring S s k=k
init s = 1
END
cat >plots.ct <<'END'
sweep k=range(10, 40, 4) keep=[modes.omega(1)] : modes
plot sweep > "one.txt"
sweep k=range(10, 40, 4) m=[1, 2] keep=[modes.omega(1), modes.damping(1)] : modes
plot sweep title="two" > "family.gp"
plot sweep map=on > "map.gp"
montecarlo 50 k=uniform(10, 20) keep=modes.omega(1) : modes
plot sweep > "histogram.gp"
plot last > "again.gp"
END
cotree -q m.ct plots.ct
head -1 one.txt
grep -c '^\$c' family.gp
grep -o 'm = [0-9] kg' family.gp | sort -u
grep -o 'splot \$m[0-9]' map.gp
# counts of all intervals: each has two corners
sed -n '/^\$c0/,/^end/p' histogram.gp | awk 'NF == 2 { sum += $2 } END { print sum / 2 }'
cmp histogram.gp again.gp
cat >wrong.ct <<'END'
plot sweep
sweep k=range(10, 40, 4) keep=[modes.omega(1)] : modes
plot sweep map=on > "a.gp"
plot sweep vs k > "a.gp"
simulate 1
plot s map=on > "a.gp"
sweep k=range(10, 40, 4) m=[1, 2] keep=[period(s), s] : simulate 0.1
plot sweep yrange=[0, 2] > "a.gp"
END
cotree -q -k m.ct wrong.ct 2>&1 || true
