"""Check lines `raw;built;derivative;expanded;folded;collected` against SymPy.

The raw expression is what was asked for, the others what came of it. All are compared
at rational points in 50 digits; what holds a double (sums of pi and numbers do) in 13. Prints what differs; ends with status 1 if anything did.
"""

import re
import sys

import sympy

NAMES = [sympy.Symbol(name) for name in "abcxyz"]
POINTS = [
    dict(zip(NAMES, [sympy.Rational(n, 7) for n in numbers]))
    for numbers in ([3, 5, 9, 2, 8, 11], [13, 4, 6, 10, 1, 12])
]


def read(text):
    return sympy.sympify(text.replace("math.", ""), rational=True)


def bound(text):
    return sympy.Float("1e-13" if re.search(r"\d{15}|\d\.\d{12}", text) else "1e-30")


def far(wanted, got, most):
    for point in POINTS:
        value = wanted.evalf(50, subs=point)
        if abs(value - got.evalf(50, subs=point)) > most * (1 + abs(value)):
            return True
    return False


def main():
    bad = 0
    lines = 0
    for line in open(sys.argv[1], encoding="utf-8"):
        raw, built, derivative, *rewritten = line.strip().split(";")
        wanted = read(raw)
        lines += 1
        checks = [("built", wanted, built), ("derivative", sympy.diff(wanted, "x"), derivative)]
        checks += [("rewritten", wanted, other) for other in rewritten]
        for what, value, text in checks:
            if far(value, read(text), bound(text)):
                bad += 1
                print(f"{what}: {raw} gives {text}")
    return 1 if bad or lines == 0 else 0


sys.exit(main())
