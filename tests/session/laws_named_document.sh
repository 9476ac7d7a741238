# the document of `export latex` defines each law once, below the first equations that call it
cotree -q - <<'EOF' > all.tex
k(x) = 200*x + 1e4*x^3
body b mass=1 inertia=[1, 1, 1]
prismatic p ground b axis=x
actuator a p force=-k(p)
vsource V1 n 0 k(p)
capacitor C1 n m 1 uF
resistor R1 m 0 1 ohm
tree electrical V1 R1
set laws named
export latex
EOF
sed -n '/Forces/,$p' all.tex
