# Numbers that equations hold as symbols (#L1.L[0]) stand in nothing that is printed: of long chains
# and networks, and of functions of such numbers. The tree notation numbers its nodes: #3.
{
    echo 'scene planar'
    at=ground
    for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18; do
        echo "body b$i mass=1.$i inertia=0.1$i; arm a$i b$i [-0.3$i, 0]; arm e$i b$i [0.2$i, 0]"
        echo "revolute h$i $at a$i"
        at=e$i
    done
    echo 'motor M1 h1 a 0 R=1.3 L=0.11 Kt=0.51 Kv=0.53; vsource E1 a 0 sin(t)'
    echo 'simulate 0.01'
} > chain.ct
{
    echo 'vsource E1 a0 0 sin(t)'
    for i in 0 1 2 3 4 5 6 7 8 9; do
        for k in 0 1 2 3 4; do
            echo "resistor R$i$k a$i c$i$k 1$i.$k; inductor L$i$k c$i$k 0 0.1$k$i"
        done
        [ $i = 9 ] || echo "resistor S$i a$i a$((i + 1)) 3.$i"
    done
    echo 'coupling K1 L00 L01 k=0.45; coupling K2 L11 L12 k=0.31'
    echo 'simulate 1e-3'
} > ladder.ct
for topic in equations network program 'transfer L00.v E1'; do
    for form in '' ' as latex' ' as c' ' as fortran' ' as matlab' ' as python'; do
        echo "show $topic$form"
    done
done > topics.ct
printf 'show %s\n' derivation 'S2.i' >> topics.ct
printf 'export %s\n' c fortran matlab python >> topics.ct
for model in chain ladder; do
    cotree -q -k -e "source \"$model.ct\"" topics.ct 2> /dev/null > all
    [ "$(wc -l < all)" -gt 300 ] && echo "$model is printed"
    grep -nE '#(start|[A-Za-z]+[0-9]*\.[A-Za-z]+|[0-9]+\.[0-9])|[^A-Za-z0-9_]_(0_|start)' all | head -5
done
exit 0
