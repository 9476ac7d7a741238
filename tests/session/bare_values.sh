# an expression alone is printed; a mistyped verb gets its suggestion
cotree -q - <<'END'
scene planar
k6 = 10
d = 2
body m1 mass=1
prismatic s ground m1 axis=x
init s = 0.5, s' = 3
f(x) = x^2
k6
2*k6
-k6
(k6 + 1)*2
d
s, s'
s [mm] m1.vx
energy.total
f(3)
sin(pi/2)
pi
f(k6) - 1
simulate 1
s at 0.5
k6 > "k6.txt"
END
cat k6.txt
echo "--- not those"
cotree -k - <<'END' 2>&1
k6 = 10
body m1 mass=1
simulat
plto
k7
k7 + 1
m1
m2.x
k6 k6
k6 == 10
k6(3)
2 +
time k6
subsystem leg terminals=[a]
k6
simulat
resistor R1 a 0 1
end
END
rm -f k6.txt
