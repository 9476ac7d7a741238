# what building and running has to say goes to standard error, and nowhere with -q
cat >model.ct <<'END'
scene planar
gravity [0, -9.81]
body m1 mass=2 inertia=0.1
arm r1 m1 [0, 1]
revolute h1 ground r1
init h1 = 60 deg
tree h1
simulate 1 every=0.1
time print h1
undo
save "saved.ct"
END
cotree model.ct >out.txt 2>said.txt
wc -l <out.txt
sed 's/[0-9.e+-]* \(steps\|evaluations\|J\)/N \1/g; s/[0-9.e-]* s$/N s/; s/ functions.*/ functions/' said.txt
cotree -q model.ct 2>&1 >quiet.txt | sed 's/[0-9.e-]* s$/N s/'
cmp out.txt quiet.txt
