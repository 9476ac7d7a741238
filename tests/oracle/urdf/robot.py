"""A robot in URDF, read by the rules of the format, and held against what cotree imports.

    robot.py COTREE FILE FOLDER

A link's frame follows from its parent's by the joint's origin, then by the joint's motion along or
about its axis. Speeds of mass centres come from differences of places (a complex step isn't at
hand for rotations): five points, so that their error is far below the tolerance.
"""
import random
import re
import subprocess
import sys
import xml.etree.ElementTree as tree

import numpy as np

GRAVITY = np.array([0.7, -1.1, -9.5])
TOLERANCE = 1e-9


def numbers(element, name, default):
    text = element.get(name) if element is not None else None
    return np.array([float(word) for word in text.split()]) if text else np.array(default, float)


def about(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose(element):
    origin = element.find("origin") if element is not None else None
    roll, pitch, yaw = numbers(origin, "rpy", [0, 0, 0])
    place = np.eye(4)
    place[:3, :3] = about(np.array([0, 0, 1.0]), yaw) @ about(np.array([0, 1.0, 0]), pitch) @ about(
        np.array([1.0, 0, 0]), roll)
    place[:3, 3] = numbers(origin, "xyz", [0, 0, 0])
    return place


def of_parameters(p):
    w, v = p[0], np.array(p[1:])
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return (w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * cross


def legal(name):
    name = re.sub(r"[^A-Za-z0-9]", "_", name)
    return name if name[0].isalpha() else "n" + name


class Robot:
    FREEDOMS = {"revolute": 1, "continuous": 1, "prismatic": 1, "fixed": 0, "floating": 7, "planar": 3}

    def __init__(self, path):
        root = tree.parse(path).getroot()
        self.links = {link.get("name"): link for link in root.findall("link")}
        self.joints = root.findall("joint")
        self.root = (set(self.links) - {j.find("child").get("link") for j in self.joints}).pop()
        self.moving = [j for j in self.joints if self.FREEDOMS[j.get("type")] > 0]

    def motion(self, joint, q):
        axis = numbers(joint.find("axis"), "xyz", [1, 0, 0])
        place = np.eye(4)
        kind = joint.get("type")
        if kind in ("revolute", "continuous"):
            place[:3, :3] = about(axis, q[0])
        elif kind == "prismatic":
            place[:3, 3] = q[0] * axis / np.linalg.norm(axis)
        elif kind == "planar":  # axis z alone is tried
            place[:3, :3] = about(axis, q[2])
            place[:3, 3] = [q[0], q[1], 0]
        elif kind == "floating":
            place[:3, :3] = of_parameters(q[3:])
            place[:3, 3] = q[:3]
        return place

    def places(self, q):
        found = {self.root: np.eye(4)}
        while len(found) < len(self.links):
            for joint in self.joints:
                parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
                if parent in found and child not in found:
                    found[child] = found[parent] @ pose(joint) @ self.motion(
                        joint, q.get(joint.get("name")))
        return found

    def inertial(self, name):
        """mass, place of the centre's axes in the link, tensor there"""
        inertial = self.links[name].find("inertial")
        if inertial is None:
            return 0, np.eye(4), np.zeros((3, 3))
        given = inertial.find("inertia")
        xx, yy, zz, xy, xz, yz = (float(given.get(k)) for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        return (float(inertial.find("mass").get("value")), pose(inertial),
                np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))

    def is_heavy(self, name):
        """with a mass, or with an inertia alone, as of a rotor"""
        mass, _, tensor = self.inertial(name)
        return mass > 0 or bool(tensor.any())

    def bodies(self, q):
        return {n: p @ self.inertial(n)[1] for n, p in self.places(q).items() if self.is_heavy(n)}

    def potential(self, q):
        return -sum(self.inertial(n)[0] * GRAVITY @ p[:3, 3] for n, p in self.bodies(q).items())

    def kinetic(self, at):
        """of a motion q = at(time), at time 0"""
        h, weights = 1e-3, {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
        now, energy = self.bodies(at(0)), 0
        rates = {n: np.zeros((4, 4)) for n in now}
        for step, weight in weights.items():
            for n, p in self.bodies(at(step * h)).items():
                rates[n] += weight * p / h
        for n, p in now.items():
            mass, _, tensor = self.inertial(n)
            spin = rates[n][:3, :3] @ p[:3, :3].T
            w = p[:3, :3].T @ np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
            energy += mass * rates[n][:3, 3] @ rates[n][:3, 3] / 2 + w @ tensor @ w / 2
        return energy


def names_here(robot, script):
    """frames of links and names of joints: their order in the script is that of the statements"""
    frames = {}
    for name in robot.links:
        mine = legal(name)
        _, centre, _ = robot.inertial(name)
        if name == "ground":
            mine = "ground_2"
        frames[name] = mine + "_origin" if robot.is_heavy(name) and centre[:3, 3].any() else mine
    joints = {}
    for joint in robot.joints:
        mine = legal(joint.get("name"))
        if joint.get("name") in robot.links or mine == "t":
            mine += "_2"
        joints[joint.get("name")] = mine
    for name in list(frames.values()):
        assert re.search(r"(body|arm) %s\b" % name, script), "no frame " + name
    return frames, joints


MEMBERS = {"floating": ["x", "y", "z", "q0", "q1", "q2", "q3"], "planar": ["s1", "s2", "theta"]}


def main():
    cotree, path, folder = sys.argv[1:]
    robot, chance = Robot(path), random.Random(path.split("/")[-1])
    script = subprocess.run([cotree, "-q", "-e", 'import urdf "%s" > "/dev/fd/1"' % path],
                            capture_output=True, text=True, check=True).stdout
    frames, joints = names_here(robot, script)
    # places are drawn anywhere, also beyond the ranges of joints
    lines = re.sub(r"(?m)^(init|stop) .*$", "", script).split("\n")
    lines = [line for line in lines if "_mimic" not in line]
    lines += ["gravity [%r, %r, %r]" % tuple(float(g) for g in GRAVITY)]
    wanted = []
    for _ in range(3):
        q, v = {}, {}
        for joint in robot.moving:
            count = Robot.FREEDOMS[joint.get("type")]
            q[joint.get("name")] = np.array([chance.uniform(-1, 1) for _ in range(count)])
            v[joint.get("name")] = np.array([chance.uniform(-1, 1) for _ in range(count)])
            if joint.get("type") == "floating":
                q[joint.get("name")][3:] /= np.linalg.norm(q[joint.get("name")][3:])
                p, r = q[joint.get("name")][3:], v[joint.get("name")][3:]
                v[joint.get("name")][3:] = r - (r @ p) * p
        lines.append("init none")
        for joint in robot.moving:
            name, kind = joint.get("name"), joint.get("type")
            of = [joints[name] + "." + m for m in MEMBERS.get(kind, [])] or [joints[name]]
            for i, variable in enumerate(of):
                lines.append("init %s = %.17g, %s' = %.17g" % (variable, q[name][i], variable, v[name][i]))
        for name, place in robot.places(q).items():
            lines.append("print %s" % ", ".join(frames[name] + "." + m for m in ("x", "y", "z")))
            wanted += [("%s of %s" % (m, name), place[i, 3]) for i, m in enumerate("xyz")]
            # the rotation by its entries, as Euler parameters give them
            of = "%s.q" % frames[name]
            lines.append("print 1 - 2*(%s2^2 + %s3^2), 2*(%s1*%s2 - %s0*%s3), 2*(%s1*%s3 + %s0*%s2), "
                         "2*(%s2*%s3 - %s0*%s1)" % ((of,) * 14))
            wanted += [("R%d%d of %s" % (i, j, name), place[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 2))]
        lines.append("print energy.potential, energy.kinetic")

        def at(time):
            moved = {n: q[n] + time * v[n] for n in q}
            for joint in robot.moving:
                if joint.get("type") == "floating":
                    moved[joint.get("name")][3:] /= np.linalg.norm(moved[joint.get("name")][3:])
            return moved

        wanted += [("potential energy", robot.potential(q)), ("kinetic energy", robot.kinetic(at))]
    # what holds it: torques against gravity alone, dampers and all else at rest
    one = all(Robot.FREEDOMS[j.get("type")] == 1 for j in robot.moving)
    if one:
        lines.append("init none")
        lines += ["driver hold%d %s = %.17g" % (i, joints[j.get("name")], q[j.get("name")][0])
                  for i, j in enumerate(robot.moving)]
        lines += ["inverse 0.1 every=0.1", "print " + ", ".join("hold%d.effort" % i for i in range(len(robot.moving)))]
        for joint in robot.moving:
            def shifted(by):
                return {n: p + (by if n == joint.get("name") else 0) for n, p in q.items()}
            h = 1e-3
            slope = (8 * (robot.potential(shifted(h)) - robot.potential(shifted(-h)))
                     - (robot.potential(shifted(2 * h)) - robot.potential(shifted(-2 * h)))) / (12 * h)
            wanted.append(("effort of " + joint.get("name"), slope))
    with open(folder + "/robot.ct", "w") as file:
        file.write("set digits 15\n" + "\n".join(lines) + "\n")
    ran = subprocess.run([cotree, "-q", folder + "/robot.ct"], capture_output=True, text=True)
    if ran.returncode != 0:
        print(ran.stderr)
        return 1
    got = [float(line.split("=")[-1].split()[0]) for line in ran.stdout.split("\n") if line]
    if len(got) != len(wanted):
        print("%d values, %d wanted" % (len(got), len(wanted)))
        return 1
    worst = 0
    for (what, want), have in zip(wanted, got):
        off = abs(want - have) / max(1, abs(want))
        worst = max(worst, off)
        if not off < TOLERANCE:
            print("%s: %.12g, wanted %.12g" % (what, have, want))
    print("%d values of %d links, largest difference %.2g" % (len(got), len(robot.links), worst))
    return 0 if worst < TOLERANCE else 1


sys.exit(main())
