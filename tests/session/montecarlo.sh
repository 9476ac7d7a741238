# random runs: their numbers depend on the seed and on the run alone
# tolerance 1e-4
cat >m.ct <<'END'
vsource E1 a 0 10
R = 1 kohm
resistor R1 a b R
resistor R2 b 0 1 kohm
END
cat >show.ct <<'END'
montecarlo 4 R=normal(1 kohm, 10 ohm) keep=R1.i : op
show sweep
END
cotree -q m.ct show.ct
echo again, and with more runs
cotree -q m.ct -e 'montecarlo 6 R=normal(1 kohm, 10 ohm) keep=R1.i : op' -e 'show sweep' | head -5
echo another seed
cotree -q --seed 2 m.ct show.ct
cotree -q m.ct -e 'set seed 2' show.ct | tail -1
echo quantiles and moments
cat >log.ct <<'END'
isource I1 0 c 1
G = 1
resistor R3 c 0 G
montecarlo 2000 G=lognormal(2, 0.5) points=sobol keep=c.v : op
expect sweep.mean(c.v) ~ 2 within 2e-3
expect sweep.deviation(c.v) ~ 0.5 within 1e-2
expect sweep.quantile(c.v, 0.5) ~ 2/sqrt(1 + 1/16) within 1e-3
montecarlo 500 G=truncated(normal(2, 1), 1, 2) points=latin keep=c.v : op
expect sweep.min(c.v) >= 1 && sweep.max(c.v) <= 2
expect sweep.quantile(c.v, 0.5) ~ 1.5583 within 2e-3
show statistics
END
cotree -q m.ct log.ct
