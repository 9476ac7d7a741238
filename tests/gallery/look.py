"""What a picture of the gallery shows: `look.py NAME`; status 1 and a line where it isn't so."""
import math
import re
import struct
import sys
import xml.etree.ElementTree as tree
import zlib


def local(element):
    return element.tag.rsplit("}", 1)[-1]


def moved(element):
    """(x, y) of a translation, or None"""
    at = re.match(r"translate\(\s*([-\d.]+),\s*([-\d.]+)\s*\)", element.get("transform") or "")
    return at and (float(at[1]), float(at[2]))


class Plot:
    """An SVG of gnuplot's: its texts, and the groups that are curves, each with colour and dash."""

    def __init__(self, name):
        self.root = tree.parse(name).getroot()
        self.texts = ["".join(e.itertext()).strip() for e in self.root.iter() if local(e) == "text"]
        self.groups = [e for e in self.root.iter()
                       if local(e) == "g" and re.match(r"gnuplot_plot_", e.get("id") or "")]

    def placed(self):
        """level texts, each with its place (x, y) on the sheet and what stands there of it"""
        return [("".join(t.itertext()).strip(), *at, e.get("text-anchor"))
                for e in self.root.iter() if (at := moved(e)) and "rotate" not in e.get("transform")
                for t in e if local(t) == "text"]

    def points(self, group):
        """of the longest line: not of that in the legend"""
        lines = [re.findall(r"(-?[\d.]+),(-?[\d.]+)", piece) for e in group.iter()
                 if local(e) == "path" for piece in e.get("d", "").split("M")]
        return [tuple(map(float, q)) for q in max(lines, key=len)]

    def ink(self, group):
        """colour and dash of what is drawn"""
        text = tree.tostring(group, encoding="unicode")
        colours = re.findall(r"rgb\(\s*\d+,\s*\d+,\s*\d+\)", text)
        dashes = re.findall(r"stroke-dasharray[=:]\s*[\"']?([0-9., ]+)", text)
        return (colours[-1] if colours else None, dashes[0] if dashes else None)


def need(condition, why):
    if not condition:
        sys.exit("not so: " + why)


def has(plot, *labels):
    for label in labels:
        need(label in plot.texts, f"no text '{label}' among {plot.texts}")


def plot(name, curves, *labels):
    out = Plot(name + ".svg")
    need(len(out.groups) == curves, f"{len(out.groups)} curves, not {curves}")
    has(out, *labels)
    apart([box(text, x, y, 14, anchor) for text, x, y, anchor in out.placed() if text])
    return out


def box(text, x, y, size, anchor="start"):
    """what a text takes, rather a little less: letters are at least half as wide as high"""
    wide = 0.5 * size * len(text)
    left = x - {"start": 0, "middle": wide / 2, "end": wide}[anchor]
    return text, left, y - 0.7 * size, left + wide, y


def apart(boxes):
    """no name covers another"""
    for i, (a, left, top, right, bottom) in enumerate(boxes):
        for b, *other in boxes[:i]:
            need(left >= other[2] or right <= other[0] or top >= other[3] or bottom <= other[1],
                 f"'{a}' covers '{b}'")


class Sheet:
    """An SVG of ours: groups of a class and a name, and within them lines, areas, rings, texts."""

    def __init__(self, name):
        self.root = tree.parse(name).getroot()
        self.groups = [e for e in self.root.iter() if local(e) == "g" and e.get("class")]

    def count(self, kind):
        return sum(1 for e in self.groups if e.get("class") == kind)

    def find(self, title):
        """the groups called "body m1" """
        out = [e for e in self.groups if any(local(t) == "title" and t.text == title for t in e)]
        need(out, f"there is no '{title}'")
        return out

    def points(self, title, shape, which=0):
        lines = [e for g in self.find(title) for e in g if local(e) == shape]
        need(len(lines) > which, f"'{title}' has {len(lines)} of {shape}")
        return [tuple(map(float, p.split(","))) for p in lines[which].get("points").split()]

    def texts(self, title):
        return ["".join(e.itertext()) for g in self.find(title) for e in g if local(e) == "text"]

    def boxes(self, *kinds):
        return [box("".join(e.itertext()), float(e.get("x")), float(e.get("y")),
                    float(e.get("font-size")), e.get("text-anchor"))
                for g in self.groups if g.get("class") in kinds for e in g if local(e) == "text"]

    def metre(self):
        """px of a metre, by the scale"""
        bar = self.points("scale of lengths and forces", "polyline")
        number, unit = self.texts("scale of lengths and forces")[0].split()
        return (bar[-1][0] - bar[0][0]) / (float(number) / (1000 if unit == "mm" else 1))


    def arrow(self, title, line=0):
        """from its foot to its tip, px"""
        tip = self.points(title, "polygon")[0]
        return math.dist(self.points(title, "polyline", line)[0], tip)


def length(line):
    return math.dist(line[0], line[-1])


def numbers(plot):
    return [float(t.replace("\u2212", "-")) for t in plot.texts
            if re.fullmatch("[-\u2212]?[0-9.]+", t)]


def png(name):
    """width, height, and the part of pixels that differ from the first one"""
    data = open(name, "rb").read()
    need(data[:8] == b"\x89PNG\r\n\x1a\n", name + " is no PNG")
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    need(depth == 8, "8 bits a sample")
    bytes_of = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    raw, stride = zlib.decompress(packed), width * bytes_of + 1
    need(len(raw) == stride * height, "rows are whole")
    # rows that hold anything but a repetition of what stands left of or above it
    busy = sum(1 for y in range(1, height) if any(raw[y * stride + 1 + bytes_of:(y + 1) * stride]))
    return width, height, busy / height


def one():
    p = plot("one", 1, "h8 [rad]", "t [s]", "Slider-crank", "top")
    need(p.texts.count("h8 [rad]") == 1, "one curve needs no legend")


def two():
    p = plot("two", 2, "h8 [deg]", "s11 [mm]", "t [s]")
    need(p.texts.count("s11 [mm]") == 2, "legend and right axis both say it")
    need(min(numbers(p)) <= -600 and max(numbers(p)) >= 500, "two scales")


def three():
    p = plot("three", 3, "h8 [rad]", "h8' [rad/s]", "s11 [m]", "t [s]")
    need(p.texts.count("t [s]") == 1, "the panels share the axis of time")
    need(p.texts.count("0.4") >= 3, "each panel has its tics")


def bars():
    p = plot("bars", 5, "h8 [rad]", "h8' [rad/s]", "s11 [m]", "m2.x, m2.y [m]")
    need(p.texts.count("h8 [rad]") == 1, "a panel of one curve has no legend")


def powers():
    """numbers with powers of ten leave room for the labels beside them"""
    p = plot("powers", 4, "h8 [rad]")
    turned = [moved(e)[0] for e in p.root.iter() if moved(e) and "rotate" in e.get("transform")]
    need(len(turned) == 3 and min(turned) > 5, f"labels of axes stand at {turned}")


def alone():
    plot("alone", 2, "h8 [rad]", "h9 [rad]", "each alone")


def path():
    """a metre is as long along y as along x: the crank's pin goes round"""
    p = plot("path", 2, "m2.y, r5.y [m]", "r5.x [m]")
    points = p.points(p.groups[1])
    wide = max(x for x, _ in points) - min(x for x, _ in points)
    tall = max(y for _, y in points) - min(y for _, y in points)
    need(abs(wide / tall - 1) < 0.02, f"{wide:.1f} wide and {tall:.1f} tall")


def many():
    p = plot("many", 9, "t [s]")
    inks = [p.ink(g) for g in p.groups]
    need(len({c for c, _ in inks}) == 7, f"seven colours: {inks}")
    need(len(set(inks)) == 9, f"no two alike: {inks}")
    need([d is None for _, d in inks] == [True] * 7 + [False] * 2, "dashes where colours repeat")


def runs():
    p = plot("runs", 3, "run1.s11, run2.s11 [m]")
    need(any(t.endswith("[mm]") for t in p.texts), "the difference is in mm")


    names = [at for at in p.placed() if at[0] == "top"]
    need(len(names) == 1, "an event of both runs at nearly one instant is named once")


def events():
    """events one after the other, the last at the end of the run: names cover nothing"""
    p = plot("events", 1, "low", "lower", "near_the_end")
    right = max(x for x, _ in p.points(p.groups[0]))
    for text, x, _, anchor in p.placed():
        if text == "near_the_end":
            need(anchor == "end" and x < right, f"its name goes beyond the axis: {x}, {right}")


def measured():
    """three points of the file, where they were measured, whatever the rows of the run"""
    p = plot("measured", 2, "s11 [m]", "x (measured.csv)")
    marks = [moved(m) for m in p.groups[1].iter() if local(m) == "use"]
    legend = next(y for text, _, y, _ in p.placed() if text == "x (measured.csv)")
    marks = [at for at in marks if at[1] > legend + 10]
    need(len(marks) == 3, f"{len(marks)} points, not 3")
    curve = p.points(p.groups[0])
    left, right = curve[0][0], curve[-1][0]
    for (x, _), t in zip(sorted(marks), (0, 0.5, 1)):
        need(abs((x - left) / (right - left) - t) < 2e-3, f"a point of {t} s at {x}")


def mixed():
    """what has no unit that is known doesn't get its neighbour's"""
    plot("mixed", 2, "s11 [mm], (2*s11)")


def units():
    plot("units", 2, "h8 [deg]", "s11 [mm]")
    plot("logs", 1, "f [Hz], window of Hann", "spectrum(h) [rad]")


def spectrum():
    """2 sin(2 pi 4 t) through the window of Hann, whole periods: its amplitude at 4 Hz"""
    p = plot("spectrum", 1, "spectrum(h) [rad]", "f [Hz], window of Hann")
    points = p.points(p.groups[0])
    tops = {round(x, 1) for x, y in points if y == min(y for _, y in points)}
    need(len(tops) == 1, str(tops))
    shares = (tops.pop() - points[0][0]) / (points[-1][0] - points[0][0])
    need(abs(shares * 6 - 4) < 0.05, f"the peak is at {shares * 6} of 6 Hz")


def ranges():
    p = plot("ranges", 1, "t [s]", "0.2", "0.8", "1", "10")
    need("0.9" not in p.texts and "0.1" not in p.texts, "nothing beyond the range")


def png_of_both():
    width, height, busy = png("two.png")
    need((width, height) == (960, 600), f"{width} x {height}")
    need(busy > 0.7, "it is drawn all over")
    width, height, busy = png("mechanism.png")
    need(300 < width <= 1000 and 150 < height <= 800 and busy > 0.4, f"{width} x {height}, {busy}")


def documents():
    need(open("one.pdf", "rb").read(5) == b"%PDF-", "a PDF")
    tex = open("one.tex").read()
    need("\\begin{tikzpicture}" in tex and "h8 [rad]" in tex, "TikZ, with its label")


def loop():
    """1/(s (s + 1)^2) by hand: -180 deg at 1 rad/s, where it is a half; 1 at 0.6823 rad/s"""
    plot("loop", 2, "gain margin 6.02 dB at 0.159 Hz", "phase margin 21.4 deg at 0.109 Hz")


def graph():
    root = tree.parse("graph.svg").getroot()
    classes = [e.get("class") for e in root.iter() if local(e) == "g"]
    need(classes.count("node") == 16 and classes.count("branch") == 14, str(classes))
    for group in root.iter():
        kind = group.get("class")
        lines = [e for e in group if local(e) == "polyline"] if kind in ("branch", "chord") else []
        for e in lines[:1]:
            width = float(e.get("stroke-width"))
            need(width > 3 if kind == "branch" else width < 1.5, f"a {kind} of {width}")
    width, height, busy = png("graph.png")
    need(width > 300 and height > 200 and busy > 0.4, f"{width} x {height}, {busy}")


def mechanism():
    root = tree.parse("mechanism.svg").getroot()
    classes = [e.get("class") for e in root.iter() if local(e) == "g"]
    need(classes.count("body") == 3 and classes.count("force") == 1, str(classes))
    width, height = (float(root.get(k)) for k in ("width", "height"))
    for e in root.iter():
        for x, y in re.findall(r"(-?[\d.]+),(-?[\d.]+)", e.get("points") or ""):
            need(0 <= float(x) <= width and 0 <= float(y) <= height, f"({x}, {y}) is off the sheet")
    texts = ["".join(e.itertext()) for e in root.iter() if local(e) == "text"]
    for name in ("m1", "m2", "m3", "h8", "h9", "h10", "s11", "F12", "g", "x", "y", "t = 0 s"):
        need(texts.count(name) == 1, f"'{name}' stands there {texts.count(name)} times")


def spatial():
    """seen along x what is nearer lies over what is farther, and seen from above beside it"""
    sheet = Sheet("along_x.svg")
    order = [e.find("{*}title").text for e in sheet.groups if e.get("class") == "body"]
    need(order == ["body far", "body middle", "body near"], str(order))
    sheet = Sheet("along_z.svg")
    places = [float(sheet.find("body " + b)[0].find("{*}circle").get("cx"))
              for b in ("far", "middle", "near")]
    need(abs(places[1] - places[0] - 2 * sheet.metre()) < 0.3 and
         abs(places[2] - places[1] - 1 * sheet.metre()) < 0.3, f"{places}, {sheet.metre()} px a metre")
    for kind in ("revolute", "spherical", "prismatic"):
        need(Sheet("iso.svg").count(kind) == 1, "one " + kind)
    apart(Sheet("iso.svg").boxes("names"))


def bent():
    """a cantilever below its load: P L^3/(3 EI) at its end, and 5/16 of that half way"""
    sheet = Sheet("bent.svg")
    area = sheet.points("body b", "polygon")
    sag = 1.0 * 1.0**3 / (3 * 5.0) * sheet.metre()
    left = [y for x, y in area if x < min(x for x, _ in area) + 4]
    right = [y for x, y in area if x > max(x for x, _ in area) - 4]
    found = sum(right) / len(right) - sum(left) / len(left)
    need(abs(found / sag - 1) < 0.03, f"it sags {found} px, not {sag}")


def wavy():
    """a strongly bent beam has no corners but round its ends"""
    area = Sheet("wavy.svg").points("body b", "polygon")
    low, high = min(x for x, _ in area) + 12, max(x for x, _ in area) - 12
    for a, b, c in zip(area, area[1:], area[2:]):
        if low < b[0] < high and math.dist(a, b) > 1 and math.dist(b, c) > 1:
            turn = math.atan2(c[1] - b[1], c[0] - b[0]) - math.atan2(b[1] - a[1], b[0] - a[0])
            need(abs(math.remainder(turn, 2 * math.pi)) < 0.12, f"a corner at {b}")


def springs():
    """drawn from end to end, whatever is between; what ends in the ground has a wall there"""
    sheet = Sheet("springs.svg")
    for name, size in (("spring k1", 1.0), ("damper d1", 1.0), ("spring k2", math.sqrt(2))):
        lines = [sheet.points(name, "polyline", i)
                 for i in range(sum(1 for e in sheet.find(name)[0] if local(e) == "polyline"))]
        ends = [p for line in lines for p in (line[0], line[-1])]
        need(any(abs(math.dist(a, b) - size * sheet.metre()) < 0.5 for a in ends for b in ends),
             f"{name}: no two ends are {size} m apart")
        walls = [line for line in lines if len(line) == 2 and abs(length(line) - 22) < 0.1]
        need(len(walls) == (name != "spring k2"), f"{name}: {len(walls)} walls")
    apart(sheet.boxes("names"))


def forces():
    """arrows to the scale that stands below: 3 N, 4 N, and 5 N where both pull"""
    sheet = Sheet("forces.svg")
    scale = "scale of lengths and forces"
    newton = sheet.arrow(scale, 1) / float(sheet.texts(scale)[1].split()[0])
    for name, size in (("force P", 3), ("force Q", 4), ("reaction h", 5)):
        found = sheet.arrow(name)
        need(abs(found / newton / size - 1) < 0.03, f"{name}: {found / newton} N, not {size}")


def domains():
    """each domain has its own colour and dash, and its line in the legend"""
    sheet = Sheet("domains.svg")
    legend = [e for g in sheet.find("legend of edges") for e in g]
    words = ["".join(e.itertext()) for e in legend if local(e) == "text"]
    lines = [(e.get("stroke"), e.get("stroke-dasharray")) for e in legend if local(e) == "polyline"]
    need(words == ["branch", "chord", "mechanical", "electrical"], str(words))
    need(len(set(lines[2:])) == 2 and lines[2][1] != lines[3][1], str(lines))
    apart(sheet.boxes("node"))


def circuit():
    """the circuit of h10 in the slider-crank goes over all of its loop: lit are just its edges"""
    sheet = Sheet("circuit.svg")
    lit = {g.find("{*}title").text.split()[1] for g in sheet.groups
           if g.get("class") in ("branch", "chord") and len(g.findall("{*}polyline")) > 2}
    need(lit == {"h10", "s11", "r7", "r6", "h9", "r5", "r4", "h8"}, str(sorted(lit)))


def between(line, a, b):
    """the line joins the two, up to the sizes of a ring and of a port's dot"""
    return min(math.dist(line[0], a) + math.dist(line[-1], b),
               math.dist(line[0], b) + math.dist(line[-1], a)) < 14


def ports():
    """collapsed an instance is a box with its ports at its border, and the edges of its ports in
    the trees; open there is all that is inside"""
    nodes = {}
    for name in ("collapsed", "open"):
        sheet = Sheet(name + ".svg")
        nodes[name] = {g.find("{*}title").text for g in sheet.groups if g.get("class") == "node"}
    need("node p.b" not in nodes["collapsed"] and "node p.b" in nodes["open"], str(nodes))
    need(len(nodes["collapsed"]) < len(nodes["open"]), str(nodes))
    need("instance" not in {g.get("class") for g in sheet.groups}, "open there is a box")

    sheet = Sheet("collapsed.svg")
    rings = {}  # those of the first panel stand first
    for g in sheet.groups:
        circles = [e for e in g if local(e) == "circle"]
        if g.get("class") == "node":
            rings.setdefault(g.find("{*}title").text.split()[1],
                             (float(circles[0].get("cx")), float(circles[0].get("cy"))))
    pins = {}
    for box_of in ("p", "q"):
        (group,) = sheet.find("instance " + box_of)
        corners = sheet.points("instance " + box_of, "polygon")
        low, high = [[f(c[i] for c in corners) for i in (0, 1)] for f in (min, max)]
        dots = [(float(e.get("cx")), float(e.get("cy"))) for e in group if local(e) == "circle"]
        words = ["".join(e.itertext()) for e in group if local(e) == "text"]
        need(words == [box_of, "A", "B", "supply"], str(words))
        pins.update({f"{box_of}.{word}": dot for word, dot in zip(words[1:], dots)})
        for x, y in dots:
            at_side = x in (low[0], high[0]) and low[1] < y < high[1]
            need(at_side or (y in (low[1], high[1]) and low[0] < x < high[0]), f"{x}, {y}")
        for e in group:
            if local(e) == "text":
                at = float(e.get("x")), float(e.get("y"))
                need(all(low[i] < at[i] < high[i] for i in (0, 1)), f"{at} is outside")
        for node, (x, y) in rings.items():
            need(not (low[0] < x < high[0] and low[1] < y < high[1]), f"{node} is in {box_of}")
    # who gives the motion or voltage: the chain of bodies hands it on from ground to the end
    for port, node, gives in (("p.A", "ground", False), ("p.B", "p.B", True), ("p.supply", "v", False),
                              ("q.A", "p.B", False), ("q.B", "q.B", True), ("q.supply", "v", False)):
        line = sheet.points("port " + port, "polyline")
        need(between(line, pins[port], rings[node]), f"{port} isn't joined to {node}")
        tip = sheet.points("port " + port, "polygon")[0]
        to_node = math.dist(tip, rings[node]) < math.dist(tip, pins[port])
        need(to_node == gives, f"the arrow of {port}")
    outside = {g.find("{*}title").text for g in sheet.groups if g.get("class") == "outside"}
    need(outside == {"outside V", "outside c", "outside h3"}, str(outside))
    apart(sheet.boxes("instance", "node"))


def characters():
    """the same in characters: braille, names and the scale"""
    for name, words in (("plot.txt", ("h8 [deg]", "s11 [mm]", "t [s]", "top")),
                        ("drawn.txt", ("m1", "m2", "h8", "h9"))):
        text = open(name, encoding="utf-8").read()
        need(re.search("[\u2801-\u28ff]", text), name + " has no braille")
        for word in words:
            need(word in text, f"{name} has no '{word}'")


def moving():
    gif = open("moving.gif", "rb").read()
    need(gif[:6] == b"GIF89a" and gif.count(b"\x21\xf9\x04") == 10, "ten pictures in 0.4 s")
    root = tree.parse("moving.svg").getroot()
    need(sum(1 for e in root.iter() if local(e) == "animate") == 10, "ten frames")
    page = open("moving.html").read()
    tree.fromstring(page[page.index("<svg"):page.index("</svg>") + 6])
    need(page.count('class="frame"') == 10 and "http" not in page, "a page that needs nothing")


def page():
    """what a browser makes of the page: time goes on, and one frame is shown at a time"""
    text = open("page.html", encoding="utf-8").read()
    frames = re.findall(r'<g class="(frame[^"]*)"', text)
    need(len(frames) == 10 and frames.count("frame on") == 1, str(frames))
    times = [float(t) for t in re.findall(r"t = (\S+) s", re.search("<title>(.*?)</title>", text)[1])]
    need(len(times) > 1 and times[0] < times[1], str(times))
    width, height, busy = png("page.png")
    need((width, height) == (900, 700) and busy > 0.3, f"{width} x {height}, {busy}")


{"one": one, "two": two, "three": three, "bars": bars, "powers": powers, "alone": alone, "path": path,
 "many": many, "runs": runs, "measured": measured, "ranges": ranges, "png": png_of_both,
 "documents": documents, "loop": loop, "graph": graph, "mechanism": mechanism, "moving": moving, "events": events, "mixed": mixed,
 "units": units, "spectrum": spectrum, "spatial": spatial, "bent": bent, "wavy": wavy,
 "springs": springs,
 "forces": forces, "domains": domains, "circuit": circuit, "ports": ports,
 "characters": characters, "page": page}[sys.argv[1]]()
