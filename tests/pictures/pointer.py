# SPDX-License-Identifier: GPL-3.0-or-later
"""Mouse and fingers on the picture and the plot, on a page of three runs of the stack."""
import math
import re

import numpy

from keys import view
from links import SHARP

CENTRE = """(() => {
  const box = document.getElementById("stage").getBoundingClientRect(), plan = player.plan(box.width, box.height);
  const corners = player.corners(plan, player.camera(plan, $1), $0, plan.panels[$0].run, $1, $2);
  const mean = axis => corners.reduce((sum, corner) => sum + corner[axis], 0) / 4;
  return [box.left + mean("x"), box.top + mean("y")];
})()"""
CURVES = "document.querySelectorAll('#plot > path').length"
HIT = """(([x, y]) => {
  const box = document.getElementById("stage").getBoundingClientRect(), plan = player.plan(box.width, box.height);
  const hit = player.body_at(plan, player.camera(plan, 16), 16, x - box.left, y - box.top);
  return hit && [hit.run, hit.body];
})($0)"""
SCALE = """(() => { const box = document.getElementById("stage").getBoundingClientRect();
  return player.camera(player.plan(box.width, box.height), player.view.frame).scale; })()"""


def check_mouse(checks, page, last):
    page.run("player.change({frame: 16, body: -1, compare: 'split', camera: {kind: 'fit'}})")
    page.settle()
    for panel, body in (0, 3), (2, 11):
        page.run("player.change({body: -1})")
        page.point(*page.run(CENTRE, panel, 16, body))
        measured = page.run("document.getElementById('body').parentNode.textContent")
        checks.true(f"pointing at body {body} measures it", re.search(rf"Body {body}\b", measured), measured[:200])
        hit = page.run(HIT, page.run(CENTRE, panel, 16, body))
        checks.equal(f"what is at body {body} of panel {panel}", hit, [panel, body])
        page.click(*page.run(CENTRE, panel, 16, body))
        checks.equal(f"a click pins body {body}", view(page)["body"], body)
    curves = page.run(CURVES)
    page.run("player.change({body: -1})")
    page.settle()
    checks.equal("curves of the pinned body", curves - page.run(CURVES), page.run("player.runs.length") - 1)
    page.run("player.change({body: 11})")
    page.settle()
    start, scale = page.run(CENTRE, 0, 16, 3), page.run(SCALE)
    apart = numpy.subtract(page.run(CENTRE, 2, 16, 3), start)
    page.drag([start, (start[0] + 20, start[1] + 5), (start[0] + 60, start[1] + 40)])
    checks.equal("dragging frees the camera", view(page)["camera"]["kind"], "free")
    gap = numpy.subtract(page.run(CENTRE, 2, 16, 3), page.run(CENTRE, 0, 16, 3))
    checks.true("all panels move together", math.dist(gap, apart) < 0.01, (gap, apart))
    checks.true("the picture follows the mouse", math.dist(page.run(CENTRE, 0, 16, 3),
                                                           (start[0] + 60, start[1] + 40)) < 3)
    checks.equal("dragging pins nothing else", view(page)["body"], 11)
    at = page.run(CENTRE, 0, 16, 3)
    page.wheel(*at, -200)
    checks.true("the wheel zooms in", page.run(SCALE) > 1.1 * scale, page.run(SCALE))
    checks.true("about the pointer", math.dist(page.run(CENTRE, 0, 16, 3), at) < 3, page.run(CENTRE, 0, 16, 3))
    page.click(*at, count=1)
    page.click(*at, count=2)
    checks.equal("a double click fits", view(page)["camera"]["kind"], "fit")
    for share in 0.25, 0.75:
        x, y, width, height = page.run("(b => [b.x, b.y, b.width, b.height])"
                                       "(document.getElementById('plot').getBoundingClientRect())")
        page.click(x + share * width, y + height / 2)
        checks.near(f"a click into the plot at {share}", view(page)["frame"], share * last, 0.1 * last)


def check_touch(checks, browser):
    page = browser.open("three.html", width=390, height=844, density=3, touch=True)
    page.run("player.change({frame: 16})")
    page.middle("#stage")
    page.settle()
    checks.true("a sharp picture", page.run(SHARP))
    place = page.run(CENTRE, 0, 16, 5)
    page.touch([place])
    checks.equal("a tap pins", view(page)["body"], 5)
    scale = page.run(SCALE)
    page.touch([place], [(place[0] + 10, place[1])], [(place[0] + 30, place[1] + 12)])
    checks.equal("a finger moves the view", view(page)["camera"]["kind"], "free")
    checks.true("by as much as the finger", math.dist(page.run(CENTRE, 0, 16, 5), (place[0] + 30, place[1] + 12)) < 4)
    x, y = page.middle("#stage")
    page.touch(*([(x - spread, y), (x + spread, y)] for spread in (30, 40, 50, 60)))
    checks.near("two fingers zoom", page.run(SCALE) / scale, 2, 0.4)
    checks.quiet("touch", page)
    page.close()
