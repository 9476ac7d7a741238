"""What a picture of the gallery shows: `look.py NAME`; status 1 and a line where it isn't so."""
import re
import struct
import sys
import xml.etree.ElementTree as tree
import zlib


def local(element):
    return element.tag.rsplit("}", 1)[-1]


class Plot:
    """An SVG of gnuplot's: its texts, and the groups that are curves, each with colour and dash."""

    def __init__(self, name):
        self.root = tree.parse(name).getroot()
        self.texts = ["".join(e.itertext()).strip() for e in self.root.iter() if local(e) == "text"]
        self.groups = [e for e in self.root.iter()
                       if local(e) == "g" and re.match(r"gnuplot_plot_", e.get("id") or "")]

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
    return out


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


def measured():
    p = plot("measured", 2, "s11 [m]")
    need(tree.tostring(p.groups[1], encoding="unicode").count("use ") > 20, "points, not a line")


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


def moving():
    gif = open("moving.gif", "rb").read()
    need(gif[:6] == b"GIF89a" and gif.count(b"\x21\xf9\x04") == 10, "ten pictures in 0.4 s")
    root = tree.parse("moving.svg").getroot()
    need(sum(1 for e in root.iter() if local(e) == "animate") == 10, "ten frames")
    page = open("moving.html").read()
    tree.fromstring(page[page.index("<svg"):page.index("</svg>") + 6])
    need(page.count('class="frame"') == 10 and "http" not in page, "a page that needs nothing")


{"one": one, "two": two, "three": three, "bars": bars, "alone": alone, "path": path, "many": many,
 "runs": runs, "measured": measured, "ranges": ranges, "png": png_of_both,
 "documents": documents, "loop": loop, "graph": graph, "mechanism": mechanism, "moving": moving}[sys.argv[1]]()
