# a sweep is killed at random instants until it ends: its file loses no row and doubles none
cat >sweep.ct <<'END'
scene planar
gravity [0, -9.81]
L = 0.5 m
body b mass=1 inertia=0
arm p b [0, L]
revolute h ground p
init h = 1
sweep L=range(0.2, 2, 40) jobs=2 keep=[max(h'), h] file="killed.rows" : simulate 1 method=rk4 step=5e-4
export csv sweep > "killed.csv"
END
sed 's/ file="killed.rows"//; s/killed.csv/whole.csv/' sweep.ct >whole.ct
cotree -q whole.ct
seed=$$
kills=0
while [ ! -f killed.csv ]; do
    cotree -q sweep.ct &
    seed=$(((seed * 16807 + 11) % 2147483647))
    sleep "0.$(printf %02d $((5 + seed % 30)))"
    kill -KILL $! 2>/dev/null && kills=$((kills + 1))
    wait $! 2>/dev/null
done 2>/dev/null
[ $kills -gt 0 ] && echo "killed"
cmp whole.csv killed.csv && echo "same bytes"
grep -a -c '^row' killed.rows | awk '{ print ($1 >= 40 ? "rows" : "lost") }'
# complete lines alone: torn ones have fewer fields
grep -a '^row' killed.rows | awk -F'\t' 'NF == 7 { print $2 }' | sort | uniq -d
