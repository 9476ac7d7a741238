#!/usr/bin/env python3
"""Motions of the machines in this folder, from equations written by hand.

Nothing of cotree is used: minimal coordinates, the equations beside each machine, the classical
Runge-Kutta method with steps halved and extrapolated once. Prints what the scripts expect.
"""

from math import asin, cos, exp, pi, sin, sqrt


def march(rates, y, end, steps):
    h = end / steps
    for n in range(steps):
        t = n * h
        a = rates(t, y)
        b = rates(t + h / 2, [u + h / 2 * v for u, v in zip(y, a)])
        c = rates(t + h / 2, [u + h / 2 * v for u, v in zip(y, b)])
        d = rates(t + h, [u + h * v for u, v in zip(y, c)])
        y = [u + h / 6 * (p + 2 * q + 2 * r + s) for u, p, q, r, s in zip(y, a, b, c, d)]
    return y


def tell(name, rates, start, end, steps):
    coarse = march(rates, start, end, steps)
    fine = march(rates, start, end, 2 * steps)
    best = [f + (f - c) / 15 for f, c in zip(fine, coarse)]
    off = max(abs(b - f) for b, f in zip(best, fine))
    print(f"{name} at {end}: ", ", ".join(f"{x:.12g}" for x in best), f"(to {off:.1g})")


def slider_crank(t, y):
    """J(q) q'' + J'(q)/2 q'^2 = N Kt i - g (m1 a cos q + m2 ky) - d ks^2 q'

    q turns the crank, k* are rates of the rod's angle f, of its centre and of the slider by q'.
    """
    q, w, i = y
    r, l, a, b = 0.05, 0.2, 0.01, 0.08
    m1, I1, m2, I2, m3, d, g = 0.4, 5e-4, 0.3, 1.2e-3, 0.5, 4.0, 9.81
    R, L, K, J, N, V = 1.2, 2e-3, 0.05, 2e-5, 5.0, 24.0
    f = -asin(r / l * sin(q))
    kf = -r * cos(q) / (l * cos(f))
    kx, ky = -r * sin(q) - b * sin(f) * kf, r * cos(q) + b * cos(f) * kf
    ks = -r * sin(q) - l * sin(f) * kf
    cf = r * sin(q) / (l * cos(f)) - r * cos(q) * sin(f) / (l * cos(f) ** 2) * kf
    cx = -r * cos(q) - b * cos(f) * kf**2 - b * sin(f) * cf
    cy = -r * sin(q) - b * sin(f) * kf**2 + b * cos(f) * cf
    cs = -r * cos(q) - l * cos(f) * kf**2 - l * sin(f) * cf
    inertia = I1 + m1 * a**2 + N**2 * J + m2 * (kx**2 + ky**2) + I2 * kf**2 + m3 * ks**2
    half = m2 * (kx * cx + ky * cy) + I2 * kf * cf + m3 * ks * cs
    torque = N * K * i - g * (m1 * a * cos(q) + m2 * ky) - d * ks**2 * w
    return [w, (torque - half * w**2) / inertia, (V - R * i - N * K * w) / L]


def maglev(t, y):
    """m x'' = m g - Q i^2/(2 (X + x)^2), (L(x) i)' = v - R i, x the gap below the magnet"""
    x, u, i = y
    m, g, Q, X, Linf, R = 0.05, 9.81, 2e-4, 2e-3, 0.02, 8.0
    x0, w, z = 8e-3, 60.0, 0.7
    i0 = sqrt(2 * m * g / Q) * (X + x0)
    L0 = Linf + Q / (X + x0)
    kx, ki = Q * i0**2 / (X + x0) ** 3, Q * i0 / (X + x0) ** 2
    p = R / L0 - 2 * z * w
    Kp = (m * L0 * p * w**2 + kx * R) / ki
    Kd = (m * L0 * (w**2 + 2 * z * w * p) + kx * L0) / ki - ki
    v = R * i0 + Kp * (x - x0) + Kd * u
    L = Linf + Q / (X + x)
    return [u, g - Q * i**2 / (2 * m * (X + x) ** 2), (v - R * i + Q / (X + x) ** 2 * u * i) / L]


def crane(t, y):
    """(M + m + N^2 J) s'' + m l (q'' cos q - q'^2 sin q) = N Kt i - (d + N^2 B) s'
    (I + m l^2) q'' + m l (s'' cos q + g sin q) = 0, z the integral of the error"""
    s, q, u, w, i, z = y
    M, m, I, l, d, g = 20.0, 50.0, 1.5, 2.0, 15.0, 9.81
    R, L, K, J, N = 0.6, 1e-3, 0.12, 4e-4, 60.0
    Kp, Ki, Kd, way, T = 200.0, 100.0, 150.0, 3.0, 5.0
    n = min(t / T, 1)
    ref = way * (n - sin(2 * pi * n) / (2 * pi))
    v = Kp * (ref - s) + Ki * z + Kd * (way / T * (1 - cos(2 * pi * n)) - u)
    a, b, c = M + m + N**2 * J, m * l * cos(q), I + m * l**2
    force = N * K * i - d * u + m * l * w**2 * sin(q)
    moment = -m * l * g * sin(q)
    det = a * c - b * b
    return [
        u,
        w,
        (c * force - b * moment) / det,
        (a * moment - b * force) / det,
        (v - R * i - N * K * u) / L,
        ref - s,
    ]


def microphone(t, y):
    """m s'' + d s' + k s + m g = q^2/(2 eA), L i' = E - R i - q (s0 - s)/eA, q' = i"""
    s, u, q, i = y
    m, d, k, g, eA, s0, R, L = 0.1, 0.8, 200.0, 9.81, 5e-5, 0.05, 10.0, 1.0
    E = 16 * (1 - exp(-t / 0.1))
    return [u, q * q / (2 * eA * m) - g - (k * s + d * u) / m, i, E - R * i - q * (s0 - s) / eA]


for end, steps in ((0.1, 1000), (0.5, 4000)):
    tell("slider-crank: angle, rate, current", slider_crank, [pi / 2, 0, 0], end, steps)
i0 = sqrt(2 * 0.05 * 9.81 / 2e-4) * (2e-3 + 8e-3)
for end, steps in ((0.02, 500), (0.05, 1000)):
    tell("maglev: gap, rate, current", maglev, [9e-3, 0, i0], end, steps)
for end, steps in ((2.5, 10000), (5, 20000), (15, 60000)):
    tell("crane: way, swing, their rates, current, integral", crane, [0] * 6, end, steps)
tell("microphone: place, rate, charge, current", microphone, [-0.004905, 0, 0, 0], 0.4, 2000)
