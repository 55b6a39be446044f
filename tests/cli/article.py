# SPDX-License-Identifier: GPL-3.0-or-later
"""The article in Chromium: article.py SITE. Nothing is off-screen (on a phone tables and charts scroll). Where a page takes the place of
a still, panels do not shrink. What the page answers to a prediction is what the text says."""
import os
import re
import sys

from chromium import Chromium

SCREENS = (1440, 900), (1280, 720), (390, 844)
# Each still's size, and that of the page which takes its place.
TRY = """[...document.querySelectorAll('.live')].map(figure => {
    const still = figure.querySelector('img'), width = still.getBoundingClientRect().width;
    const size = [still.getAttribute('width'), still.getAttribute('height')].map(Number);
    figure.querySelector('.play').click();
    const frame = figure.querySelector('iframe'), place = frame.getBoundingClientRect();
    return {name: figure.dataset.title, page: frame.src.split('/').at(-1), shrunk: width / size[0], size, left: place.left,
            width: frame.clientWidth, height: frame.clientHeight};
})"""
# Pixels in a metre, of the page's stage and of a still.
SCALES = """(stage => [[stage.clientWidth, stage.clientHeight], $0].map(size => player.plan(...size).fit.scale))
    (document.querySelector('#stage'))"""
NUMBERS = ["none", "one", "two", "three", "four"]


def check_panels(browser, site, width, height):
    page = browser.open(f"{site}/index.html", width=width, height=height, touch=width < 500)
    beyond = page.beyond() if width >= 1280 else page.run("document.documentElement.scrollWidth > innerWidth")
    assert not beyond, (width, beyond)
    figures = page.run(TRY)
    page.close()
    assert len(figures) >= 7
    for figure in figures:
        assert figure["left"] >= 0 and figure["left"] + figure["width"] <= width, figure
        path, _, fragment = figure["page"].partition("#")
        page = browser.open(f"{site}/{path}", fragment, width=figure["width"], height=figure["height"], touch=width < 500)
        page.wait("window.player?.data")
        page.settle()
        live, still = page.run(SCALES, figure["size"])
        page.close()
        # Scales are rounded down to whole pixels.
        assert live >= int(still * figure["shrunk"]), (width, figure, live, still * figure["shrunk"])


def check_prediction(browser, site):
    """Whichever panel is chosen, its run ends in the words of its verdict, and as many stand as the text says."""
    text = open(f"{site}/index.html", encoding="utf-8").read()
    address = re.search(r'href="(predict\.html#[^"]+)"', text)[1].replace("&amp;", "&")
    path, _, fragment = address.partition("#")
    stand, panels = 0, 1
    panel = 0
    while panel < panels:
        page = browser.open(f"{site}/{path}", fragment)
        page.wait("window.player?.runs.every(run => run.hash)")
        panels = page.run("player.runs.length")
        panel += 1
        page.press(str(panel))
        name, said = re.fullmatch(r"You said (\S+)\. It (\w+)\b.*", page.run("document.querySelector('#question').textContent")).groups()
        assert name == page.run(f"player.runs[{panel - 1}].name") and said in ("stands", "falls", "collapses"), (name, said)
        stand += said == "stands"
        page.close()
    assert f"{NUMBERS[panels - stand].capitalize()} fall and {NUMBERS[stand]} stand." in text, (stand, panels)


with Chromium() as browser:
    for screen in SCREENS:
        check_panels(browser, os.path.abspath(sys.argv[1]), *screen)
    check_prediction(browser, os.path.abspath(sys.argv[1]))
