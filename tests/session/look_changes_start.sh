# looking at a model changes no start; undo and save leave it as it is, and save writes an equilibrium
cat >pendulum.ct <<'END'
scene planar
body m mass=1 inertia=0.1
arm a m [-0.4, 0]
revolute h ground a
END
cat >edited.ct <<'END'
delete h
simulate 1 every=1
print m.x at 0
END
for look in "" "print m.x" "assemble" "modes" "check" "count" "draw" "show equations"; do
  { cat pendulum.ct; echo "$look"; cat edited.ct; } >walk.ct
  cotree -q walk.ct 2>/dev/null | tail -n 1
done
{ cat pendulum.ct; echo 'assemble; gravity [0, -1]; undo'; cat edited.ct; } >walk.ct
cotree -q walk.ct 2>/dev/null | tail -n 1
# 7.5 V at rest: after edits, looks, undo and redo, and in the saved text
cat >rest.ct <<'END'
vsource V a 0 10
resistor R1 a b 100
capacitor C1 b 0 1 uF
resistor R2 b 0 300
init C1.v = 3
op
undo
show init
redo
show init
assemble
simulate 1 us every=1e-6
print C1.v at 0
save "rest.out.ct"
delete R2
undo
clear
source "rest.out.ct"
simulate 1 us every=1e-6
print C1.v at 0
delete C1
show init
END
cotree -q rest.ct
