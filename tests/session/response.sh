# transfer functions and tables of the frequency response, of what was linearized last
cat >model.ct <<'END'
vsource E1 a 0 0
isource I1 0 b 0
resistor R1 a b 1 kohm
capacitor C1 b 0 1 uF
linearize inputs=[E1, I1] outputs=[C1.v] > "linear.txt"
show transfer
show transfer 1 2
bode C1.v from=1 [rad/s] to=1e6 [rad/s] points=3 > "bode.csv"
END
cotree model.ct && cut -d, -f1-3 bode.csv
sed '/^linearize/d' model.ct >early.ct
cotree early.ct 2>errors; echo "$?"; cat errors
# what nothing reaches has no curve, neither in a picture
cat >apart.ct <<'APART'
vsource E1 a 0 0
resistor R1 a 0 1
isource I1 0 c 1
capacitor C1 c 0 1 uF
linearize inputs=[E1] outputs=[C1.v] > "linear.txt"
bode C1.v > "apart.png"
APART
cotree apart.ct 2>errors; echo "$?"; cat errors
test ! -e apart.png || echo "a picture all the same"
