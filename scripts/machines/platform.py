#!/usr/bin/env python3
"""Lengths and forces of the legs of platform.ct, by other means; nothing of cotree is used.

A leg is as long as the way from its foot to its ball. The legs are rods that turn about x and then
about y, so every body's place and attitude follow from the platform's in closed form. The
forces follow from virtual work: for each of six motions of the platform,

  sum F_i dl_i = sum m (a - g) . dr + H' . dw   over platform, cylinders and rods.

Rates are Taylor series in one variable, cut off after the square: in time, with the motion, for
a and H'; along each of the six motions for dl, dr and dw.

platform.py           the numbers that platform.ct expects
platform.py FILE.csv  what is there against them: the largest difference of lengths and of forces
"""

import sys
from math import cos, pi, sin


class Series:
    """a + b h + c h^2"""

    def __init__(self, a, b=0.0, c=0.0):
        self.c = (a, b, c)

    def __add__(self, other):
        return Series(*(x + y for x, y in zip(self.c, series(other).c)))

    def __sub__(self, other):
        return self + series(other) * -1.0

    def __mul__(self, other):
        a, b = self.c, series(other).c
        return Series(a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[1] * b[1] + a[2] * b[0])

    def of(self, f, f1, f2):
        """a function of it, from its value and its two derivatives at a"""
        _, b, c = self.c
        return Series(f, f1 * b, f1 * c + f2 * b * b / 2)

    def power(self, p):
        a = self.c[0]
        return self.of(a**p, p * a ** (p - 1), p * (p - 1) * a ** (p - 2))

    def rate(self):
        return Series(self.c[1], 2 * self.c[2])


def series(x):
    return x if isinstance(x, Series) else Series(x)


def sine(x):
    a = x.c[0]
    return x.of(sin(a), cos(a), -sin(a))


def cosine(x):
    a = x.c[0]
    return x.of(cos(a), -sin(a), -cos(a))


def dot(u, v):
    total = Series(0.0)
    for x, y in zip(u, v):
        total = series(x) * y + total
    return total


def columns(R):
    return list(zip(*R))


def product(A, B):
    return [[dot(row, column) for column in columns(B)] for row in A]


def turn_x(s, c):
    return [[1.0, 0.0, 0.0], [0.0, c, s * -1.0], [0.0, s, c]]


def turn_y(s, c):
    return [[c, 0.0, s], [0.0, 1.0, 0.0], [s * -1.0, 0.0, c]]


def turn_z(s, c):
    return [[c, s * -1.0, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]


def about(turn, angle):
    return turn(sine(angle), cosine(angle))


def rate_of_turn(R):
    """w from R' R^T, in the ground's axes"""
    W = product([[series(x).rate() for x in row] for row in R], columns(R))
    return [W[2][1], W[0][2], W[1][0]]


DEGREE = pi / 180
FEET = [(cos(a * DEGREE), sin(a * DEGREE), 0.0) for a in (10, 110, 130, 230, 250, 350)]
BALLS = [
    (0.6 * cos(a * DEGREE), 0.6 * sin(a * DEGREE), -0.05) for a in (50, 70, 170, 190, 290, 310)
]
TOP = (40.0, (2.0, 3.0, 4.5))
CYLINDER = (6.0, (0.25, 0.25, 0.02))
ROD = (3.0, (0.15, 0.15, 0.004))
FROM_FOOT, FROM_BALL = 0.3, 0.35
GRAVITY = 9.81


def machine(pose):
    """lengths of the legs, and mass, inertia, place and attitude of each body"""
    place = pose[:3]
    R = product(about(turn_x, pose[3]), product(about(turn_y, pose[4]), about(turn_z, pose[5])))
    lengths, bodies = [], [(*TOP, place, R)]
    for foot, ball in zip(FEET, BALLS):
        way = [place[k] + dot(R[k], ball) - foot[k] for k in range(3)]
        length = dot(way, way).power(0.5)
        u = [x * length.power(-1.0) for x in way]
        # the leg is along z after turns about x and y: u = (s2, -s1 c2, c1 c2)
        c2 = (Series(1.0) - u[0] * u[0]).power(0.5)
        over = c2.power(-1.0)
        Q = product(turn_x(u[1] * over * -1.0, u[2] * over), turn_y(u[0], c2))
        bodies.append((*CYLINDER, [u[k] * FROM_FOOT + foot[k] for k in range(3)], Q))
        bodies.append((*ROD, [u[k] * (length - FROM_BALL) + foot[k] for k in range(3)], Q))
        lengths.append(length)
    return lengths, bodies


def solve(A, b):
    """Gauss, the largest of a column first"""
    n = len(b)
    A = [[*row, x] for row, x in zip(A, b)]
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(A[i][k]))
        A[k], A[best] = A[best], A[k]
        for i in range(n):
            if i != k:
                f = A[i][k] / A[k][k]
                A[i] = [x - f * y for x, y in zip(A[i], A[k])]
    return [A[k][n] / A[k][k] for k in range(n)]


def motion(t):
    """x, y, z and the angles about x, y, z, as series in time"""
    n = Series(t / 3, 1 / 3)
    S = n - sine(n * (2 * pi)) * (1 / (2 * pi))
    wave = sine(n * pi)
    W = wave * wave * wave
    return [W * 0.15, S * -0.1, S * 0.2 + 0.9, W * 0.25, S * -0.2, S * 0.3]


def legs(t):
    pose = motion(t)
    lengths, bodies = machine(pose)
    loads = []
    for mass, inertia, place, R in bodies:
        force = [mass * 2 * x.c[2] for x in place]
        force[2] += mass * GRAVITY
        w = rate_of_turn(R)
        inside = [dot(axis, w) * I for axis, I in zip(columns(R), inertia)]
        loads.append((force, [dot(row, inside).c[1] for row in R]))
    A, b = [], []
    for k in range(6):
        moved = [Series(x.c[0], 1.0 if i == k else 0.0) for i, x in enumerate(pose)]
        along, displaced = machine(moved)
        A.append([x.c[1] for x in along])
        b.append(
            sum(
                sum(f * x.c[1] for f, x in zip(force, place))
                + sum(m * w.c[0] for m, w in zip(moment, rate_of_turn(R)))
                for (force, moment), (_, _, place, R) in zip(loads, displaced)
            )
        )
    return [x.c[0] for x in lengths], solve(A, b)


if len(sys.argv) > 1:
    off = [0.0, 0.0]
    with open(sys.argv[1], encoding="utf-8") as file:
        next(file)
        for row in (list(map(float, line.split(","))) for line in file):
            for kind, right in enumerate(legs(row[0])):
                found = row[1 + 6 * kind : 7 + 6 * kind]
                off[kind] = max(off[kind], *(abs(x - y) for x, y in zip(found, right)))
    print(f"lengths to {off[0]:.2g} m, forces to {off[1]:.2g} N")
    sys.exit(off[0] > 1e-9 or off[1] > 1e-7)
for t in (1, 2.2):
    for name, values in zip(("leg{}.s", "D{}.effort"), legs(t)):
        for i, x in enumerate(values, 1):
            print(f"expect {name.format(i)} ~ {x:.12g} within 1e-8 at {t}")
