# what can't be fitted, and what to write instead
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
printf 't, h\n0, 0.1\n0.1, 0.09\n0.2, 0.08\n' >data.csv
printf 't, h\n10, 0.1\n20, 0.09\n' >late.csv
cat >wrong.ct <<'END'
fit Q to=table("data.csv", t, "h") by=h : simulate 1
fit b.mass to=table("data.csv", t, "h") by=h : simulate 1
fit 3 to=table("data.csv", t, "h") by=h : simulate 1
fit L L to=table("data.csv", t, "h") by=h : simulate 1
fit to=table("data.csv", t, "h") by=h : simulate 1
fit L by=h : simulate 1
fit L to=table("data.csv", t, "h") : simulate 1
fit L to=table("data.csv", t, "h") buy=h : simulate 1
fit L to=table("none.csv", t, "h") by=h : simulate 1
fit L to=table("data.csv", t, "q") by=h : simulate 1
fit L to=table("data.csv", h, "h") by=h : simulate 1
fit L to=table("data.csv", t, "h") by=q : simulate 1
fit L to=table("late.csv", t, "h") by=h : simulate 1
fit L to=table("data.csv", t, "h") by=h : modes
fit L to=table("data.csv", t, "h") by=h : print L
fit L to=[1, 2] by=h : simulate 1
fit L to=1 by=[h, h'] : simulate 1
fit L to=1 s by=h.fy : simulate 1
fit L to=1 by=h sigma=0 : simulate 1
fit L to=1 by=h sigma=[1, 2] : simulate 1
fit L to=1 by=h loss=abs : simulate 1
fit L=1 to=1 by=h : simulate 1
fit L=[2, 1] to=1 by=h : simulate 1
fit L=[1 s, 2 s] to=1 by=h : simulate 1
fit L to=1 s by=period(h) : simulate 0.1
fit L
show fit
plot fit
print fit.value(L)
print fit.points
fit = 1
fit w L to=table("data.csv", t, "h") by=h : simulate 1
print fit.value(Q)
print fit.value(L, L)
print fit.size
END
cotree -q -k m.ct wrong.ct 2>&1
cotree -D L=0.7 m.ct -e 'fit L to=table("data.csv", t, "h") by=h : simulate 1' 2>&1 || true
