# SPDX-License-Identifier: GPL-3.0-or-later
# Renderers for the benchmark of named changes: frames of twinbox, charts of matplotlib, pages of Chromium. Each makes a picture
# out of elements, so that a change is one of an element, drawn by the renderer: begin(rng) returns a new picture's elements,
# draw(elements) its pixels, and where `variants` is true, draw(elements, variant=True) the same picture as other settings of the
# rasterizer draw it.
import dataclasses
import html
import json
import os
import subprocess
import sys

import matplotlib
import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import Affine2D, IdentityTransform
from PIL import Image

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
COLOURS = "#1f77b4 #d62728 #2ca02c #ff7f0e #9467bd #8c564b #17becf #34495e #e377c2 #7f7f7f".split()
WORDS = """speed solver contact stack impulse box energy result method error frame network sweep mass friction time step
    height report budget orders users region total average north south spring autumn""".split()


@dataclasses.dataclass(frozen=True)
class Element:
    """colours, contents: what it can have, the first being what it has. dx, dy: pixels to the right and down; subpixel: the axes along
    which the renderer draws parts of a pixel."""
    kind: str
    place: tuple = ()
    colours: tuple = ()
    contents: tuple = ()
    parent: int = -1
    shown: bool = True
    movable: bool = True
    removable: bool = True
    subpixel: str = ""
    dx: float = 0
    dy: float = 0


def words(rng, least, most):
    return " ".join(rng.choice(WORDS, rng.integers(least, most + 1))).capitalize()


def texts(rng, least, most):
    """A text and another of about the same length."""
    return tuple(words(rng, least, most) for _ in range(2))


def colours(rng, base=None):
    """A colour, one that is near it and two of other hues."""
    first, *others = rng.choice(COLOURS, 3, replace=False)
    first = base or first
    levels = [int(first[i : i + 2], 16) for i in (1, 3, 5)]
    step = int(rng.integers(24, 48))
    near = "#" + "".join(f"{level - step if level > 128 else level + step:02x}" for level in levels)
    return (str(first), near, *map(str, others))


def pixels(path):
    with Image.open(path) as image:
        return numpy.asarray(image.convert("RGB")).copy()


class Frames:
    """Frames of twinbox. The run that is drawn has one step, written with the elements' changes; its state is in no metadata,
    for pixels alone are kept.
    A body that is removed is in no run; an outline, out of view."""
    variants = False
    SIZES = "640x400", "800x600", "960x540", "480x480"
    VIEWS = {"single": (0, 4, 14, 10), "stack": (0, 6, 18, 13), "pyramid": (0, 7, 30, 17)}
    LOOKS = [(), ("--show", "velocities"), ("--compare", "overlay"), ("--compare", "difference")]

    def __init__(self, twinbox, scratch):
        self.twinbox, self.scratch, self.runs = twinbox, scratch, {}
        for scene in self.VIEWS:
            path = os.path.join(scratch, scene + ".npz")
            self.call("simulate", os.path.join(ROOT, "scenes", scene + ".yaml"), "--frames", "120", "-o", path)
            self.runs[scene] = dict(numpy.load(path))

    def call(self, *arguments):
        subprocess.run([self.twinbox, *arguments, "-q"], check=True)

    def begin(self, rng):
        scene = str(rng.choice(list(self.VIEWS)))
        self.run, self.view, self.scale = self.runs[scene], self.VIEWS[scene], None
        self.frame, self.size = int(rng.integers(10, 110)), str(rng.choice(self.SIZES))
        look = self.LOOKS[rng.integers(len(self.LOOKS))]
        self.two, self.look = "--compare" in look, [*look, "--theme", str(rng.choice(["light", "light", "dark"]))]
        away = numpy.abs(self.run["position"][self.frame] - self.view[:2])
        bodies = [int(i) for i in numpy.flatnonzero((away < numpy.array(self.view[2:]) / 2 - 1).all(axis=1)) if i > 0]
        elements = []
        for i in bodies:
            # A body of the ground has no arrow, and the bomb's mark is more than a colour.
            colour = ("box", "ground") if "velocities" not in look and i != int(self.run["bomb"]) else ()
            if self.two:
                colour = () if "overlay" in look else tuple(rng.permutation([0.0015, 0.004, 0.011, 0.02]))
            elements.append(Element("body", (i,), colour, ("as it is", "turned", "smaller"), movable="overlay" not in look,
                                    subpixel="xy"))
        if "velocities" in look:
            elements += [Element("arrow", (i,), (), ("as it is", "turned"), movable=False) for i in bodies]
        if "overlay" in look:
            elements += [Element("outline", (i, *rng.uniform(-1.5, 1.5, 2)), (), ("as it is", "turned"), subpixel="xy") for i in bodies]
        caption = texts(rng, 2, 4)
        return [*elements, Element("caption", (), (), caption[: 1 if "difference" in look else 2], movable=False, removable=False)]

    def state(self, elements, second):
        """Poses of the bodies as drawn; second: as the other run has them, whose outlines are drawn, or whose distance colours them.
        The last body is out of view, and far from itself in the other run: the header tells the largest distance."""
        state = {key: self.run[key][self.frame].astype(float) for key in ("position", "angle", "velocity", "angular_velocity")}
        for e in elements[:-1]:
            i = e.place[0]
            if e.kind == "arrow":
                turned = state["velocity"][i][::-1] * [1, -1] if e.contents[0] == "turned" else state["velocity"][i]
                state["velocity"][i] = turned * e.shown
            elif e.kind == ("outline" if second and "overlay" in self.look else "body"):
                distance = e.place[1:] if e.kind == "outline" else (e.colours[0], 0) if second else (0, 0)
                state["position"][i] += distance + numpy.array([e.dx, -e.dy]) / self.scale
                if not e.shown and e.kind == "outline":
                    state["position"][i] = [4000, 0]
                state["angle"][i] += 0.5 * (e.contents[0] == "turned")
        fastest = numpy.linalg.norm(self.run["velocity"][self.frame], axis=1).max()  # sets the scale of arrows
        anchor = {"position": [9000 - 18000 * second, 0], "velocity": [fastest + 1e-3, 0]}
        return {key: numpy.concatenate([of, [anchor.get(key, of[0] * 0)]])[None].astype(numpy.float32) for key, of in state.items()}

    def write(self, elements, second):
        size, fixed = numpy.append(self.run["size"], [[1, 1]], axis=0), numpy.append(self.run["fixed"], numpy.uint8(0))
        for e in elements:
            if e.kind == "body":
                size[e.place[0]] *= 0.6 if e.contents[0] == "smaller" else 1
                fixed[e.place[0]] |= e.colours[:1] == ("ground",)
        absent = [e.place[0] for e in elements if e.kind == "body" and not e.shown]
        bomb = int(self.run["bomb"])
        path = os.path.join(self.scratch, f"run{second:d}.npz")
        numpy.savez(path, size=numpy.delete(size, absent, 0), fixed=numpy.delete(fixed, absent), dt=self.run["dt"],
                    bomb=numpy.int32(-1 if bomb in absent else bomb - sum(i < bomb for i in absent)), scene=self.run["scene"],
                    method=self.run["method"], camera=numpy.float32([self.view[:2], self.view[2:]]),
                    **{key: numpy.delete(of, absent, 1) for key, of in self.state(elements, second).items()})
        return path

    def draw(self, elements):
        if self.scale is None:
            self.scale = 1
            self.draw([dataclasses.replace(e, dx=0, dy=0) for e in elements])
            with open(os.path.join(self.scratch, "drawn", "manifest.json")) as file:
                self.scale = json.load(file)["view"]["panels"][0]["scale"]
        runs = [self.write(elements, second) for second in range(1 + self.two)]
        captions = ["--caption", elements[-1].contents[0]] + ["--caption", "Other run"] * self.two
        self.call("render", *runs, "--size", self.size, "-o", os.path.join(self.scratch, "drawn"), *self.look, *captions)
        return pixels(os.path.join(self.scratch, "drawn", "frame_000000.png"))


class Charts:
    """Charts of matplotlib, by Agg."""
    variants = True
    SIZES = (640, 480), (800, 500), (720, 720), (1000, 600)

    def begin(self, rng):
        self.size, self.grid = self.SIZES[rng.integers(len(self.SIZES))], bool(rng.random() < 0.6)
        self.kind = str(rng.choice(["lines", "bars", "scatter"]))
        elements = [Element("title", (0.5, 0.95, 13), colours(rng, "#222222"), texts(rng, 3, 5)),
                    Element("text", (0.5, 0.03, 10), colours(rng, "#222222"), texts(rng, 1, 2)),
                    Element("rule", (rng.uniform(0.15, 0.9), rng.integers(2)), colours(rng)),
                    Element("band", (rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.2)), colours(rng), movable=False)]
        for i in range(rng.integers(2, 5)):
            elements.append(self.series(rng, i))
        if self.kind == "bars":
            elements += [Element("bar", (i, rng.uniform(0.2, 0.7), rng.uniform(0, 0.2)), colours(rng)) for i in range(8)]
        elements.append(Element("legend", (rng.uniform(0.14, 0.6), rng.uniform(0.68, 0.74)), colours(rng, "#ffffff"), texts(rng, 1, 2)))
        for _ in range(rng.integers(2, 5)):
            place = (rng.uniform(0.2, 0.75), rng.uniform(0.2, 0.8), rng.choice([8, 9, 11]))
            elements.append(Element(str(rng.choice(["text", "note", "marker"])), place, colours(rng), texts(rng, 1, 3)))
        return elements

    def series(self, rng, i):
        """A curve, or the points of a scatter, that begins and ends inside the axes."""
        x = numpy.linspace(0.12 + 0.05 * i, 0.88 - 0.03 * i, 60)
        waves = [rng.uniform(0.2, 0.8) + rng.uniform(0.05, 0.15) * numpy.sin(rng.uniform(5, 25) * x + rng.uniform(0, 6)) for _ in range(2)]
        if self.kind == "scatter":
            waves = [wave[::2] + rng.normal(0, 0.05, 30) for wave in waves]
            return Element("points", (x[::2],), colours(rng), tuple(waves), subpixel="xy")
        width = float(rng.choice([0.8, 1.5, 2.5]))
        return Element("curve", (x, width, str(rng.choice(["-", "-", "--"]))), colours(rng), tuple(waves), subpixel="xy")

    def draw(self, elements, variant=False):
        style = {"text.hinting": "no_hinting", "text.hinting_factor": 1, "path.snap": True} if variant else {}
        with matplotlib.rc_context(style):
            figure = Figure(figsize=(self.size[0] / 100, self.size[1] / 100), dpi=100)
            canvas = FigureCanvasAgg(figure)
            axes = figure.add_axes([0.1, 0.12, 0.86, 0.78])
            axes.set(xlim=(0, 1), ylim=(0, 1))
            if self.grid:
                axes.grid(color="#dddddd", linewidth=0.8)
            for order, e in enumerate(elements, 3):
                if e.shown:
                    self.add(figure, axes, e, order)
            canvas.draw()
            return numpy.asarray(canvas.buffer_rgba())[..., :3].copy()

    def add(self, figure, axes, e, order):
        colour, moved = e.colours[0], Affine2D().translate(e.dx, -e.dy)
        in_axes = axes.transData + moved
        if e.kind == "title" or e.kind == "text":
            figure.text(*e.place[:2], e.contents[0], size=e.place[2], color=colour, ha="center", zorder=order,
                        transform=figure.transFigure + moved)
        elif e.kind == "rule":
            ends = [(0.02, e.place[0]), (0.98, e.place[0])]
            axes.plot(*zip(*(end[:: 1 - 2 * int(e.place[1])] for end in ends)), color=colour, linewidth=0.72, transform=in_axes, zorder=order)
        elif e.kind == "band":
            axes.axvspan(e.place[0], sum(e.place), color=colour, alpha=0.15, linewidth=0, zorder=0.5)
        elif e.kind == "curve":
            axes.plot(e.place[0], e.contents[0], e.place[2], color=colour, linewidth=e.place[1], transform=in_axes, zorder=order)
        elif e.kind == "points":
            axes.plot(e.place[0], e.contents[0], "o", color=colour, markersize=5, transform=in_axes, zorder=order, snap=False)
        elif e.kind == "bar":
            axes.bar(0.08 + 0.12 * e.place[0], e.place[1], 0.08, color=colour, transform=in_axes, zorder=2)
        elif e.kind == "marker":
            axes.plot(*e.place[:2], "D", color=colour, markersize=float(e.place[2]), transform=in_axes, zorder=order)
        elif e.kind == "note":
            box = {"boxstyle": "round", "facecolor": "white", "edgecolor": colour}
            axes.text(*e.place[:2], e.contents[0], size=e.place[2], color=colour, bbox=box, transform=in_axes, zorder=order)
        else:
            lines = [Line2D([], [], color=of) for of in COLOURS[:2]]
            corner = figure.transFigure.transform(e.place[:2]) + [e.dx, -e.dy]
            axes.legend(lines, [e.contents[0], "reference"], loc="lower left", bbox_to_anchor=numpy.round(corner), borderaxespad=0,
                        bbox_transform=IdentityTransform(), facecolor=colour, framealpha=1, fontsize=9).set_zorder(order)


class Pages:
    """Pages of Chromium. Every element is placed, so that the others stay where one is changed."""
    variants = True
    SIZES = (800, 600), (1024, 700), (640, 800)
    GROUNDS = ("#ffffff", "#f4f6fa", "linear-gradient(135deg,#eef3ff,#ffeede)",
               "repeating-linear-gradient(45deg,#f7f7f7 0 9px,#ececf2 9px 18px)",
               "radial-gradient(circle,#d5dbe6 1px,transparent 1.5px) 0 0/14px 14px")

    def __init__(self, browser, scratch):
        self.file, empty = (os.path.join(scratch, name) for name in ("page.png", "empty.html"))
        with open(empty, "w") as file:
            file.write("<!doctype html>")
        self.page = browser.open(empty)

    def begin(self, rng):
        self.size, self.ground = self.SIZES[rng.integers(len(self.SIZES))], str(rng.choice(self.GROUNDS))
        width, self.elements = self.size[0], []
        bar = self.add("bar", (0, 0, width, 48, 0), colours(rng, "#22304a"), movable=False)
        self.image(rng, (14, 8, 32, 32), bar)
        for i in range(4):
            self.add("text", (70 + 110 * i, 15, 100, 14), colours(rng, "#ffffff"), texts(rng, 1, 1), bar)
        self.button(rng, (width - 110, 9, 90, 30), bar)
        self.add("text", (24, 64, width - 60, 26), colours(rng, "#222222"), texts(rng, 3, 5))
        self.add("text", (24, 100, width - 60, 13), colours(rng, "#555555"), texts(rng, 6, 9))
        self.add("line", (24, 126, width - 48, 1, 0), colours(rng, "#999999"))
        count = width // 250
        for i in range(count):
            self.card(rng, 24 + i * ((width - 48) // count), (width - 48) // count - 16)
        self.table(rng, width - 48)
        self.add("text", (24, self.size[1] - 22, 300, 11), colours(rng, "#777777"), texts(rng, 4, 6))
        return self.elements

    def add(self, kind, place, colours=(), contents=(), parent=-1, **more):
        subpixel = {"line": "", "image": "xy", "disc": "xy"}.get(kind, "x")  # Chromium draws text in whole rows
        self.elements.append(Element(kind, place, colours, contents, parent, subpixel=subpixel, **more))
        return len(self.elements) - 1

    def image(self, rng, place, parent):
        """A disc before a gradient; another disc before another gradient."""
        contents = []
        for form in rng.permutation(["linear-gradient(60deg,{})", "radial-gradient(circle at 30% 30%,{})", "conic-gradient({})"])[:2]:
            stops = ",".join(f"hsl({hue} 70% {30 + 25 * i}%)" for i, hue in enumerate(rng.integers(0, 360, 3)))
            x, y, size = *rng.integers(20, 80, 2), rng.uniform(0.15, 0.4) * place[3]
            disc = f"radial-gradient(circle at {x}% {y}%,hsl({rng.integers(360)} 90% 80%) 0 {size:.1f}px,transparent {size + 1:.1f}px)"
            contents.append(disc + "," + str(form).format(stops))
        return self.add("image", place, ("0deg", "40deg", "120deg", "220deg"), tuple(contents), parent)

    def button(self, rng, place, parent):
        button = self.add("button", (*place, 6), colours(rng), (), parent)
        self.add("text", (12, (place[3] - 15) // 2, place[2], 12), ("#ffffff", "#ffe08a", "#111111"), texts(rng, 1, 1), button)

    def card(self, rng, left, width):
        card = self.add("card", (left, 142, width, 230, 8), ("#ffffff", "#eef2f7", "#fff3d6", "#dff5e6"))
        self.image(rng, (12, 12, width - 24, 80), card)
        self.add("text", (12, 102, width - 24, 16), colours(rng, "#222222"), texts(rng, 1, 2), card)
        self.add("text", (12, 128, width - 24, 12), colours(rng, "#555555"), texts(rng, 6, 9), card)
        self.add("disc", (width - 32, 190, 16, 16), colours(rng), (), card)
        self.button(rng, (12, 186, 96, 30), card)

    def table(self, rng, width):
        top, rows = 396, (self.size[1] - 430) // 28
        table = self.add("table", (24, top, width, 28 * rows, 0), ("#ffffff", "#f3f3f3", "#e8f0ff"), movable=False)
        for row in range(rows):
            self.add("line", (0, 28 * row + 27, width, 1, 0), colours(rng, "#cccccc"), (), table)
            for column in range(4):
                cell = texts(rng, 1, 2) if column < 2 else tuple(f"{rng.uniform(0, 999):.1f}" for _ in range(2))
                self.add("cell", (10 + column * width // 4, 28 * row + 6, width // 4, 13), colours(rng, "#333333"), cell, table)

    def node(self, elements, i):
        e = elements[i]
        left, top, width, height = e.place[:4]
        style = f"left:{left}px;top:{top}px;width:{width}px;"
        if e.kind in ("text", "cell"):
            style += f"font-size:{height}px;color:{e.colours[0]};"
        elif e.kind == "image":
            style += f"height:{height}px;background:{e.contents[0]};filter:hue-rotate({e.colours[0]});"
        else:
            radius = height if e.kind == "disc" else e.place[4]
            style += f"height:{height}px;background:{e.colours[0]};border-radius:{radius}px;"
        if e.kind == "card":
            style += "border:1px solid #d0d5dd;box-sizing:border-box;"
        if (e.dx, e.dy) != (int(e.dx), int(e.dy)):
            style += f"transform:translate({e.dx}px,{e.dy}px);"
        elif e.dx or e.dy:
            style += f"margin:{e.dy}px 0 0 {e.dx}px;"
        inner = html.escape(e.contents[0]) if e.kind in ("text", "cell") else ""
        inner += "".join(self.node(elements, j) for j, child in enumerate(elements) if child.parent == i)
        return f'<div style="{style}">{inner}</div>' if e.shown else ""

    def draw(self, elements, variant=False):
        body = "".join(self.node(elements, i) for i, e in enumerate(elements) if e.parent < 0)
        style = f"<style>body{{margin:0;font-family:sans-serif;background:{self.ground} #fff}}div{{position:absolute}}"
        style += "body{text-rendering:geometricPrecision}</style>" if variant else "</style>"
        self.page.resize(*self.size)
        self.page.run("document.documentElement.innerHTML = $0", "<head>" + style + "</head><body>" + body + "</body>")
        self.page.settle()
        self.page.screenshot(self.file)
        return pixels(self.file)
