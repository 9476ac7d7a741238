# rows of the last run are written after edits, too, and a remark tells that the model has changed
cat >run.ct <<'END'
scene planar
gravity [0, -9.81]
body b mass=1 inertia=0.1
arm p b [0, 1]
revolute h ground p
init h = 1
simulate 2 every=0.01
END
edit() {
    cat run.ct - <<END >edited.ct
export csv h h' > "before.csv"
export mat h > "before.mat"
table h every=0.5 > "before.txt"
plot h > "before.txt.txt"
$1
export csv h h' > "after.csv"
export mat h > "after.mat"
table h every=0.5 > "after.txt"
plot h > "after.txt.txt"
export csv start h > "start.csv"
print h
END
    cotree edited.ct 2>errors
    cmp before.csv after.csv && cmp before.mat after.mat && cmp before.txt after.txt && cmp before.txt.txt after.txt.txt &&
        wc -l <after.csv && tail -n +2 start.csv
    grep -c 'run1: the model has changed since' errors
}
edit 'set b.mass = 2'
edit 'init h = 2'
edit 'tree absolute'
# not a word where nothing has changed, nor where the start is asked for
{ cat run.ct; echo 'export csv h > "a.csv"'; echo 'init h = 3'; echo 'export csv start h'; } | cotree 2>errors
grep -c "has changed" errors || true
