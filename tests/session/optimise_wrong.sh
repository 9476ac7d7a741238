# what can't be optimised, and what to write instead
cat >m.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m
w = 1
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 0.1
END
cat >wrong.ct <<'END'
optimise Q minimise=h : simulate 1
optimise minimise=h : simulate 1
optimise L : simulate 1
optimise L minimise=h maximise=h : simulate 1
optimise L minimise=[h, h'] : simulate 1
optimise L minimise=q : simulate 1
optimise L minimise=h subject=h : simulate 1
optimise L minimise=h subject=[h != 1] : simulate 1
optimise L minimise=h subject=[h <= 1 m] : simulate 1
optimise L minimise=h subject=[h <= 1 rad, q >= 1] : simulate 1
optimise L minimise=h method=newton : simulate 1
optimise L minimise=h runs=0 : simulate 1
optimise L minimise=h jobs=65 : simulate 1
optimise L=[2, 1] minimise=h : simulate 1
optimise L=2 minimise=h : simulate 1
optimise L minimise=h : print L
optimise L minimise=h limit=2 : simulate 1
optimise L minimise=period(h) : simulate 0.1
optimise L minimise=w subject=[period(h) <= 1 s] : simulate 0.1
optimise L
show optimum
print optimum.value(L)
print optimum.figure
optimum = 1
optimise w minimise=(w^2 - 2)^4 runs=5 : assemble
print optimum.value(L)
print optimum.value(w, w)
print optimum.size
END
cotree -q -k m.ct wrong.ct 2>&1
cotree -D L=0.7 m.ct -e 'optimise L minimise=h : simulate 1' 2>&1 || true
