# parameters that match data, with their errors; what the data leave open; bounds; the plot
cat >model.ct <<'END'
scene planar
k = 40 [N/m]
d = 1
m = 1 kg
x0 = 1 m
body b mass=m inertia=1
prismatic s ground b axis=x
spring S s k=k
damper D s d=d
init s = x0
END
# the oscillator's closed form, with noise of 5 mm from a fixed generator (Park and Miller)
awk 'function u() { seed = seed*16807 % 2147483647; return seed/2147483647 }
     BEGIN {
         seed = 1
         for (i = 0; i < 10; i++)
             u()
         print "t, x [mm], v [m/s]"
         w = sqrt(40 - 0.25)
         for (i = 0; i <= 60; i++) {
             t = 0.05*i
             x = exp(-t/2)*(cos(w*t) + 0.5/w*sin(w*t))
             v = -40/w*exp(-t/2)*sin(w*t)
             x += 0.005*sqrt(-2*log(u()))*cos(6.283185307179586*u())
             v += 0.05*sqrt(-2*log(u()))*cos(6.283185307179586*u())
             printf "%.3f, %.9f, %.9f\n", t, 1000*x, v
         }
         print "4, 0, 0"
     }' >data.csv
cat >fit.ct <<'END'
k = 30 [N/m]
d = 0.5
x0 = 0.8 m
fit k d x0 to=table("data.csv", t, "x") by=s : simulate 3
expect abs(fit.value(k) - 40) < 3*fit.error(k) && abs(fit.value(d) - 1) < 3*fit.error(d)
expect abs(fit.value(x0) - 1) < 3*fit.error(x0)
expect fit.rms ~ 0.005 m within 0.0015
expect fit.points == 61 && fit.converged == 1
expect k ~ fit.value(k) within 0
expect s ~ fit.value(x0) within 1e-12 at 0
expect fit.half(k) ~ 2.0017*fit.error(k) within 1e-3
undo
print k, d, x0

# two signals, weighted by their residuals: the errors decrease
fit k d x0 to=[table("data.csv", t, "x"), table("data.csv", t, "v")] by=[s, b.vx] : simulate 3
expect fit.error(k) < 0.02
expect abs(fit.value(k) - 40) < 3*fit.error(k) && abs(fit.value(d) - 1) < 3*fit.error(d)
keep k2 = fit.value(k)
# the same with given standard deviations, and by a loss
fit k d x0 to=[table("data.csv", t, "x"), table("data.csv", t, "v")] by=[s, b.vx] sigma=[5 mm, 0.05] : simulate 3
expect abs(fit.value(k) - k2) < fit.error(k)
fit k d x0 to=table("data.csv", t, "x") by=s loss=huber : simulate 3
expect abs(fit.value(k) - k2) < 3*fit.error(k)

# k/m alone matters without the damper
delete D
k = 30 [N/m]
x0 = 1 m
fit k m to=table("data.csv", t, "x") by=s : simulate 0.5
print fit.error(k), k/m

# a bound
fit m k=[10, 30] to=table("data.csv", t, "x") by=s : simulate 0.5
expect k <= 30 [N/m]
m = 1 kg
fit k=[10, 30] to=table("data.csv", t, "x") by=s : simulate 0.5
expect k == 30 [N/m]

# a number as the goal, of a closed form
fit k=[1, 500] to=0.5 s by=period(s) : simulate 5
expect k ~ (2*pi/0.5)^2 within 1e-4
fit k to=10 by=modes.omega(1) : modes
expect k ~ 100 [N/m] within 1e-5
plot fit
END
cotree -q -k model.ct fit.ct 2>&1 |
    sed 's/in [0-9]* iterations*, [0-9]* runs/in SOME runs/; s/[0-9.]*e-1[0-9]/TINY/'
cat >plot.ct <<'END'
k = 30 [N/m]
fit k to=table("data.csv", t, "x") by=s : simulate 1
plot fit > "fit.gp"
END
cotree -q model.ct plot.ct 2>&1 | sed -n '1,2p'
grep -c 'data.csv' fit.gp
