# rows of a sweep are the same bytes whatever number of processes shares it, failed ones included
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m; k = 1
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
spring k1 h k=k
init h = 1
END
for jobs in 1 2 8; do
    cat model.ct - >sweep.ct <<END
set jobs $jobs
sweep L=range(-0.2, 2, 12) k=[0, 1, 5] keep=[max(h'), h, first(h < -0.6)] : simulate 3
show sweep > "sweep$jobs.txt"
export csv sweep > "sweep$jobs.csv"
sweep L=range(0, 2, 12) jobs=$((9 - jobs)) keep=h : simulate 1
show sweep >> "sweep$jobs.txt"
montecarlo 60 L=normal(0.5, 0.01) jobs=$jobs keep=max(h') : simulate 1
show statistics >> "sweep$jobs.txt"
END
    cotree -q sweep.ct 2>errors$jobs
done
cmp sweep1.txt sweep2.txt && cmp sweep1.txt sweep8.txt && echo "same tables"
cmp sweep1.csv sweep2.csv && cmp sweep1.csv sweep8.csv && echo "same rows"
cmp errors1 errors2 && cmp errors1 errors8 && echo "same errors"
cat errors1
wc -l <sweep1.csv
cotree -q model.ct -e 'sweep L=[1, 2] jobs=0 keep=h : simulate 1' 2>&1
cotree -q model.ct -e 'sweep L=[1, 2] jobs=65 keep=h : simulate 1' 2>&1
cotree -q model.ct -e 'sweep L=[1, 2, 3] jobs=2 keep=nothing : simulate 1' 2>&1
true
