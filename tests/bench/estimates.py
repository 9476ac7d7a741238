#!/usr/bin/env python3
"""How right the error is that check=on estimates.

    estimates.py [-t SECONDS] COTREE TOP [CASE...]

Runs the cases of precision.py with every method at four tolerances and check=on, and compares what
each says of its error with the largest difference of all coordinates and speeds from a run by another
method at the tightest tolerance. Two such runs tell how small an error can be told; what lies below
isn't counted.

A row a run: CASE METHOD TOLERANCE, the estimate over the error. The last rows count how many were
right within ten, too low, too high, and not resolved; the status is 1 where one was too low or more
than one in twenty was not resolved."""

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile

from precision import CASES, METHODS, Failed, arguments

TOLERANCES = [1e-4, 1e-6, 1e-8, 1e-10]
RIGHT = 10.0  # times too large or too small
FINEST = 1e-12


def run(shell, case, method, tolerance, check):
    """All coordinates and speeds at the rows; what the run says of its error, None: not resolved."""
    every = case.duration / case.rows
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "rows.csv")
        text = (
            f"{shell.scene(case)}\n{case.before}\n"
            f"simulate {case.duration!r} every={every!r} method={method} rtol={tolerance:.0e} "
            f"atol={tolerance:.0e}{' check=on' if check else ''}\n"
            f'show run\nexport csv {case.states} > "{table}"\n'
        )
        try:
            done = subprocess.run(
                [shell.program, "--no-init"], input=text, capture_output=True, text=True,
                cwd=os.path.dirname(os.path.join(shell.top, case.scene)) if "\n" not in case.scene
                else None, timeout=shell.patience, check=False
            )
        except subprocess.TimeoutExpired:
            raise Failed(f"stopped after {shell.patience} s") from None
        if done.returncode != 0:
            why = re.search(r"error: .*", done.stderr)
            raise Failed(why.group() if why else f"status {done.returncode}")
        with open(table, encoding="utf-8") as file:
            rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
    said = re.search(r"^global error +(\S+)", done.stdout, re.M)
    number = said.group(1) if said else "not"
    return rows, None if number == "not" else float(number)


def distance(rows, right):
    """Largest difference at times that both have, in rad, m, A, ... alike, as check=on has it."""
    at = {round(row[0], 9): row for row in right}
    return max(
        abs(a - b)
        for row in rows if round(row[0], 9) in at
        for a, b in zip(row[1:], at[round(row[0], 9)][1:])
    )


def measure(shell, name, case, counts):
    try:
        right = run(shell, case, "dop853", FINEST, False)[0]
        floor = distance(run(shell, case, "radau", FINEST, False)[0], right)
    except Failed as why:
        print(f"# estimates.{name}: what is right isn't known: {why}")
        counts["failed"] += 1
        return
    print(f"# estimates.{name}: tells errors down to {10 * floor:.1e}")
    for method in METHODS:
        for tolerance in TOLERANCES:
            row = f"estimates.{name}_{method}_{tolerance:.0e}"
            try:
                rows, estimate = run(shell, case, method, tolerance, True)
            except Failed as why:
                print(f"# {row}: {why}")
                counts["failed"] += 1
                continue
            error = distance(rows, right)
            if error <= 10 * floor:
                continue
            if estimate is None:
                counts["not resolved"] += 1
                print(f"# {row}: not resolved, and off by {error:.1e}")
                continue
            ratio = estimate / error
            counts["too low" if ratio < 1 / RIGHT else "too high" if ratio > RIGHT else "right"] += 1
            print(f"{row} {ratio:.3g} times")
        sys.stdout.flush()


def main():
    given, shell = arguments(argparse.ArgumentParser(description=__doc__.split("\n", 1)[0]), 60)
    counts = {"right": 0, "too low": 0, "too high": 0, "not resolved": 0, "failed": 0}
    for name in given.cases or CASES:
        measure(shell, name, CASES[name], counts)
    for what, count in counts.items():
        print(f"estimates.{what.replace(' ', '_')} {count} runs")
    told = sum(counts.values()) - counts["failed"]
    sys.exit(1 if counts["too low"] > 0 or counts["not resolved"] > told / 20 else 0)


if __name__ == "__main__":
    main()
