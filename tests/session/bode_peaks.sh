# peaks of a double pendulum with a motor: -12.2229 dB at 0.30954 Hz and -23.2041 dB at 1.09536 Hz, by its
# matrices; each is drawn within 0.1 dB
cat >model.ct <<'END'
scene planar; gravity [0, -9.81]
body m1 mass=1 inertia=0.1
arm p1 m1 [0, 1]
arm q1 m1 [0, -1]
body m2 mass=1 inertia=0.1
arm p2 m2 [0, 1]
revolute h1 ground p1
revolute h2 q1 p2
damper d1 h1 d=0.4
vsource V1 a 0 0
motor M1 h1 a 0 R=2 L=10 mH Kt=0.5
equilibrium
linearize inputs=[V1] outputs=[h1]
bode h1 > "peaks.csv"
bode h1 points=5 > "few.csv"
END
cotree model.ct >linear.txt || exit 1
for file in peaks few; do
    for peak in "0.25 0.35 -12.2229" "0.9 1.3 -23.2043"; do
        set -- $peak
        awk -F, -v low="$1" -v high="$2" -v wanted="$3" '
            $1 > low && $1 < high && (most == "" || $2 > most) { most = $2 }
            END { print (wanted - most < 0.1 && most - wanted < 1e-4 ? "drawn" : "not drawn: " most) }
        ' "$file.csv"
    done
done
# far from all roots the gain is a number; further it is refused
cat >far.ct <<'END'
vsource V a 0 1
resistor R a b 1 kohm
capacitor C b 0 1 uF
resistor R2 b c 1 kohm
capacitor C2 c 0 1 uF
resistor R3 c d 1 kohm
capacitor C3 d 0 1 uF
linearize inputs=[V] outputs=[d.v]
bode d.v from=5 to=1e140 points=3 > "far.csv"
bode d.v from=5 to=1e300 > "none.csv"
END
cotree far.ct >linear.txt
echo "$?"
# three poles and 1e9 s^-3: -60 log10(2 pi 1e140) + 180 dB
tail -1 far.csv
test ! -e none.csv
