# a fit has the same bytes whatever number of processes shares its runs, failed ones included
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m; k = 1; c = 0.01
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
spring k1 h k=k
damper c1 h d=c
init h = 1
simulate 3 every=0.05
export csv h h' > "data.csv"
L = 0.48 m; k = 1.1; c = 0.02
END
for jobs in 1 2 8; do
    cat model.ct - >fit.ct <<END
fit L k=[0.1, 5] c=[0, 0.1] to=table("data.csv", t, "h") by=h jobs=$jobs : simulate 3
undo
set jobs $jobs
c = 0.01
L = 0.51 m
fit k L=[0.2, 1] loss=huber to=[table("data.csv", t, "h"), table("data.csv", t, "h'")] by=[h, h'] : simulate 3
expect L ~ 0.5 within 1e-5
expect k ~ 1 within 1e-4
export csv h h' > "run$jobs.csv"
END
    cotree -q fit.ct >"fit$jobs.txt" 2>&1
done
cmp fit1.txt fit2.txt && cmp fit1.txt fit8.txt && echo "same tables"
cmp run1.csv run2.csv && cmp run1.csv run8.csv && echo "same runs"
grep -o "^converged\|.*error:.*" fit1.txt
cotree -q model.ct -e 'fit L to=1 by=h jobs=0 : simulate 1' 2>&1
cotree -q model.ct -e 'fit L to=1 by=h jobs=2 : simulate 1 method=nothing' 2>&1
true
