#!/usr/bin/env python3
"""Work against precision: what each method costs to be so right.

    precision.py [-o FILE] [-t SECONDS] COTREE TOP [CASE...]

Runs every case (all when none is named) with every method at tolerances of 1e-3 to 1e-12, those of
fixed steps with steps that halve, three times each in a shell of its own, which is stopped after
SECONDS (30) of the processor's time. TOP is the folder of the sources.

The error of a run is the largest difference of the items, at all times that are known, each over
the largest value of its column. What is right comes from elsewhere (tests/data/README); where a
case has no such numbers, from the same scene in other coordinates by another method at the
tightest tolerance. A case can't tell errors below its floor: what its numbers are good for, or how
far those two stand apart.

FILE (precision.dat by default) gets a row a run: tolerance or step, error, ms, evaluations, steps,
in blocks named "CASE METHOD" as gnuplot finds them; scripts/dev/precision-pictures draws them.
Printed, as `name value unit`, is the least work that reaches an error of 1e-3, 1e-6 and 1e-9. A run that fails or is stopped is a line behind '#', and then the status is 1."""

import argparse
import csv
import math
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile

METHODS = ["auto", "dop853", "radau", "bdf", "adams", "ida"]
FIXED = ["rk4", "symplectic"]  # of fixed steps
TOLERANCES = [10.0**-k for k in range(3, 13)]
HALVINGS = 8  # of a fixed step, from a hundredth of the rows' distance
GOALS = [1e-3, 1e-6, 1e-9]
REPEATS = 3  # of a run; the least time counts


def chain(n):
    """Rods of 1 m hanging one from the other, released level."""
    lines = ["scene planar", "gravity [0, -9.81]"]
    for i in range(n):
        tail = "ground" if i == 0 else f"e{i - 1}"
        lines += [
            f"body b{i} mass=1 inertia=1/12",
            f"arm a{i} b{i} [-1/2, 0]",
            f"arm e{i} b{i} [1/2, 0]",
            f"revolute h{i} {tail} a{i}",
        ]
    lines += ["tree joint", "init " + ", ".join(f"h{i} = 0, h{i}' = 0" for i in range(n))]
    return "\n".join(lines)


def four_bars(n):
    """The N-four-bar of the multibody benchmark: cranks of 1 m, pushed at 1 m/s."""
    lines = ["scene planar", "gravity [0, -9.81]"]
    for i in range(n + 1):
        lines += [
            f"body c{i} mass=1 inertia=1/12",
            f"arm g{i} ground [{i}, 0]",
            f"arm cl{i} c{i} [0, -1/2]",
            f"arm ch{i} c{i} [0, 1/2]",
            f"revolute a{i} g{i} cl{i}",
        ]
    for i in range(n):
        lines += [
            f"body k{i} mass=1 inertia=1/12",
            f"arm kl{i} k{i} [-1/2, 0]",
            f"arm kr{i} k{i} [1/2, 0]",
            f"revolute l{i} ch{i} kl{i}",
            f"revolute r{i} kr{i} ch{i + 1}",
        ]
    lines += ["tree joint", "init a0 = 0, a0' = -1"]
    lines += [f"guess a{i + 1} = 0, l{i} = 0" for i in range(n)]
    return "\n".join(lines)


BUSHING = """scene planar
gravity [0, -9.81]
body b0 mass=1 inertia=1/12
arm a0 b0 [-1/2, 0]
arm e0 b0 [1/2, 0]
revolute h0 ground a0
body b1 mass=1 inertia=1/12
arm a1 b1 [-1/2, 0]
planarjoint p e0 a1
spring kx p.s1 k=1e6
spring ky p.s2 k=1e6
damper dx p.s1 d=2e4
damper dy p.s2 d=2e4
tree joint
init h0 = 0, h0' = 0, p.s1 = 0, p.s2 = 0, p.theta = 0, p.s1' = 0, p.s2' = 0, p.theta' = 0"""

RECTIFIER = """vsource V s0 0 100*sin(2*pi*1e3*t)
resistor Rs s0 s 10
diode D s b Is=1e-12
capacitor C b 0 1 uF
resistor RL b 0 10000
init C.v = 0"""


def parallel_cranks(n, duration, rows):
    """x, y, vx, vy of the first crank's tip of four_bars(n), all of whose cranks move alike: one
    freedom, ((n + 1)/3 + n) a'' = g ((n + 1)/2 + n) sin(a), by small steps of order 4."""
    factor = 9.81 * ((n + 1) / 2 + n) / ((n + 1) / 3 + n)
    steps = 4000  # of each row: errors are below those of rounding
    h = duration / rows / steps
    a, u, table = 0.0, 1.0, [[0.0, 0.0, 1.0, 1.0, 0.0]]
    for row in range(1, rows + 1):
        for _ in range(steps):
            k1, l1 = u, factor * math.sin(a)
            k2, l2 = u + h / 2 * l1, factor * math.sin(a + h / 2 * k1)
            k3, l3 = u + h / 2 * l2, factor * math.sin(a + h / 2 * k2)
            k4, l4 = u + h * l3, factor * math.sin(a + h * k3)
            a += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            u += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
        t = duration * row / rows
        table.append([t, math.sin(a), math.cos(a), u * math.cos(a), -u * math.sin(a)])
    return table


class Case:
    """A scene, what is compared, and where right numbers come from.

    scene: a script below TOP, or the statements; before: statements ahead of the run; data: a
    table of tests/data with the columns t and the items, or what computes one, right to `floor`; else
    `other`: what replaces `before`, and the method, of the run that is compared with. states: what
    it integrates, where that isn't coordinates and speeds alone."""

    def __init__(self, scene, items, duration, rows, before="", data=None, floor=1e-13, other=None,
                 states=""):
        self.scene, self.items, self.duration, self.rows = scene, items, duration, rows
        self.before, self.data, self.floor, self.other = before, data, floor, other
        self.states = states


ABSOLUTE = "tree absolute"
CRANK = "scripts/paper/1_slider_crank_"
SERIAL = "beta12 beta13 beta14 beta12' beta13' beta14'"
ARM = "theta1 theta2 theta1' theta2' M7.i M8.i"
BARS = "ch0.x ch0.y ch0.vx ch0.vy"
MICROPHONE = "E4.v s s' C2.q C2.i"
SPIN = "b.Wx b.Wy b.Wz b.q0 b.q1 b.q2 b.q3"
TOP = "top.x top.y top.z top.q0 top.q1 top.q2 top.q3 top.Wx top.Wy top.Wz"
ANDREWS = "beta Theta gamma Phi delta Omega epsilon"

CASES = {
    "slider_crank": Case(
        CRANK + "one_tree.ct", "h8 h10 s11 h8' h10' s11'", 2, 50, data="slider_crank", floor=1e-11
    ),
    "slider_crank_two_trees": Case(
        CRANK + "two_trees.ct", "h8 h10 s11 h8' h10' s11'", 2, 50, data="slider_crank", floor=1e-11
    ),
    "slider_crank_absolute": Case(
        CRANK + "one_tree.ct", "h8 h10 s11 h8' h10' s11'", 2, 50,
        before=ABSOLUTE, data="slider_crank", floor=1e-11
    ),
    "serial_joint": Case(
        "scripts/paper/2_serial_joint.ct", SERIAL, 2, 50, data="serial_motion", floor=1e-11
    ),
    "serial_indirect": Case(
        "scripts/paper/2_serial_indirect.ct", SERIAL, 2, 50, data="serial_motion", floor=1e-11
    ),
    "serial_absolute": Case(
        "scripts/paper/2_serial_joint.ct", SERIAL, 2, 50,
        before=ABSOLUTE, data="serial_motion", floor=1e-11
    ),
    "motor_arm": Case(
        "scripts/paper/3_motor_arm_forward.ct", ARM, 2, 100, data="motor_arm_forward", floor=1e-11,
        states=ARM
    ),
    "motor_arm_absolute": Case(
        "scripts/paper/3_motor_arm_forward.ct", ARM, 2, 100,
        before=ABSOLUTE, data="motor_arm_forward", floor=1e-11
    ),
    "microphone": Case(
        "scripts/paper/5_microphone_tree.ct", MICROPHONE, 2, 100, data="microphone", floor=1e-11,
        states="s s' C2.v C2.i"
    ),
    "pendulum_joint": Case(
        "scripts/reference/ref_A01_pendulum_joint.ct", "p1.x p1.y p1.vx p1.vy", 10, 50,
        data="pendulum_10s"
    ),
    "pendulum_absolute": Case(
        "scripts/reference/ref_A01_pendulum_absolute.ct", "p1.x p1.y p1.vx p1.vy", 10, 50,
        data="pendulum_10s"
    ),
    "four_bar_joint": Case(
        "scripts/reference/ref_A02_four_bar_joint.ct", BARS, 10, 50, data="four_bar"
    ),
    "four_bar_absolute": Case(
        "scripts/reference/ref_A02_four_bar_absolute.ct", BARS, 10, 50, data="four_bar"
    ),
    "andrews_joint": Case(
        "scripts/reference/ref_A03_andrews.ct", ANDREWS, 0.05, 20, data="andrews"
    ),
    "andrews_absolute": Case(
        "scripts/reference/ref_A03_andrews.ct", ANDREWS, 0.05, 20, before=ABSOLUTE, data="andrews"
    ),
    "free_body": Case("scripts/reference/ref_free_body.ct", SPIN, 20, 50, data="free_body"),
    "heavy_top_joint": Case("scripts/reference/ref_heavy_top.ct", TOP, 2, 50, data="heavy_top"),
    "heavy_top_absolute": Case(
        "scripts/reference/ref_heavy_top.ct", TOP, 2, 50, before=ABSOLUTE, data="heavy_top"
    ),
    "double_pendulum": Case(
        chain(2), "h0 h1 h0' h1'", 10, 50, other=(ABSOLUTE, "radau")
    ),
    "chain_10": Case(
        chain(10), "e9.x e9.y e9.vx e9.vy", 2, 50, other=(ABSOLUTE, "radau")
    ),
    "four_bars_10_joint": Case(
        four_bars(10), BARS, 10, 50, data=lambda *grid: parallel_cranks(10, *grid), floor=1e-11
    ),
    "four_bars_10_absolute": Case(
        four_bars(10), BARS, 10, 50, before=ABSOLUTE,
        data=lambda *grid: parallel_cranks(10, *grid), floor=1e-11
    ),
    "bushing": Case(
        BUSHING, "e0.x e0.y b1.x b1.y", 2, 50, other=(ABSOLUTE, "dop853")
    ),
    "rectifier": Case(RECTIFIER, "C.v D.i", 0.005, 500, other=("", "bdf"), states="C.v"),
}


class Failed(Exception):
    pass


class Shell:
    """Runs of one program, each in a process of its own."""

    def __init__(self, program, top, patience):
        self.program, self.top, self.patience = os.path.abspath(program), top, patience

    def scene(self, case):
        """The statements that build it, ahead of its first run."""
        if "\n" in case.scene:
            return case.scene
        with open(os.path.join(self.top, case.scene), encoding="utf-8") as script:
            lines = script.read().split("\n")
        first = next(i for i, line in enumerate(lines) if line.startswith("simulate"))
        return "\n".join(line for line in lines[:first] if not re.match(r"show|count", line))

    def run(self, case, before, method, accuracy):
        """Rows of the items, ms, evaluations, steps."""
        every = case.duration / case.rows
        if method in FIXED:
            how = f"step={accuracy!r}"
        else:
            how = f"rtol={accuracy:.0e} atol={accuracy:.0e}"
        statement = f"time simulate {case.duration!r} every={every!r} method={method} {how}\n"
        with tempfile.TemporaryDirectory() as folder:
            table = os.path.join(folder, "rows.csv")
            text = f"{self.scene(case)}\n{before}\n" + statement * REPEATS
            text += f'show run\nexport csv {case.items} > "{table}"\n'
            limit = (self.patience, self.patience + 1)
            done = subprocess.run(
                [self.program, "--no-init"], input=text, capture_output=True, text=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit), check=False
            )
            if done.returncode == -signal.SIGXCPU:
                raise Failed(f"stopped after {self.patience} s")
            if done.returncode != 0:
                why = re.search(r"error: .*", done.stderr)
                raise Failed(why.group() if why else f"status {done.returncode}")
            with open(table, encoding="utf-8") as file:
                rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
        least = min(float(x) for x in re.findall(r"time: ([0-9.e+-]+) s", done.stdout + done.stderr))
        evaluations = int(re.search(r"^evaluations +(\d+)", done.stdout, re.M).group(1))
        steps = int(re.search(r"^steps +(\d+)", done.stdout, re.M).group(1))
        return rows, 1e3 * least, evaluations, steps

    def truth(self, case):
        """Rows of right numbers, and to what they are right."""
        if callable(case.data):
            return case.data(case.duration, case.rows), case.floor
        if case.data is not None:
            path = os.path.join(self.top, "tests/data", case.data + ".csv")
            with open(path, encoding="utf-8") as file:
                width = len(case.items.split()) + 1
                return [[float(x) for x in row[:width]] for row in list(csv.reader(file))[1:]], case.floor
        here = self.run(case, case.before, "dop853" if case.other[1] != "dop853" else "radau", 1e-12)[0]
        there = self.run(case, case.other[0], case.other[1], 1e-12)[0]
        return here, max(case.floor, difference(here, there))


def difference(rows, right):
    """Largest difference at times that both have, over each column's largest value."""
    at = {round(row[0], 9): row for row in rows}
    met = [(at[round(row[0], 9)], row) for row in right if round(row[0], 9) in at]
    if len(met) < 2:
        raise Failed("no times in common")
    worst = 0.0
    for k in range(1, len(right[0])):
        scale = max(abs(row[k]) for row in right)
        if scale > 0:
            worst = max([worst] + [abs(a[k] - b[k]) / scale for a, b in met])
    return worst


def measure(shell, file, name, case):
    """All methods of a case; how many runs failed."""
    failed = 0
    try:
        right, floor = shell.truth(case)
    except Failed as why:
        print(f"# precision.{name}: what is right isn't known: {why}")
        return 1
    print(f"# precision.{name}: tells errors down to {floor:.1e}")
    for method in METHODS + FIXED:
        rows = []
        finest = case.duration / case.rows / 2
        ladder = [finest / 2**k for k in range(HALVINGS)] if method in FIXED else TOLERANCES
        for accuracy in ladder:
            try:
                got, ms, evaluations, steps = shell.run(case, case.before, method, accuracy)
                error = max(difference(got, right), floor)
                rows.append((accuracy, error, ms, evaluations, steps))
            except Failed as why:
                print(f"# precision.{name}_{method} at {accuracy:.1e}: {why}")
                failed += 1
        if rows:  # gnuplot counts no block without a row
            file.write(f"# {name} {method}\n# tolerance error ms evaluations steps\n")
            file.writelines("%.3e %.3e %.4g %d %d\n" % row for row in rows)
            file.write("\n\n")
        for goal in GOALS:
            enough = [row for row in rows if row[1] <= goal]
            if goal < floor:
                continue
            if not enough:
                print(f"# precision.{name}_{method}_{goal:.0e}: not reached")
                continue
            print(f"precision.{name}_{method}_{goal:.0e} {min(r[2] for r in enough):.4g} ms")
            print(f"precision.{name}_{method}_{goal:.0e}_rhs {min(r[3] for r in enough)} evaluations")
        sys.stdout.flush()
        file.flush()
    return failed


def arguments(parser, patience):
    """What the command line asks for, and the shell to do it with."""
    parser.add_argument("-t", dest="patience", type=int, default=patience)
    parser.add_argument("program")
    parser.add_argument("top")
    parser.add_argument("cases", nargs="*", metavar="case")
    given = parser.parse_args()
    unknown = [name for name in given.cases if name not in CASES]
    if unknown:
        parser.error(f"no case is called {unknown[0]}; there are {', '.join(CASES)}")
    return given, Shell(given.program, given.top, given.patience)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-o", dest="file", default="precision.dat")
    given, shell = arguments(parser, 30)
    failed = 0
    with open(given.file, "w", encoding="utf-8") as file:
        for name in given.cases or CASES:
            failed += measure(shell, file, name, CASES[name])
    sys.exit(1 if failed > 0 else 0)


if __name__ == "__main__":
    main()
