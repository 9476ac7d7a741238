#!/usr/bin/env python3
"""What grows with the number of parts, and how.

    scaling.py [-o FILE] [-t SECONDS] [-n MOST] COTREE [KIND...]

Chains and trees of rods and four-bars in a row, in joint and absolute coordinates, ladders of coils
and capacitors and of ideal diodes, of 1 to 1000 (MOST) bodies, loops or sections; each in a process of its
own, which is stopped after SECONDS (30) of the processor's time. Where SymPy is there it forms the
chains, too, as long as it takes no longer than that; its accelerations have to agree to nine digits.

Measured, in the processor's time, are: forming, from the statements to a program that has been assembled and run for a moment,
s; memory, the largest of the process beyond that of an empty one, MB; evaluation, what
each takes that a longer run has more, us; run, of SPAN of the scene's time once the program is there, s.

FILE (scaling.dat by default) gets a row a size in blocks named "KIND COORDINATES" as gnuplot finds
them; scripts/dev/scaling-pictures draws them. Printed is the same as `name value unit`. What fails or is
stopped is a line behind '#', and then the status is 1."""

import argparse
import math
import os
import re
import resource
import signal
import subprocess
import sys

from precision import chain, four_bars

SIZES = [1, 3, 10, 30, 100, 300, 1000]
SYMPY_SIZES = [1, 2, 3, 4, 6, 8]
AGREE = 1e-9  # of the largest acceleration


def start(i):
    """angle and speed of a chain's i-th hinge"""
    return 0.3 * (i * 7 % 5 - 2), 0.1 * (i * 3 % 7 - 3)


def bent_chain(n):
    """The chain of the other benchmarks, neither straight nor at rest."""
    lines = chain(n).split("\n")[:-1]
    values = [f"h{i} = {start(i)[0]!r}, h{i}' = {start(i)[1]!r}" for i in range(n)]
    return "\n".join(lines + ["init " + ", ".join(values)])


def rods(n):
    """A rod hangs from the end of that of half its number: a tree of some log2(n) rods' height."""
    lines = ["scene planar", "gravity [0, -9.81]"]
    for i in range(n):
        tail = "ground" if i == 0 else f"e{(i - 1) // 2}"
        lines += [f"body b{i} mass=1 inertia=1/12", f"arm a{i} b{i} [-1/2, 0]",
                  f"arm e{i} b{i} [1/2, 0]", f"revolute h{i} {tail} a{i}"]
    values = [f"h{i} = {start(i)[0]!r}, h{i}' = 0" for i in range(n)]
    return "\n".join(lines + ["tree joint", "init " + ", ".join(values)])


def ladder(n):
    """Coils and capacitors, 1 uH and 1 nF a section, behind a pulse."""
    lines = ["vsource E1 n0 0 exp(-((t - 1.2e-6)/240e-9)^2)", "resistor R0 n0 m0 30 ohm"]
    for k in range(1, n + 1):
        lines += [f"resistor R{k} m{k - 1} k{k} 0.1 ohm", f"inductor L{k} k{k} m{k} 1e-6",
                  f"capacitor C{k} m{k} 0 1e-9"]
    return "\n".join(lines + [f"resistor RL m{n} 0 50 ohm"])


def diodes(n):
    """Ideal ones in a ladder, each of which goes over by itself."""
    lines = ["vsource V n0 0 10*sin(2*pi*1e3*t)"]
    for k in range(1, n + 1):
        lines += [f"resistor R{k} n{k - 1} n{k} 10", f"diode D{k} n{k} m{k}",
                  f"capacitor C{k} m{k} 0 0.1 uF", f"resistor L{k} m{k} 0 1e4"]
    return "\n".join(lines)


# how to write it, in which coordinates, and SPAN, s
KINDS = {
    "chain": (bent_chain, ("joint", "absolute"), 0.2),
    "tree": (rods, ("joint", "absolute"), 0.2),
    "four_bars": (four_bars, ("joint", "absolute"), 0.2),
    "ladder": (ladder, ("network",), 2e-6),
    "diodes": (diodes, ("network",), 4e-4),
}


class Failed(Exception):
    pass


def limit(patience):
    resource.setrlimit(resource.RLIMIT_CPU, (patience, patience + 1))


class Shell:
    """A process that is asked one thing after the other; what it takes of the processor's time."""

    MARK = "271828182"

    def __init__(self, program, patience):
        self.patience = patience
        self.child = subprocess.Popen([program, "--no-init"], text=True, stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                      preexec_fn=lambda: limit(patience))
        self.ask("set digits 15")

    def spent(self):
        """seconds on a processor, as Linux tells it"""
        with open(f"/proc/{self.child.pid}/schedstat", encoding="ascii") as text:
            return 1e-9 * int(text.read().split()[0])

    def memory(self):
        """The most that it had, MB; as Linux tells it."""
        with open(f"/proc/{self.child.pid}/status", encoding="ascii") as text:
            return int(re.search(r"^VmHWM:\s+(\d+)", text.read(), re.M).group(1)) / 1024

    def ask(self, statements):
        """What it says, and what that took, s."""
        said, begun = [], self.spent()
        try:
            self.child.stdin.write(f"{statements}\nprint {self.MARK}\n")
            self.child.stdin.flush()
        except BrokenPipeError:
            pass
        for line in self.child.stdout:
            if self.MARK in line:
                return "".join(said), self.spent() - begun
            said.append(line)
        status = self.child.wait()
        if status == -signal.SIGXCPU:
            raise Failed(f"stopped after {self.patience} s")
        raise Failed(next((line.strip() for line in said if "error:" in line), f"status {status}"))

    def close(self):
        self.child.kill()
        self.child.communicate()


def best_run(shell, span, repeats):
    """The least time of some runs, s, and their evaluations."""
    statement = f"simulate {span!r} every={span!r} rtol=1e-6 atol=1e-9"
    least = min(shell.ask(statement)[1] for _ in range(repeats))
    return least, int(re.search(r"^evaluations +(\d+)", shell.ask("show run")[0], re.M).group(1))


def measure(shell, kind, coordinates, n, empty):
    """Forming, memory, evaluation, run."""
    write, _, span = KINDS[kind]
    repeats = 5 if n <= 30 else 1
    forming = shell.ask(write(n).replace("\ntree joint", ""))[1]
    if coordinates != "network":
        shell.ask(f"tree {coordinates}")  # counts operations of before and after, which nobody needs
    forming += shell.ask(f"simulate {1e-6 * span!r} every={1e-6 * span!r}")[1]
    run, few = best_run(shell, span, repeats)
    longer = 2 if kind == "diodes" else 50 if n <= 10 and kind != "ladder" else 10
    long, many = best_run(shell, longer * span, repeats)
    # both assemble; where that is nearly all, what is left is no more than noise
    if long > 1.2 * run and many > few:
        evaluation = (long - run) / (many - few)
    else:
        evaluation = long / many if kind == "diodes" else math.nan
    return forming, shell.memory() - empty, 1e6 * evaluation, run


def each_size(given, kind, coordinates, empty, file):
    """A block of the file; how many failed. What takes too long ends it: larger ones would, too."""
    failed, rows = 0, []
    for n in (n for n in SIZES if n <= given.most):
        name = f"scaling.{kind}_{n}_{coordinates}"
        shell = Shell(given.program, given.patience)
        try:
            row = measure(shell, kind, coordinates, n, empty)
        except Failed as why:
            print(f"# {name}: {re.sub('.*error: ', '', str(why))}")
            failed += 1
            if "stopped" in str(why):
                break
            continue
        finally:
            shell.close()
        rows.append((n, *row))
        for what, value, unit in zip(("forming", "memory", "evaluation", "run"), row,
                                     ("s", "MB", "us", "s")):
            lost = math.isnan(value)
            print(f"# {name}_{what}: is lost beside assembling" if lost
                  else f"{name}_{what} {value:.4g} {unit}")
        sys.stdout.flush()
    if rows:
        file.write(f"# {kind} {coordinates}\n# size forming memory evaluation run\n")
        file.writelines("%d %.4g %.4g %.4g %.4g\n" % row for row in rows)
        file.write("\n\n")
        file.flush()
    return failed


# Kane's method, as SymPy's own examples use it: accelerations of the chain, in numbers at its start
SYMPY = """
import sys, time
import sympy, sympy.physics.mechanics as me
state = [tuple(map(float, pair.split(','))) for pair in sys.argv[1:]]
n = len(state)
begun = time.process_time()
q, u = me.dynamicsymbols(f'q:{n}', real=True), me.dynamicsymbols(f'u:{n}', real=True)
N, O = me.ReferenceFrame('N'), me.Point('O')
O.set_vel(N, 0)
bodies, loads, at, angle, rate = [], [], O, 0, 0
for i in range(n):
    angle, rate = angle + q[i], rate + u[i]
    A = N.orientnew(f'A{i}', 'Axis', (angle, N.z))
    A.set_ang_vel(N, rate * N.z)
    c, e = me.Point(f'c{i}'), me.Point(f'e{i}')
    for p, reach in ((c, sympy.Rational(1, 2)), (e, 1)):
        p.set_pos(at, reach * A.x)
        p.v2pt_theory(at, N, A)
    bodies.append(me.RigidBody(f'b{i}', c, A, 1, (me.inertia(A, 0, 0, sympy.Rational(1, 12)), c)))
    loads.append((c, -sympy.Rational(981, 100) * N.y))
    at = e
kane = me.KanesMethod(N, q, u, [a.diff(me.dynamicsymbols._t) - b for a, b in zip(q, u)])
kane.kanes_equations(bodies, loads)
M, F = kane.mass_matrix, kane.forcing
f = sympy.lambdify([q, u], [*M, *F], 'math', cse=True)
took = time.process_time() - begun
values = f([a for a, _ in state], [b for _, b in state])
x = sympy.Matrix(n, n, values[:n * n]).LUsolve(sympy.Matrix(values[n * n:]))
print(took, *[float(v) for v in x])
"""


def ours_at_start(program, n, patience):
    """What forming takes, s, and the accelerations."""
    shell = Shell(program, patience)
    text = bent_chain(n).replace("\ntree joint", "")
    _, took = shell.ask(text + "\nsimulate 1e-9 every=1e-9")
    said, _ = shell.ask("\n".join(f"print h{i}'' at 0" for i in range(n)))
    shell.close()
    return took, [float(x) for x in re.findall(r"^h\d+''(?: at 0)? += +(\S+)", said, re.M)]


def beside_sympy(given):
    """Forming of chains by SymPy; how many failed, or differ."""
    failed = 0
    for n in (n for n in SYMPY_SIZES if n <= given.most):
        name = f"scaling.chain_{n}_forming"
        values = ["%r,%r" % start(i) for i in range(n)]
        done = subprocess.run([sys.executable, "-c", SYMPY, *values], capture_output=True, text=True,
                              preexec_fn=lambda: limit(given.patience), check=False)
        if "No module named 'sympy'" in done.stderr:
            print("# scaling: SymPy isn't there (Debian: python3-sympy)")
            return 0
        if done.returncode == -signal.SIGXCPU:
            print(f"# {name}: SymPy takes longer than {given.patience} s")
            return failed
        if done.returncode != 0:
            print(f"# {name}: SymPy: {(done.stderr.strip().splitlines() or ['no reason'])[-1]}")
            return failed + 1
        theirs, *right = (float(x) for x in done.stdout.split())
        ours, found = ours_at_start(given.program, n, given.patience)
        off = max((abs(a - b) for a, b in zip(found, right)), default=1) / max(map(abs, right))
        failed += not (len(found) == n and off < AGREE)
        print(f"{name}_sympy {theirs:.4g} s")
        print(f"{name}_sympy_times {theirs / ours:.3g} ours")
        print(f"{name}_sympy_differs {off:.2g} of the largest")
        sys.stdout.flush()
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-o", dest="file", default="scaling.dat")
    parser.add_argument("-t", dest="patience", type=int, default=30)
    parser.add_argument("-n", dest="most", type=int, default=SIZES[-1])
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("kinds", nargs="*", choices=[*KINDS, "sympy", []], metavar="kind")
    given = parser.parse_args()
    shell = Shell(given.program, given.patience)
    empty = shell.memory()
    shell.close()
    failed = 0
    with open(given.file, "w", encoding="utf-8") as file:
        for kind in given.kinds or [*KINDS, "sympy"]:
            if kind == "sympy":
                failed += beside_sympy(given)
                continue
            for coordinates in KINDS[kind][1]:
                failed += each_size(given, kind, coordinates, empty, file)
    sys.exit(1 if failed > 0 else 0)


if __name__ == "__main__":
    main()
