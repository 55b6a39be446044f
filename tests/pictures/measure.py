# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that the page shows for a body, beside those that NumPy finds in the runs."""
import collections
import re

import numpy

ROWS = """[...document.querySelectorAll("#body tr")].map(row => [...row.cells].map(cell => cell.textContent.trim()))"""
UNITS = {"µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3}


def shown(page):
    """The rows of the tables in #body, by their first cell."""
    return {cells[0]: cells[1:] for cells in page.run(ROWS) if cells}


def number(text):
    """"−0.0312", "12.3 mm", "1.2e−7 m/s"; NaN for a dash."""
    text = text.replace("\u2212", "-")
    match = re.match(r"(-?[\d.]+(?:e[-+]?\d+)?)(?:\s*([µmk]?)(?:m/s|m))?$", text)
    return float(match[1]) * UNITS[match[2] or ""] if match else float("nan")


def row(rows, start):
    return next((cells for name, cells in rows.items() if name.startswith(start)), None)


def state(run, frame):
    """Positions and angles, interpolated between stored frames; velocities and spins of the stored frame before."""
    low, part = int(frame), frame - int(frame)
    poses = [(1 - part) * run[name][low] + part * run[name][min(low + 1, len(run["angle"]) - 1)].astype(float)
             for name in ("position", "angle")]
    return [*poses, run["velocity"][low], run["angular_velocity"][low]]


def impulses(run, frame, body):
    """Normal and tangential impulse of the next step (after the last frame: of the last), summed for each other body."""
    step, found = min(int(frame) + 1, len(run["angle"]) - 1), collections.defaultdict(lambda: numpy.zeros(2))
    for contact in range(*run["contact_start"][step:step + 2]):
        pair = list(run["contact_bodies"][contact])
        if body in pair:
            found[pair[1 - pair.index(body)]] += run["contact_impulse"][contact]
    return found


class Measured:
    def __init__(self, checks, page, loaded, names):
        self.checks, self.page, self.loaded, self.names = checks, page, loaded, names

    def most_friction(self):
        """Run 0, and the frame and body with the largest tangential impulse beside its normal one."""
        run = self.loaded[0]
        normal, tangent = run["contact_impulse"][:, 0], numpy.abs(run["contact_impulse"][:, 1])
        contact = int((tangent / (0.1 + normal)).argmax())
        frame = int(numpy.searchsorted(run["contact_start"], contact, side="right")) - 2
        return 0, frame, int(run["contact_bodies"][contact, 1])

    def numbers(self, what, cells, wanted, at_most=0.51e-4, relative=0.0):
        if self.checks.true(f"{what}: shown", cells is not None):
            for found, exact in zip(cells, wanted):
                self.checks.near(what, number(found), exact, at_most + relative * abs(exact))

    def check(self, run, frame, body):
        self.page.run("player.change({run: $0, frame: $1, body: $2})", run, frame, body)
        self.page.settle()
        rows, what = shown(self.page), f"run {run} frame {frame} body {body}"
        at, angle, speed, spin = (value[body] for value in state(self.loaded[run], frame))
        self.numbers(f"{what}: position", row(rows, "position"), at)
        self.numbers(f"{what}: velocity", row(rows, "velocity,"), speed)
        self.numbers(f"{what}: angle", row(rows, "angle")[:1], [angle])
        self.numbers(f"{what}: angle in degrees", row(rows, "angle")[1:], [numpy.degrees(angle)], 0.51e-2)
        self.numbers(f"{what}: spin", [cell for cell in row(rows, "spin") if cell], [spin])
        self.contacts(what, rows, impulses(self.loaded[run], frame, body))
        for other, name in enumerate(self.names):
            if other == run:
                continue
            far, _, fast, _ = (value[body] for value in state(self.loaded[other], frame))
            wanted = numpy.hypot(*(far - at)), numpy.hypot(*(fast - speed))
            self.numbers(f"{what}: beside {name}", row(rows, name), wanted, 1e-9, 0.006)

    def curves(self, frame, body):
        """The values at the plot's curves: of a body, or (-1) the largest distance of any."""
        self.page.run("player.change({frame: $0, body: $1})", frame, body)
        self.page.settle()
        found = self.page.run("[...document.querySelectorAll('#key data')].map(value => value.textContent)")
        first = self.loaded[0]["position"][frame].astype(float)
        for name, other, text in zip(self.names[1:], self.loaded[1:], found, strict=True):
            apart = numpy.hypot(*(other["position"][frame] - first).T)
            wanted = apart[body] if body >= 0 else numpy.nanmax(apart)
            self.checks.near(f"frame {frame} body {body}: the curve of {name}", number(text), wanted, 1e-9 + 0.006 * wanted)

    def times(self):
        """The times below the plot stand where its cursor is at their frames."""
        ends = []
        for frame in 0, len(self.loaded[0]["angle"]) - 1:
            self.page.run("player.change({frame: $0})", frame)
            self.page.settle()
            at = self.page.run("document.querySelector('#plot > g').getAttribute('transform')")
            ends.append((frame * float(self.loaded[0]["dt"]), number(at.removeprefix("translate(").removesuffix(")"))))
        labels = self.page.run("[...document.querySelectorAll('#plot text')].filter(({textContent}) => "
                               "/^[\\d.]+ s$/.test(textContent)).map(text => [text.textContent, text.getAttribute('x')])")
        self.checks.true("the plot has times", len(labels) > 2)
        for text, x in labels:
            wanted = numpy.interp(number(text.removesuffix(" s")), *zip(*ends))
            self.checks.near(f"where the plot has {text}", float(x), wanted, 0.01)

    def contacts(self, what, rows, wanted):
        found = {int(name.split()[-1]): [number(cell) for cell in cells] for name,
                 cells in rows.items() if re.match(r"body \d+$", name)}
        self.checks.equal(f"{what}: bodies in contact", sorted(found), sorted(wanted))
        for other in found.keys() & wanted.keys():
            normal, tangent = wanted[other]
            # Stored rounded (src/pictures/player_pack.c).
            self.checks.near(f"{what}: normal impulse with body {other}", found[other][0], normal,
                             1e-3 + 0.016 * normal)
            self.checks.near(f"{what}: tangent impulse with body {other}", found[other][1], tangent, 1e-3 + normal / 64)
