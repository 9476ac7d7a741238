#!/bin/sh
# store and load: a definition with what it needs, taken back and done again; damaged, edited and
# foreign files, and names that are taken
cat >leg.ct <<'END'
scene planar
gravity [0, -9.81]
k = 2
double(x) = 2*x
unused = 3
subsystem rod frames=[A, B] terminals=[e]
  L = 0.4 m
  body b mass=k inertia=0.02
  arm a b [-L/2, 0]
  arm B b [L/2, 0]
  revolute h A a
  actuator m h torque=double(e.v) - h'
end
subsystem leg frames=[A, B] terminals=[e]
  use rod upper A=A e=e
  use rod lower A=upper.B e=e L=0.3
  arm B lower.B [0.1, 0]
end
END
echo '--- stored'
cotree -q leg.ct -e 'store leg "leg.cts"'
sed 's/unedited: .*/unedited: NUMBER/' leg.cts
echo '--- loaded equal to derived'
cat >robot.ct <<'END'
use leg one two A=[ground, one.B] e=v
vsource V v 0 3
init one.upper.h = 0.3, two.lower.h' = 1
simulate 0.3 rtol=1e-10
print one.upper.h, two.lower.B.x, two.upper.h.fx
END
cotree -q leg.ct robot.ct >derived
cotree -q -e 'scene planar; gravity [0, -9.81]; load "leg.cts"' -e 'source "robot.ct"' >loaded
cmp derived loaded && cat loaded
echo '--- undo, redo, again; what stays'
cotree -e 'scene planar' -e 'k = 7' -e 'load "leg.cts"' -e 'print k' -e undo -e 'complete use l' \
    -e redo -e 'load "leg.cts"' -e 'complete use l' -e 'save "again.ct"' -e 'source "robot.ct"' 2>&1
echo '--- stored again: the same, and only over what was stored'
cotree -q -e 'scene planar; load "leg.cts"; store leg "second.cts"; store leg "second.cts"' && cmp leg.cts second.cts
echo 'mine' >mine.txt
cotree -q leg.ct -e 'store leg "mine.txt"' 2>&1
cotree -q leg.ct -e 'store leg "mine.txt" overwrite=on' 2>&1 && cmp leg.cts mine.txt
cotree -q leg.ct -e 'store log "x.cts"' 2>&1
cotree -q leg.ct -e 'store leg ""' 2>&1
for wrong in 'store lag "x.cts"' 'store leg' 'store leg x.cts' 'store "x.cts"' 'store leg "x.cts" now' \
    'store leg "no/x.cts"' 'load' 'load x.cts' 'load "x.cts" "y.cts"' 'load "x.cts" overwrite=on'; do
    cotree -q leg.ct -e "$wrong" 2>&1
done
cotree --safe -q leg.ct -e 'store leg "x.cts"' 2>&1
test ! -e x.cts || echo 'x.cts is there'
echo '--- refused, the model as it was'
number=$(sed -n '1s/.*unedited: //p' leg.cts)
sed 's/mass=k/mass=9/' leg.cts >edited.cts
head -c 300 leg.cts >cut.cts
sed '1s/version 1/version 2/' leg.cts >newer.cts
printf 'body b mass=1 inertia=1\n' >foreign.cts
: >empty.cts
head -c 3000 /dev/urandom >noise.cts
printf '# subsystem stored by cotree, version 1, any scene, unedited: %s\nbody b mass=1 inertia=1\n' \
    "$number" >forged.cts
cotree -q -e 'load "leg.cts"' 2>&1
for file in edited cut newer foreign empty noise forged missing; do
    cotree -q -k -e "scene planar; a = 1" -e "load \"$file.cts\"" -e 'print a' -e 'show params' 2>&1
done
echo '--- a name that is taken'
cotree -q -k -e 'scene planar' -e 'subsystem rod terminals=[a]; resistor R a 0 1; end' -e 'load "leg.cts"' \
    -e 'show params' 2>&1
cotree -q -k -e 'scene planar; resistor leg a b 1' -e 'load "leg.cts"' -e 'show params' 2>&1
echo '--- definitions alone, whoever counted'
evil() { # NUMBER LINE: the number follows from the line
    printf '# subsystem stored by cotree, version 1, any scene, unedited: %s\n%s\n' "$1" "$2" >evil.cts
    cotree -q -k -e 'load "evil.cts"' -e 'show params' 2>&1
}
evil 4b9a9c14338a7074 'quit'
evil 604e6a6588c9fb37 'body b mass=1 inertia=1'
evil 042c74bb4ed84222 'export csv > "stolen.csv"'
evil 018b5bd609778229 'k ='
test ! -e stolen.csv || echo 'stolen.csv is there'
true
