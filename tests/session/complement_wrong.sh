# entries that are not there, too many constraints, independent coordinates that don't fit
cat > wrong.ct << "END"
scene planar
body b mass=1 inertia=1
revolute a ground b
arm c b [1, 0]
body d mass=1 inertia=1
revolute e c d
show complement 3 1
show complement 1 3
show partition as c
show partition a
tree absolute
show partition
show complement
form embedded independent=[b.x]
show partition
show mass 1 1
tree a d
form embedded independent=[a]
show partition
END
cotree -k wrong.ct 2>&1
echo "status $?"
rm -f wrong.ct
