# a netlist becomes statements: all or none, one undo, names legal, what is left out said with its line
try() { # netlist: written, then applied to a model that has an R1
    printf '%s\n' "$1" >try.cir
    echo "--- $1" | head -n 3
    cotree -e 'import spice "try.cir" > "try.ct"' 2>&1 && grep -v '^#' try.ct
    cotree -q -e 'resistor R1 a 0 5' -e 'import spice "try.cir"' -e 'undo' -e 'show params' \
        -e 'show edges' 2>&1 | sed 's/^-e:[0-9]*:[0-9]*: //'
}
cat >whole.cir <<'END'
a circuit "in quotes"
.param r = 1k
V1 1 0 5
r1 1 a+b {r}
C1 a+b 0 1u ic=1
.tran 1m 10m uic
.end
Q1 what follows the end is nothing
END
echo '--- names that are taken, then as they are'
cotree -q -e 'resistor R1 a n1 5; r = 3; r1 = 2' -e 'import spice "whole.cir"' -e 'show edges' \
    -e 'show params' -e 'save "both.ct"' 2>&1
cotree -e 'import spice "whole.cir" > "whole.ct"' -e 'source "whole.ct"' -e 'save "again.ct"'
cat whole.ct
grep -v '^#' whole.ct >bare.ct
grep -v '^#' again.ct | diff bare.ct - && echo same
echo '--- undone and done again'
cotree -q -e 'import spice "whole.cir"' -e 'undo' -e 'print model.n' -e 'redo' -e 'show edges' 2>&1

try '* a transistor
V1 1 0 5
Q1 1 2 0 npn'
try 'twice
R1 a 0 1k
r1 b 0 1k'
try 'a subcircuit that is called once, and one that is not
R1 a 0 1k
X1 a b amp r=2k
.subckt amp in out r=1k
R1 in x {r}
R2 x out {r}
.ends
.subckt other p
Q1 p 0 0 npn
.ends'
try 'a subcircuit without an end
R1 a 0 1k
.subckt amp in out
R2 in out 1'
try 'a subcircuit in itself
X1 a amp
.subckt amp in
X1 in other
.ends
.subckt other in
X2 in amp
.ends'
try 'calls that fit no subcircuit
R1 a 0 1k
.subckt amp in out
R1 in out 1
.ends
X1 a amp
X2 a b none
X3 a b amp gain=3'
try 'cut short
R1 a'
try 'no value
R1 a 0 k1'
try 'an unknown model
D1 a 0 nosuch'
try 'hysteresis
S1 a 0 b 0 sw
R1 b 0 1
.model sw sw vt=1 vh=0.5'
try 'a behavioural source
E1 a 0 value={v(b)*2}
R1 a 0 1'
try 'a circle of parameters
.param x={y} y={x}
R1 a 0 {x}'
try 'refused by the model
R1 a 0 1k
K1 L1 L2 1.5
L1 a 0 1
L2 b 0 1'
try 'what an expression does not close
R1 a 0 {1+(2}'
try 'of no statement
R1 a 0 {1+}'
echo '--- what changes values is taken or refused'
said() { # card...: those that are left out, after a source
    printf '%s\n' 'a title' 'V1 a 0 1' "$@" >said.cir
    cotree -e 'import spice "said.cir" > "said.ct"' 2>&1 && grep -v '^#' said.ct | tail -n +3
}
said 'R1 a b 1k tc1=0.03125' 'R2 b 0 1k' '.temp 91'
said '.param k=0.01' 'R1 a 0 1k tc={k},1e-4 dtemp=10' 'C1 a 0 1u tc1=0.5 temp=29 m=2'
said 'D1 a 0 dz' '.model dz d bv=5.1 ibv=1m'
said 'D1 a 0 dc' '.model dc d cjo=4p vj=0.7'
said 'D1 a 0 d0' '.model d0 d cjo=0 vj=0.7 tt=0'
said 'D1 a 0 dd' '.model dd d gain=3'
said 'D1 a 0 dd ic=0.5' '.model dd d'
said 'R1 a 0 rm l=10u w=1u' '.model rm r rsh=50'
said 'R1 a 0 rm' '.model rm r rsh=50 r=1'
said 'R1 a 0 1k 3' 'R2 a 0 1k no'
said 'L1 a 0 1m rser=0.1' 'L2 a 0 1m rser=0'
said 'S1 a 0 a 0 sw' '.model sw sw vt=0.5 von=1'
said 'V2 b 0 pulse(0 1 0 1u 1u 1m 2m) rser=1' 'R1 b 0 1'
said 'V2 b 0 sin(0 1 1k 0 0 0 3)' 'R1 b 0 1'
said 'R1 a 0 1' '.temp 0 27'
said 'R1 a 0 1' '.temp hot'
said 'R1 a 0 1' '.options reltol=1e-6 gmin=1e-12 rshunt=1e9'
said 'R1 a 0 1' '.if (1)' '.print tran v(a)'
echo '--- files'
cotree -q -e 'import spice "nowhere.cir"' 2>&1
cotree -q -e 'import foo "whole.cir"' 2>&1
mkdir inside
echo 'import spice "../whole.cir"' >inside/out.ct
cotree --safe inside/out.ct 2>&1
cp whole.cir inside && echo 'import spice "whole.cir"; show edges' >inside/in.ct
cotree -q --safe inside/in.ct 2>&1
echo 'import spice "whole.cir" > "new.ct"' >inside/write.ct
cotree -q --safe inside/write.ct 2>&1
true
