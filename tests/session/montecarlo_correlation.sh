# correlated parameters: var(a + b) = s_a^2 + s_b^2 + 2 rho s_a s_b
cat >m.ct <<'END'
a = 1; b = 2
vsource E1 p 0 a
vsource E2 q p b
resistor R1 q 0 1
END
cat >run.ct <<'END'
montecarlo 2000 a=normal(1, 0.3) b=normal(2, 0.4) points=sobol correlation=[[1, 0.5], [0.5, 1]] keep=R1.v : op
expect sweep.mean(R1.v) ~ 3 within 5e-3
expect sweep.deviation(R1.v) ~ sqrt(0.09 + 0.16 + 2*0.5*0.12) within 5e-3
expect sweep.deviation(b) ~ 0.4 within 5e-3
END
cotree -q m.ct run.ct && echo as expected
for c in '[[1, 0.5]]' '0.5' '[[1, 0.5], [0.4, 1]]' '[[1, 1], [1, 1]]'; do
    cotree -q m.ct -e "montecarlo 5 a=normal(1, 1) b=uniform(1, 2) correlation=$c keep=R1.v : op" 2>&1
done
true
