# record keeps accepted statements only; history tells them; save rebuilds the model
cat >model.ct <<'END'
a = 1
record "kept.ct"
scene planar; body m1 mass=a inertia=1
time b = 2
set digits 3
record off
c = 3
history
save "saved.ct"
END
cotree model.ct 2>/dev/null
echo "--- kept"
cat kept.ct
printf 'record "kept.ct"\nplto\n' | cotree 2>/dev/null
wc -l <kept.ct
cotree saved.ct -e 'save "again.ct"'
cmp saved.ct again.ct
