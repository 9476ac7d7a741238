#!/usr/bin/env python3
"""A robot and chains by other programs, beside ours in the same run.

    peers.py BENCH_DYNAMICS FOLDER

Builds the drivers beside this file in FOLDER, where the libraries of MuJoCo and Simbody are there,
and runs each in turn with BENCH_DYNAMICS, our bench. Prints `name value unit`: ns of an evaluation,
and how many times ours the others take. Accelerations and torques have to agree to eight digits. A library that
is missing, or can't load a model, is a line behind '#'."""

import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))

# parent, axis, joint in the parent's frame and in its own, both in centres of mass; mass, moments
ROBOT = [
    (-1, (0, 0, 1), (0, 0, 0.089159), (0, 0, 0), 3.7, (0.010267495893, 0.010267495893, 0.00666)),
    (0, (0, 1, 0), (0, 0.13585, 0), (-0.28, 0, 0), 8.393, (0.0151074, 0.22689067591, 0.22689067591)),
    (1, (0, 1, 0), (0.145, -0.1197, 0), (-0.25, 0, 0), 2.275, (0.004095, 0.049443313556, 0.049443313556)),
    (2, (0, 1, 0), (0.14225, 0, 0), (0, 0, 0), 1.219, (0.111172755531, 0.111172755531, 0.21942)),
    (3, (0, 0, -1), (0, 0.093, 0), (0, 0, 0), 1.219, (0.111172755531, 0.111172755531, 0.21942)),
    (4, (0, 1, 0), (0, 0, -0.09465), (0, 0, 0), 0.1879, (0.0171364731454, 0.033822, 0.0171364731454)),
]


def chain(links):
    return [
        (i - 1, (0, 0, 1), (0.5 if i > 0 else 0, 0, 0), (-0.5, 0, 0), 1, (0.01, 1 / 12, 1 / 12))
        for i in range(links)
    ]


CASES = {"6r": (ROBOT, (0, 0, -9.81))}
for links in (2, 10, 50, 200, 1000):
    CASES[f"chain_{links}"] = (chain(links), (0, -9.81, 0))


def words(values):
    return " ".join(repr(float(v)) for v in values)


def tree_text(tree, gravity):
    lines = [words(gravity)]
    for parent, *numbers, mass, moments in tree:
        lines.append(f"{parent} " + " ".join(map(words, numbers)) + f" {mass} " + words(moments))
    return "\n".join(lines) + "\n"


def mjcf(tree, gravity):
    """Its frames are at the joints. Bodies follow one another, as all of these do."""
    text = [f'<mujoco><option gravity="{words(gravity)}"><flag contact="disable" constraint="disable" '
            'passive="disable" actuation="disable"/></option><worldbody>']
    for parent, axis, place, own, mass, moments in tree:
        before = tree[parent][3] if parent >= 0 else (0, 0, 0)
        at = words(p - b for p, b in zip(place, before))
        text.append(f'<body pos="{at}"><joint type="hinge" axis="{words(axis)}"/>'
                    f'<inertial pos="{words(-x for x in own)}" mass="{mass}" diaginertia="{words(moments)}"/>')
    return "\n".join(text) + "</body>" * len(tree) + "</worldbody></mujoco>\n"


def build(name, command, folder):
    program = os.path.join(folder, name)
    done = subprocess.run([*command, "-o", program], capture_output=True, text=True)
    if done.returncode == 0:
        return program
    print(f"# {name}: not built, " + (done.stderr.strip().splitlines() or ["no reason"])[0])
    return None


def drivers(folder):
    mujoco = os.path.join(HERE, "peer_mujoco.cc")
    simbody = os.path.join(HERE, "peer_simbody.cc")
    return {
        "mujoco": build("peer_mujoco", ["c++", "-O2", mujoco, "-lmujoco"], folder),
        "simbody": build("peer_simbody", ["c++", "-O2", "-w", "-I/usr/include/simbody", simbody, "-lSimTKsimbody",
                                          "-lSimTKmath", "-lSimTKcommon"], folder),
    }


def rows_of(text):
    """accelerations and torques, and the figures by name"""
    found, figures = {"u'": [], "tau": []}, {}
    for line in text.splitlines():
        if line.startswith(("# u'", "# tau")):
            found[line.split()[1]] = [float(word) for word in line.split()[2:]]
        elif not line.startswith("#"):
            figures[line.split()[0]] = float(line.split()[1])
    return found, figures


def run_peer(peer, program, tree, gravity):
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(mjcf(tree, gravity))
        file.flush()
        command = [program, file.name] if peer == "mujoco" else [program]
        done = subprocess.run(command, input=tree_text(tree, gravity), capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise OSError(" ".join((done.stdout + done.stderr).replace("#", " ").split()) or "it failed")
    return rows_of(done.stdout)


def differs(found, right):
    """of the largest"""
    if len(found) != len(right):
        return math.inf
    return max(abs(a - b) for a, b in zip(found, right)) / max(map(abs, right))


def run_case(name, ours, peers):
    tree, gravity = CASES[name]
    done = subprocess.run([ours, name], capture_output=True, text=True, check=True)
    right, own = rows_of(done.stdout)
    own = {key[len(f"dynamics.{name}_"):]: value for key, value in own.items()}
    agree = True
    for what, value in own.items():
        unit = "ours" if what.endswith("times") else "ops" if what.endswith("s") else "ns"
        print(f"peers.{name}_{what} {value:.4g} {unit}")
    for said in done.stdout.splitlines():
        if said.startswith(f"# {name}:"):
            print(said)
    for peer, program in peers.items():
        if program is None:
            continue
        try:
            found, figures = run_peer(peer, program, tree, gravity)
        except (OSError, subprocess.TimeoutExpired) as failure:
            print(f"# {name}: {peer}: {failure}")
            continue
        off = max(differs(found[what], right[what]) for what in right if right[what])
        agree = agree and off < 1e-8
        print(f"peers.{name}_{peer}_differs {off:.2g} of the largest")
        for what, value in figures.items():
            print(f"peers.{name}_{what}_{peer} {value:.4g} ns")
            if what in own:
                print(f"peers.{name}_{what}_{peer}_times {value / own[what]:.3g} ours")
        if "inverse_row" in own:
            print(f"peers.{name}_inverse_{peer}_row_times {figures['inverse'] / own['inverse_row']:.3g} ours")
    return agree


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    peers = drivers(sys.argv[2])
    sys.exit(0 if all([run_case(name, sys.argv[1], peers) for name in CASES]) else 1)


if __name__ == "__main__":
    main()
