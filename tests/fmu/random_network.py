#!/usr/bin/env python3
"""random_network.py SEED: a random network of ideal diodes and switches, as statements

Sources have an inner resistance or none, so that some networks need an impulse; these `simulate`
refuses, and then there is nothing to compare.
"""
import random
import sys

rnd = random.Random(int(sys.argv[1]))
nodes = rnd.randint(3, 6)
names = ["0"] + ["n%d" % i for i in range(1, nodes + 1)]
lines = []
count = {}


def number(low, high):
    return "%.3g" % (low * (high / low) ** rnd.random())


def part(kind, a, b, rest):
    count[kind] = count.get(kind, 0) + 1
    lines.append("%s %s%d %s %s %s" % (kind, kind[0].upper() + kind[1], count[kind], a, b, rest))


def source(a, b):
    law = rnd.choice(["%s*sin(%s*t + %s)", "%s*sin(%s*t + %s)", "%s*cos(%s*t) + %s"]) % (
        number(5, 20), number(40, 400), number(0.1, 3))
    if rnd.random() < 0.8:
        part("vsource", "s%d" % len(lines), b, law)
        part("resistor", "s%d" % (len(lines) - 1), a, number(0.2, 5))
    else:
        part("vsource", a, b, law)


def element(a, b):
    kind = rnd.choice(["diode"] * 5 + ["resistor"] * 3 + ["capacitor"] * 3 + ["inductor"] * 2
                      + ["switch"])
    if kind == "diode":
        if rnd.random() < 0.5:
            a, b = b, a
        part(kind, a, b, rnd.choice(["", "", "", "Vf=0.7", "Ron=0.05"]))
    elif kind == "resistor":
        part(kind, a, b, number(1, 1000))
    elif kind == "capacitor":
        part(kind, a, b, number(1e-5, 1e-3))
    elif kind == "inductor":
        part(kind, a, b, number(1e-3, 1e-1))
        if rnd.random() < 0.7:
            part("resistor", a, b, number(10, 1000))
    else:
        part(kind, a, b, "when=sin(%s*t) > %.2f" % (number(60, 300), rnd.uniform(-0.7, 0.7)))


source(names[1], "0")
if rnd.random() < 0.3:
    source(rnd.choice(names[2:]), "0")
for i in range(2, nodes + 1):
    element(rnd.choice(names[:i]), names[i])
    if rnd.random() < 0.7:
        part("resistor", names[i], rnd.choice(names[:i]), number(5, 500))
for _ in range(rnd.randint(2, 5)):
    a, b = rnd.sample(names, 2)
    element(a, b)
print("\n".join(lines))
