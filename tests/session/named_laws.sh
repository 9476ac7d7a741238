# diodes' laws are called by name and told once beneath: merged terms (D1 and D4 in one node, D2 and D3 beside
# R2), a voltage that is an expression (D2), laws alike, one that switches
cat >model.ct <<'END'
Is = 1e-14 A
vsource E1 a 0 5*sin(2*pi*50*t)
resistor R1 a b 100
diode D1 b c Is=Is n=1
capacitor C1 c 0 10 uF
resistor R2 c 0 1 kohm
diode D2 0 c Is=Is
diode D3 c 0 Is=1e-12 n=2
diode D4 b d Is=Is
capacitor C2 d 0 1 uF
resistor R4 d 0 2 kohm
diode D5 e 0 Ron=1 Roff=1e6 Vf=0.7
resistor R5 a e 10
END
cotree -q model.ct -e 'show network' | tee network.txt
echo '--- for a paper'
cotree -q model.ct -e 'show D1.i as latex'
echo '--- derived: the circuit of D1, its law as it is, and then by name'
cotree -q model.ct -e 'show derivation D1'
echo '--- for a compiler: nothing is named'
cotree -q model.ct -e 'show network as c' | grep -c law
echo '--- the named equations, read back as laws and conditions, hold in a run'
sed -n 's/^where//; s/·/*/g; s/π/pi/g; s/\(D[0-9]\)\.law/law\1/g
    s/^ *\(law.*\) = \(law.*\) = \(law.*\) = \(.*\)/\1 = \4\n\2 = \4\n\3 = \4/
    /^ *law/p' network.txt >laws.ct
sed -n 's/·/*/g; s/π/pi/g; s/\(D[0-9]\)\.law/law\1/g
    s/^[A-Z][0-9]:  *\(.*\) = \(.*\)/expect \1 ~ \2 within 1e-6 at TIME/p' network.txt >equations
wc -l <laws.ct
wc -l <equations
for time in 0.003 0.0071 0.0134; do sed "s/TIME/$time/" equations; done >held.ct
{
    cat model.ct laws.ct
    echo 'simulate 0.02 rtol=1e-9 atol=1e-12'
    cat held.ct
    echo 'print "all hold"'
} >checked.ct
cotree -q checked.ct
