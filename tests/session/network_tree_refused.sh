# A tree whose equations need the derivative of an acceleration is refused with the edge, by the
# setting and by the choice of the tree, and the model stays as it was.
cat > model.ct <<'E2'
scene planar
body m1 mass=1 inertia=0.1
prismatic s1 ground m1 axis=x
pump U1 a 0 pressure=sin(t)
pipe P1 a c R=2
inertance I1 c b I=0.5
tank T1 b 0 C=0.1
cylinder Y1 s1 b 0 area=1
E2
{ cat model.ct; printf 'tree hydraulic U1 I1 P1\nset network tree\nset jobs 1\nshow settings\nshow mass\n'; } > set.ct
{ cat model.ct; printf 'tree hydraulic U1 T1 P1\nset network tree\ntree hydraulic U1 I1 P1\ntree\n'; } > tree.ct
for script in set tree; do
    cotree -q -k $script.ct 2>&1 | grep -v '^network in\|coordinate,'
done
exit 0
