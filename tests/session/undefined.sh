# what has no value is said to have none, and is never near
cat >undefined.ct <<'END'
scene planar
gravity [0, 0]
body m mass=1 inertia=1
revolute h ground m
init h = 1, h' = -0.75
simulate 2 every=1
print sqrt(h), h, log(h - 1), 1/(h + 1)
print log(h - 1) at 0
table h sqrt(h) (1/(h - 1))
export csv sqrt(h) (1/(h - 1))
expect sqrt(h) ~ 1 within 10
expect 1 ~ sqrt(h) within 10
expect 1 < sqrt(h)
END
cotree -k undefined.ct 2>errors.txt
echo "$?"
grep 'error:' errors.txt
