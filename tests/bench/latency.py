#!/usr/bin/env python3
"""How soon the shell answers a key and Ctrl-C, with a chain of 300 bodies in space.

    latency.py [-n TRIES] [-s SEED] COTREE

Types into a pseudo-terminal as a person does. Each verb is stopped at random instants; what it had
ended before doesn't count. Prints `latency.WHAT WORST ms`; what is slower than LIMIT is said behind
'#', and the status is 1."""

import argparse
import os
import pty
import random
import select
import signal
import sys
import tempfile
import time

LIMIT = 0.1  # s: from then on a person waits
PATIENCE = 30.0  # s
BODIES = 300
PROMPT = b"ct> "
VERBS = [
    "show equations", "show mass", "count", "check", "tree best", "draw mechanism", "linearize",
    "simulate 1000", 'export c > "/dev/null"',
]


def chain():
    lines = ["gravity [0, 0, -9.81]"]
    for i in range(BODIES):
        tail = "ground" if i == 0 else f"e{i - 1}"
        lines += [
            f"body b{i} mass=1 inertia=[0.1, 0.2, 0.3]",
            f"arm s{i} b{i} [-0.5, 0, 0]",
            f"arm e{i} b{i} [0.5, 0, 0]",
            f"revolute h{i} {tail} s{i} axis={'yz'[i % 2]}",
        ]
    return "\n".join(lines) + "\n"


class Terminal:
    """The shell in a pseudo-terminal."""

    def __init__(self, program, script):
        self.pid, self.end = pty.fork()
        if self.pid == 0:
            os.environ.update(TERM="xterm", PAGER="cat")
            os.execv(program, [program, "--no-init", "-i", script])

    def read(self, patience, until=None):
        """What it writes until that comes or the time is up."""
        text, end, seen = bytearray(), time.monotonic() + patience, 0
        while (left := end - time.monotonic()) > 0:
            if until is not None and text.find(until, max(0, seen - len(until))) >= 0:
                break
            seen = len(text)
            if select.select([self.end], [], [], left)[0]:
                text += os.read(self.end, 65536)
        return bytes(text)

    def answer(self, keys, until):
        """Seconds from the keys to what they bring."""
        begun = time.monotonic()
        os.write(self.end, keys)
        if until not in self.read(PATIENCE, until):
            raise TimeoutError
        return time.monotonic() - begun

    def close(self):
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)


def stop(terminal, verb, tries):
    """How long Ctrl-C took, of the tries that it met."""
    times = []
    for _ in range(tries):
        os.write(terminal.end, verb.encode() + b"\r")
        before = terminal.read(random.uniform(0.02, 2.0))
        if PROMPT in before.split(b"\n", 1)[-1]:
            continue
        times.append(terminal.answer(b"\x03", PROMPT))
        terminal.read(0.1)
    return times


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-n", dest="tries", type=int, default=6)
    parser.add_argument("-s", dest="seed", type=int, default=1)
    parser.add_argument("program")
    given = parser.parse_args()
    random.seed(given.seed)
    slow = 0
    with tempfile.TemporaryDirectory() as folder:
        script = os.path.join(folder, "chain.ct")
        with open(script, "w", encoding="utf-8") as file:
            file.write(chain())
        terminal = Terminal(os.path.abspath(given.program), script)
        terminal.read(PATIENCE, PROMPT)
        rows = {"a_key": [terminal.answer(b"x", b"x") for _ in range(20)]}
        terminal.answer(b"\x15\r", PROMPT)
        try:
            for verb in VERBS:
                rows[verb.split(" >")[0].replace(" ", "_")] = stop(terminal, verb, given.tries)
        except TimeoutError:
            print(f"# latency: '{verb}' heard no Ctrl-C for {PATIENCE:.0f} s")
            slow += 1
        terminal.close()
    for what, times in rows.items():
        if not times:
            print(f"# latency.{what}: always done before Ctrl-C came")
            continue
        print(f"latency.{what} {1e3 * max(times):.1f} ms")
        if max(times) > LIMIT:
            print(f"# latency.{what}: above {1e3 * LIMIT:.0f} ms")
            slow += 1
    sys.exit(1 if slow > 0 else 0)


if __name__ == "__main__":
    main()
