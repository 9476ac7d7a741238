# instances of subsystems as the edges of their ports: the paper's equations (21) and (22), and the
# graphs of its figures 12 and 13
sed '/^expect/d; /^simulate/d; /^export/d' "$TOP_SRCDIR/scripts/paper/6_parallel_forward.ct" >robot.ct
echo '--- (21) and (22)'
cotree -q robot.ct -e 'show cutsets m9; show circuits h10 h11 h12'
echo '--- what the legs take from where they stand, and from their sources'
cotree -q robot.ct -e 'show cutsets g1 p2; show cutsets V1'
echo '--- all that is inside'
cotree -q robot.ct -e 'show circuits h10 open; show cutsets leg1.th1'
echo '--- drawn'
cotree -q robot.ct -e 'draw collapsed; draw collapsed > "box.svg"; draw circuit h11 collapsed > "lit.svg"'
grep -c 'leg[123]\.B' box.svg
grep -c 'leg[123]\.th1' box.svg
cotree -q robot.ct -e 'draw collapsed > "box.dot"'
grep '^  u' box.dot
cotree -q robot.ct -e 'draw open' | grep -c 'leg[123]\.th1'
echo '--- a way from ground through the inside, and a leg that hangs on another'
cat >chain.ct <<'END'
scene planar
subsystem rod frames=[A, B] terminals=[e, o] through=[o]
  body b mass=1 inertia=1
  arm a b [1, 0]
  arm B b [-1, 0]
  revolute h A a
  resistor R e o 5
end
vsource V n 0 1
use rod u A=ground e=n
use rod v A=u.B e=u.o
capacitor C v.o 0 1
prismatic s ground v.B axis=x
tree u.h v.h V C
show circuits s
show cutsets C
tree absolute
show circuits s
draw collapsed
END
cotree -q chain.ct
echo '--- what is asked wrong'
cotree -k -q robot.ct -e 'draw collapsed m9' -e 'draw circuit collapsed' -e 'show cutsets leg1.A' \
    -e 'draw closed' 2>&1 || true
