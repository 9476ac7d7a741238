"""The microphone's printed equations minus the paper's, which must be nothing at all.

Reads what `show equations as matlab` printed, with the capacitor in the cotree and E4 = V0 (1 -
exp(-t/T)) + V1 sin(w t). All numbers are symbols there, so that nothing is rounded.
"""

import re
import sys

import sympy

NAMES = "t eA s0 m d k g R L V0 T V1 w s s_d s_dd C2_i C2_i_d C2_i_dd"
SYMBOLS = {name: sympy.Symbol(name) for name in NAMES.split()}


def paper():
    t, eA, s0, m, d, k, g, R, L, V0, T, V1, w, s, s1, s2, i, i1, i2 = SYMBOLS.values()
    C = eA / (s0 - s)
    E = V0 * (1 - sympy.exp(-t / T)) + V1 * sympy.sin(w * t)
    v = E - R * i - L * i1
    v1 = sympy.diff(E, t) - R * i1 - L * i2
    return [
        m * s2 + d * s1 + k * s + m * g - sympy.diff(C, s) * v**2 / 2,
        sympy.diff(C, s) * s1 * v + C * v1 - i,
    ]


def printed(text):
    rows = re.findall(r"^residual\(\d+\) = (.*);$", text, re.M)
    return [sympy.sympify(row.replace("^", "**"), SYMBOLS, rational=True) for row in rows]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = printed(file.read())
    if len(rows) != 2:
        print(f"{len(rows)} equations are printed, wanted 2")
        return 1
    for row, wanted in zip(rows, paper()):
        if sympy.simplify(row - wanted) != 0 and sympy.simplify(row + wanted) != 0:
            print(f"{row} is not {wanted}")
            return 1
    return 0


sys.exit(main())
