# what would cost without bound is refused, or costs no more than its size
try() {
    timeout 60 cotree -q "$@" >out.txt 2>err.txt </dev/null
    echo "$? $(head -c 60 out.txt)"
    grep 'error:\|hint:' err.txt | cut -c1-120 | sed 's/^ *//' | tail -n 2
}
repeat() { awk -v n="$2" -v s="$1" 'BEGIN { for (i = 0; i < n; i++) printf "%s", s }'; }

echo '--- files'
mkdir folder
mkfifo pipe
(sleep 0.1; printf 'print 7\n') >pipe &
try -e 'source "/dev/zero"'
try -e 'source "folder"'
try -e 'source "pipe"'
echo 'source "a.ct"' >b.ct
echo 'source "b.ct"' >a.ct
try a.ct
try -e 'print table("/dev/zero", 1)'
try -e 'print table("folder", 1)'
echo '--- lines'
{ repeat ';' 1000000; echo 'print 1'; } >many.ct
try many.ct
{ repeat 'a=1;' 40000; echo 'print a; b'; } >many.ct
try many.ct
repeat 'print 1 ' 1000000 >long.ct
try long.ct
{ repeat '1+' 100000; echo 1; } | sed 's/^/print /' >long.ct
try long.ct
{ repeat '(' 100000; repeat ')' 100000; } | sed 's/^/print /' >deep.ct
try deep.ct
repeat 'name' 1000 | sed 's/$/ = 1/' >name.ct
try name.ct
{ printf 'f(t) = pwl(t'; awk 'BEGIN { for (i = 0; i < 100000; i++) printf ", %d, 1", i }'; echo ')'; } >pwl.ct
try pwl.ct
{ printf 'print 1'; repeat ' \\\n' 100000; echo '+ 2'; } >joined.ct
try joined.ct
echo '--- laws'
awk 'BEGIN { print "f0(x) = x^2/2+1"; for (i = 1; i < 40; i++) printf "f%d(x) = f%d(f%d(x))\n", i, i-1, i-1; print "print f39(1)" }' >laws.ct
try laws.ct
awk 'BEGIN { print "f0(x) = x"; for (i = 1; i < 80; i++) printf "f%d(x) = f%d(f%d(x))\n", i, i-1, i-1; print "print f79(1)" }' >laws.ct
try laws.ct
echo '--- rows'
model='scene planar; gravity [0, -9.81]; body m mass=1 inertia=1'
try -e "$model; simulate 1e9 every=1e-9"
try -e "$model; simulate 1 every=1e-8"
try -e "$model; simulate 1 every=0"
try -e "$model; simulate 1 every=-1"
try -e "$model; simulate -1"
try -e "$model; simulate 1; table m.y every=1e-9"
try -e "$model; simulate 1; table m.y every=0"
try -e "$model; simulate 1; print m.y at 1e300"
echo '--- bodies'
awk 'BEGIN { for (i = 0; i < 3000; i++) print "body b" i " mass=1 inertia=[1,2,3]"; print "simulate 1" }' >bodies.ct
try bodies.ct
awk 'BEGIN { for (i = 0; i < 150; i++) print "body b" i " mass=1 inertia=[1,2,3]"; print "gravity [0,0,-2]"; print "simulate 1 every=1 method=rk4 step=0.5"; print "print b149.z" }' >bodies.ct
try bodies.ct
echo '--- undo'
awk 'BEGIN { for (i = 0; i < 10000; i++) print "p" i " = " i; for (i = 0; i < 9999; i++) print "undo"; print "show params" }' >undo.ct
try undo.ct
awk 'BEGIN { print "p = -1"; for (i = 0; i < 10000; i++) print "p = " i; for (i = 0; i < 10000; i++) print "undo";
             for (i = 0; i < 5000; i++) print "redo"; print "print p" }' >undo.ct
try undo.ct
awk 'BEGIN { print "body m mass=1 inertia=[1,1,1]"; for (i = 0; i < 5000; i++) print "set m.mass = " i+1; for (i = 0; i < 4999; i++) print "undo";
             print "save \"m.ct\"" }' >undo.ct
try undo.ct
tail -n 1 m.ct
