#!/usr/bin/env python3
"""Whole runs by MuJoCo and Simbody, beside ours at the same error.

    races.py FOLDER COTREE TOP [RACE...]

Builds the drivers beside this file in FOLDER, where the libraries are there. A race is a scene, a span, and
an error that counts as right: of the angles at the end where rods hang one from the other (tests/bench/chain_truth.c
knows them), of the first crank's tip at each row of four-bars, which all swing alike (precision.py).
Each program tries its tolerances or steps from coarse to fine; what counts is the least time of those from
which on all finer ones are right. MuJoCo's is its Runge-Kutta method, with loops as stiff as steps allow;
Simbody's are three methods.

Printed, as `name value unit`, are the processor's ms and how many times ours the others take. Ours
is the run alone; where forming counts, the whole process. What is missing or not reached is a line
behind '#'; where that is ours, the status is 1."""

import math
import os
import resource
import subprocess
import sys
import tempfile

from peers import build, chain as rods, drivers, mjcf, tree_text, words
from precision import Case, Failed, Shell, chain, four_bars, parallel_cranks

TOLERANCES = [10.0 ** (-k / 2) for k in range(6, 29)]
PATIENCE = 30  # s of the processor's time, of a run
LEVEL = (0, -9.81, 0)


def four_bar_mjcf(n):
    """Cranks and couplers as trees, each coupler's end held at the next crank."""
    rod = '<inertial pos="{}" mass="1" diaginertia="0.01 {} {}"/>'
    text = [f'<mujoco><option gravity="{words(LEVEL)}"><flag contact="disable" refsafe="disable"/>'
            "</option><worldbody>"]
    for i in range(n + 1):
        text.append(f'<body name="c{i}" pos="{i} 0 0"><joint type="hinge" axis="0 0 1"/>'
                    '<inertial pos="0 0.5 0" mass="1" diaginertia="0.0833333333333333 0.01 0.0833333333333333"/>')
        if i < n:
            text.append(f'<body name="k{i}" pos="0 1 0"><joint type="hinge" axis="0 0 1"/>'
                        + rod.format("0.5 0 0", 1 / 12, 1 / 12) + "</body>")
        text.append("</body>")
    text.append("</worldbody><equality>")
    for i in range(n):
        text.append(f'<connect body1="k{i}" body2="c{i + 1}" anchor="1 0 0" solimp="0.9999 0.9999 0.001 0.5 2"/>')
    return "\n".join(text) + "</equality></mujoco>\n"


def summed(angles):
    """of rods against the ground, from those of hinges"""
    total, out = 0.0, []
    for angle in angles:
        total += angle
        out.append(total)
    return out


class Chain:
    """Rods hang one from the other; right is what the angles at the end are."""

    def __init__(self, n, seconds, goal, steps, forming=False):
        self.n, self.seconds, self.goal, self.truth_steps, self.forming = n, seconds, goal, steps, forming
        self.rows, self.speeds, self.coordinates = 1, [], ["joint"]
        self.items = " ".join(f"h{i}" for i in range(n))

    def truth(self, truth_program):
        done = subprocess.run([truth_program, str(self.n), str(self.seconds), str(self.truth_steps)],
                              capture_output=True, text=True, check=True)
        *angles, known = done.stdout.strip().split("\n")
        if float(known.split()[1]) > self.goal / 10:
            raise Failed(f"what is right is known to {known.split()[1]} alone")
        return [float(x) for x in angles]

    def error(self, rows, right):
        return max(abs(a - b) for a, b in zip(summed(rows[-1]), right))

    def statements(self):
        return chain(self.n)

    def mjcf(self):
        return mjcf(rods(self.n), LEVEL)

    def tree(self):
        return tree_text(rods(self.n), LEVEL)


class FourBars:
    """Right is where the first crank's tip is at each row."""

    def __init__(self, n):
        self.n, self.seconds, self.rows, self.goal, self.forming = n, 10, 400, 1e-3, False
        self.speeds = [speed for i in range(n) for speed in (-1, 1)] + [-1]
        self.coordinates = ["joint", "absolute"]
        self.items = "ch0.x ch0.y"

    def truth(self, _):
        return parallel_cranks(self.n, self.seconds, self.rows)

    def error(self, rows, right):
        if len(rows) == self.rows:  # of hinges, from the first row on
            rows = [(-math.sin(row[0]), math.cos(row[0])) for row in rows]
            right = right[1:]
        return max(math.hypot(row[0] - at[1], row[1] - at[2]) for row, at in zip(rows, right))

    def statements(self):
        return four_bars(self.n)

    def mjcf(self):
        return four_bar_mjcf(self.n)


RACES = {
    "chain_2": Chain(2, 10, 1.6e-6, 400),
    "chain_10": Chain(10, 10, 2e-4, 4000),
    "chain_1000": Chain(1000, 1, 1e-8, 60, forming=True),
    **{f"four_bars_{n}": FourBars(n) for n in (1, 2, 10, 40)},
}


def called(command, text=None):
    """what a command prints; Failed where it does"""
    def bound():
        resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))

    done = subprocess.run(command, input=text, capture_output=True, text=True, preexec_fn=bound, check=False)
    if done.returncode < 0:
        raise Failed(f"stopped after {PATIENCE} s")
    if done.returncode != 0:
        raise Failed(" ".join((done.stdout + done.stderr).replace("#", " ").split())[:200])
    return done.stdout


def rows_and_time(text):
    *rows, taken = text.strip().split("\n")
    return [[float(x) for x in row.split()] for row in rows], float(taken.split()[2])


def by_mujoco(program, race):
    """(error, ms) of runs of ever more steps a row"""
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(race.mjcf())
        file.flush()
        steps, taken = max(1, round(race.seconds / race.rows / 0.02)), 0.0
        while taken < 4000:  # then each step that is finer takes longer than anyone's
            out = called([program, file.name, str(race.seconds), str(race.rows), str(steps),
                          *map(str, race.speeds)])
            rows, taken = rows_and_time(out)
            yield rows, taken
            steps = max(steps + 1, round(steps * 1.3))


def by_simbody(program, race, method):
    for accuracy in TOLERANCES:
        rows, taken = rows_and_time(called([program, method, str(race.seconds), repr(accuracy)], race.tree()))
        yield rows, taken
        if taken > 8000:
            return


def whole_process(shell, race, before, tolerance):
    """the last row of the items, and ms with all that a process does"""
    with tempfile.TemporaryDirectory() as folder:
        script, table = os.path.join(folder, "race.ct"), os.path.join(folder, "rows.csv")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f"{race.statements()}\n{before}\nsimulate {race.seconds} every={race.seconds / race.rows!r} "
                       f'rtol={tolerance!r} atol={tolerance!r}\nexport csv {race.items} > "{table}"\n')
        begin = resource.getrusage(resource.RUSAGE_CHILDREN)
        called([shell.program, "-q", script])
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(table, encoding="utf-8") as file:
            rows = [[float(x) for x in line.split(",")[1:]] for line in file.read().split()[1:]]
    return rows, 1e3 * (end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime)


def by_us(shell, race, coordinates):
    case = Case(race.statements(), race.items, race.seconds, race.rows)
    for tolerance in TOLERANCES:
        if race.forming:
            yield whole_process(shell, race, f"tree {coordinates}", tolerance)
        else:
            rows, taken = shell.run(case, f"tree {coordinates}", "auto", tolerance)[:2]
            yield [row[1:] for row in rows], taken


def least(race, right, runs):
    """ms of the cheapest run from which on all are right, and by how much that one errs"""
    good = []
    try:
        for rows, taken in runs:
            error = race.error(rows, right)
            if error <= race.goal:
                good.append((taken, error))
            else:
                good = []
            if len(good) > 2 and good[-1][0] > 2 * good[0][0]:
                break  # finer ones take longer still
    except Failed:
        if not good:
            raise
    if not good:
        raise Failed("not so right by any")
    return min(good)


def run_race(name, peers, truth_program, shell):
    race = RACES[name]
    try:
        right = race.truth(truth_program)
    except (Failed, TypeError, subprocess.CalledProcessError) as why:
        print(f"# races.{name}: what is right isn't known: {why}")
        return False
    ours, reached = None, True
    for coordinates in race.coordinates:
        label = f"races.{name}_{coordinates}"
        try:
            taken, error = least(race, right, by_us(shell, race, coordinates))
        except Failed as why:
            print(f"# {label}: {why}")
            reached = False
            continue
        print(f"{label} {taken:.4g} ms")
        print(f"{label}_error {error:.2g} of {race.goal:g}")
        if ours is None:
            ours = taken
        else:
            print(f"{label}_times {taken / ours:.3g} joint")
    runs = {}
    if peers["mujoco"] is not None:
        runs["mujoco"] = lambda: by_mujoco(peers["mujoco"], race)
    if peers["simbody"] is not None and isinstance(race, Chain) and race.n != 10:  # that takes minutes
        for method in ("merson", "fehlberg", "adams"):
            runs[f"simbody_{method}"] = lambda method=method: by_simbody(peers["simbody"], race, method)
    for peer, made in runs.items():
        try:
            taken, error = least(race, right, made())
        except Failed as why:
            print(f"# races.{name}: {peer}: {why}")
            continue
        print(f"races.{name}_{peer} {taken:.4g} ms")
        print(f"races.{name}_{peer}_error {error:.2g} of {race.goal:g}")
        if ours is not None:
            print(f"races.{name}_{peer}_times {taken / ours:.3g} ours")
    sys.stdout.flush()
    return reached


def main():
    if len(sys.argv) < 4 or not set(sys.argv[4:]) <= set(RACES):
        sys.exit(__doc__)
    folder, program, top = sys.argv[1:4]
    peers = drivers(folder)
    here = os.path.dirname(os.path.abspath(__file__))
    truth_program = build("chain_truth", ["cc", "-O2", os.path.join(here, "chain_truth.c"), "-lm"], folder)
    shell = Shell(program, top, PATIENCE)
    reached = [run_race(name, peers, truth_program, shell) for name in sys.argv[4:] or RACES]
    sys.exit(0 if all(reached) else 1)


if __name__ == "__main__":
    main()
