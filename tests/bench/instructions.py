#!/usr/bin/env python3
"""What an edit leaves to form, in instructions.

    instructions.py DIRECTORY

Runs bench_edit and bench_subsystems of DIRECTORY under valgrind's callgrind: the equations of a chain
of 100 links, and of a robot of 30 legs, formed for the first time and after one change. Each ratio
is a line `name value unit`. Unlike times, these don't depend on what else the machine does. Without
valgrind it prints a line behind '#'."""

import os
import re
import shutil
import subprocess
import sys


def instructions(*command):
    """that `counted` of a benchmark executes"""
    run = subprocess.run(
        ["valgrind", "--tool=callgrind", "--toggle-collect=counted",
         "--callgrind-out-file=/dev/null", *command],
        stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, check=True)
    if run.stdout.startswith("#"):
        sys.exit(run.stdout)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1))


def line(name, value, unit):
    print(f"{name} {value:.4g} {unit}", flush=True)


def main():
    if shutil.which("valgrind") is None:
        print("# instructions.py: no valgrind")
        return
    chain = os.path.join(sys.argv[1], "bench_edit")
    robot = os.path.join(sys.argv[1], "bench_subsystems")
    for space in ("planar", "spatial"):
        for tree in ("joint", "absolute"):
            for what in ("insert", "append", "delete"):
                anew = instructions(chain, space, tree, what, "anew")
                after = instructions(chain, space, tree, what)
                name = f"instructions.{space}_{tree}_100_{what}"
                line(name, after / anew, "of all")
                if what == "insert":
                    line(f"{name}_anew", anew / 1e6, "million")
        anew = instructions(robot, space, "legs", "form")
        line(f"instructions.{space}_30_legs_anew", anew / 1e6, "million")
        for what in ("remove", "add"):
            line(f"instructions.{space}_30_legs_{what}",
                 instructions(robot, space, "legs", what) / anew, "of all")


if __name__ == "__main__":
    main()
