# what can't be swept, and what to write instead
cat >m.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 0.1
END
printf 'L [mm], Q\n1, 2\n' >unknown.csv
printf 'L [s]\n1\n' >unit.csv
printf 'L\n1\nx\n' >number.csv
printf 'L\n1, 2\n' >long.csv
printf 'L\n' >empty.csv
printf 'L [mm]\n# two of them\n200\n400\n' >sets.csv
cat >wrong.ct <<'END'
sweep Q=[1, 2] keep=h : simulate 1
sweep L=[1, 2] keap=h : simulate 1
sweep b.mass=[1, 2] keep=h : simulate 1
sweep L=[1, 2] : simulate 1
sweep keep=h : simulate 1
sweep L=range(1, 2) keep=h : simulate 1
sweep L=range(1, 2, 2.5) keep=h : simulate 1
sweep L=logrange(-1, 1, 5) keep=h : simulate 1
sweep L=[1 s, 2 s] keep=h : simulate 1
sweep L=[1, 2] s keep=h : simulate 1
sweep L=normal(1, 0.1) keep=h : simulate 1
sweep L=[1, 2] keep=h : print L
sweep L=[1, 2] keep=q : simulate 1
sweep L=range(1, 2, 1e5) h=range(1, 2, 1e5) keep=h : simulate 1
sweep h'=[1, 2] keep=h : simulate 1
montecarlo 0 L=normal(1, 0.1) keep=h : simulate 1
montecarlo 10 L=0.5 keep=h : simulate 1
montecarlo 10 L=normal(1) keep=h : simulate 1
montecarlo 10 L=normal(1, -0.1) keep=h : simulate 1
montecarlo 10 L=triangular(1, 3, 2) keep=h : simulate 1
montecarlo 10 L=truncated(uniform(1, 2), 3, 4) keep=h : simulate 1
montecarlo 10 L=truncated(normal(1, 0.1)) keep=h : simulate 1
montecarlo 10 L=normal(1 s, 0.1 s) keep=h : simulate 1
montecarlo 10 L=normal(1, 0.1) points=halton keep=h : simulate 1
sweep sets="unknown.csv" keep=h : simulate 1
sweep sets="unit.csv" keep=h : simulate 1
sweep sets="number.csv" keep=h : simulate 1
sweep sets="long.csv" keep=h : simulate 1
sweep sets="empty.csv" keep=h : simulate 1
sweep sets="sets.csv" L=1 keep=h : simulate 1
show sweep
print sweep.value(1, h), sweep.runs
sweep sets="sets.csv" keep=[h.fy, period(h)] : simulate 0.1
sweep sets="sets.csv" keep=period(h) : simulate 0.1
sweep sets="sets.csv" keep=h : simulate 0.1
print sweep.value(3, h)
print sweep.value(1, h')
print sweep.mean(h, 2)
print sweep.quantile(h, 2)
print sweep.count
sweep = 1
END
cotree -q -k m.ct wrong.ct 2>&1
cotree -q m.ct -e 'sweep sets="sets.csv" keep=h.fy : assemble' -e 'show sweep'
