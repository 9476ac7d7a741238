# a model of one kind doesn't count what it has nothing of: circuits no coordinates, mechanisms no
# network; an empty model says so
circuit='vsource E1 a 0 10; resistor R1 a b 100; capacitor C1 b 0 1 uF'
water='pump U1 a 0 pressure=1e5; pipe P1 a b R=1e6; tank K1 b 0 A=1'
heat='tempsource T1 a 0 300; heatres R1 a b R=2; heatcap C1 b 0 C=5'
divider='vsource E1 a 0 10; resistor R1 a b 100; resistor R2 b 0 100'
pendulum='scene planar; gravity [0, -9.81]; body b mass=1 inertia=0.1; arm r b [-0.5, 0]
revolute h ground r'

# all that speaks of equations, sizes and unknowns
ask() {
    for verb in check tree 'tree joint' 'show coordinates' 'show constraints' 'show jacobian' \
        'show mass' 'show forces' 'show equations' 'show network' 'show derivation' \
        'show structure' count 'count trees' assemble 'simulate 0.001' 'linearize' modes; do
        printf '%s\n%s\n' "$1" "$verb" | cotree 2>&1
    done
}

for model in "$circuit" "$water" "$heat" "$divider"; do
    echo "mechanics spoken of in: $model"
    ask "$model" | grep -E '(^|[^0-9.])0 (coordinate|constraint|degree|speed|x 0)|coordinates +0|n  m'
done
echo "networks spoken of in a pendulum:"
ask "$pendulum" | grep -E 'network +0|states +0|unknowns +0|0 state|0 algebraic'

for verb in check 'show mass' 'show forces' 'show constraints' 'show jacobian' 'show coordinates' \
    'show structure' 'tree joint' 'count trees'; do
    echo "--- $verb, of the circuit"
    printf '%s\n%s\n' "$circuit" "$verb" | cotree 2>&1
done
for verb in check 'show coordinates' 'show equations' 'show derivation' 'show structure'; do
    echo "--- $verb, of nothing"
    echo "$verb" | cotree -q 2>&1
done
echo "--- a table of all that there is"
printf '%s\n' "$circuit" 'simulate 1e-4 every=1e-4' 'table' 'export csv' 'set units mV' 'table' |
    cotree -q 2>&1
