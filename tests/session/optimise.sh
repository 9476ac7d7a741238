# parameters that minimise figures of runs: closed forms, bounds, constraints; what else it leaves
cat >model.ct <<'END'
scene planar
k = 40 [N/m]
d = 1
m = 1 kg
body b mass=m inertia=1
prismatic s ground b axis=x
spring S s k=k
damper D s d=d
init s = 1
END
cat >optimise.ct <<'END'
# the period of the undamped oscillator is 2 pi sqrt(m/k)
delete D
optimise k=[1, 100] minimise=(period(s) - 1)^2 : simulate 5
expect k ~ (2*pi)^2 within 1e-3
expect optimum.value(k) ~ k within 0
expect optimum.converged == 1 && optimum.figure < 1e-10
expect optimum.initial ~ (2*pi/sqrt(40) - 1)^2 within 1e-6
undo
print k
# its velocity at s = 0 is sqrt(k/m): the limit is a constraint
optimise k maximise=k subject=max(s') <= 5 : simulate 3 every=0.001
expect k ~ 25 [N/m] within 1e-3
optimise k=[1, 20] maximise=k subject=[max(s') <= 5] : simulate 3
expect k == 20 [N/m]
# lightest mass and softest spring with a frequency and a largest force
optimise k=[1, 1000] m=[0.1, 10] minimise=m subject=[modes.omega(1) == 10, k >= 50] : modes
expect m ~ 0.5 within 1e-5
# no such k
optimise k=[1, 20] minimise=k subject=[max(s') <= 5, period(s) <= 0.5 s] : simulate 3
print k
show optimum
END
cotree -q -k model.ct optimise.ct 2>&1 |
    sed 's/in [0-9]* runs/in SOME runs/; s/[-0-9.]*e-[0-9]*/TINY/g; s/by [0-9.]* at/by SOME at/'
# the same bytes for any number of processes
for jobs in 1 2 8; do
    cotree -q model.ct -e "optimise k=[1, 100] d=[0.1, 5] jobs=$jobs minimise=rms(s) subject=[d <= 4, rms(s') <= 1] : simulate 5" \
        -e 'print k, d' -e 'export csv s > "run.csv"' >out$jobs 2>&1
    cat run.csv >>out$jobs
done
cmp out1 out2 && cmp out1 out8 && echo "same bytes"
