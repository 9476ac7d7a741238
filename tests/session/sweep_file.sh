# rows in a file: parts and their merge, rows that are there already, damaged lines, what is refused
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
runs="sweep L=range(-0.2, 2, 12) k=[0, 1, 5] keep=[max(h'), h]"
cotree -q model.ct -e "$runs : simulate 3" -e 'export csv sweep > "whole.csv"' -e 'show sweep > "whole.txt"' 2>whole.errors
for part in 1 2 3 4 5; do
    cotree -q model.ct -e "$runs part=$part/5 jobs=$part file=\"$part.rows\" : simulate 3" 2>/dev/null
done
cotree model.ct -e 'merge "1.rows" "2.rows" "3.rows" "4.rows" "5.rows"' -e 'export csv sweep > "merged.csv"' \
    -e 'show sweep > "merged.txt"' 2>&1
cmp whole.csv merged.csv && cmp whole.txt merged.txt && echo "same bytes"
cotree -q model.ct -e 'merge "5.rows" "2.rows" "3.rows" "2.rows"' -e 'print sweep.runs, sweep.value(3, h)' -e 'show sweep' 2>&1 |
    sed -n 1,8p

# all rows are there: none is made again. One line is damaged, the last one torn: two rows are made
remark() {
    cotree model.ct -e "$runs file=\"all.rows\" : simulate 3" -e 'export csv sweep > "again.csv"' 2>&1 | sed 's/, [-.e0-9]* s;/, SOME s;/'
    cmp whole.csv again.csv && echo "same bytes"
}
remark
remark
sed -i '5s/\(.*\)\(.\)$/\1x/' all.rows
head -c -30 all.rows >torn.rows && mv torn.rows all.rows
remark
remark
grep -c . all.rows

# what is refused
cotree -q -k model.ct -e "sweep L=[1, 2] keep=h file=\"all.rows\" : simulate 3" \
    -e "$runs file=\"all.rows\" : simulate 4" \
    -e 'k1.k = 3' -e "set k1.k = 3; $runs file=\"all.rows\" : simulate 3" \
    -e 'sweep L=[1, 2] keep=h part=1/2 : simulate 1' \
    -e 'sweep L=[1, 2] keep=h part=3/2 file="x.rows" : simulate 1' \
    -e 'sweep L=[1, 2] keep=h part=0.5 file="x.rows" : simulate 1' \
    -e 'sweep L=[1, 2] keep=h file=rows : simulate 1' \
    -e 'sweep L=[1, 2] keep=h file="model.ct" : simulate 1' \
    -e 'sweep L=[1, 2] keep=h file="none/x.rows" : simulate 1' \
    -e 'merge' -e 'merge rows' -e 'merge "none.rows"' -e 'merge "model.ct"' \
    -e 'sweep L=[1, 2] keep=h file="other.rows" : simulate 1' -e 'merge "1.rows" "other.rows"' 2>&1
cotree -q --safe model.ct -e 'sweep L=[1, 2] keep=h file="safe.rows" : simulate 1' 2>&1
ls safe.rows 2>/dev/null
# more parts than runs
cotree -q model.ct -e 'sweep L=[1, 2] keep=h part=3/3 file="empty.rows" : simulate 1' -e 'merge "empty.rows"' -e 'print sweep.runs' 2>&1
cotree model.ct -e 'montecarlo 20 L=normal(1, 0.1) keep=h part=2/2 file="m2.rows" : simulate 1' \
    -e 'montecarlo 20 L=normal(1, 0.1) keep=h part=1/2 file="m1.rows" : simulate 1' \
    -e 'merge "m1.rows" "m2.rows"' -e 'keep A = sweep.mean(h)' \
    -e 'montecarlo 20 L=normal(1, 0.1) keep=h : simulate 1' -e 'expect sweep.mean(h) ~ A within 0' 2>&1 |
    sed 's/, [-.e0-9]* s;/, SOME s;/'
