# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of an HTML page, and what they show."""
import html.parser
import os
import re
import urllib.parse

import player_page


class Links(html.parser.HTMLParser):
    """The targets of all links, in order; strict about what is open."""

    def __init__(self, path):
        super().__init__()
        self.targets = []
        self.feed(open(path).read())

    def handle_starttag(self, tag, attributes):
        if tag == "script":
            raise AssertionError("a script")
        if tag == "a":
            self.targets.append(dict(attributes)["href"])


def parts(target):
    """The file and the words of a link."""
    path, fragment = target.split("#")
    return path, {key: values[0] for key, values in urllib.parse.parse_qs(fragment, keep_blank_values=True).items()}


def moment(target):
    """NAME.html, seconds, body (-1: none) of a link."""
    path, t, body, _ = re.fullmatch(r"([^#]+)#t=([0-9.e+-]+)(?:&body=(\d+))?(&run=\d+)?", target).groups()
    return path, float(t), -1 if body is None else int(body)


def check_shown(folder, target):
    """The page is there and shows the moment; its data."""
    path, time, body = moment(target)
    page = player_page.data(os.path.join(folder, path))
    frame = round(time / page["dt"]) - page["first"]
    assert 0 <= frame < page["frames"] * page["every"], (target, page["first"], page["frames"])
    assert -1 <= body < page["runs"][-1]["bodies"], target
    return page
