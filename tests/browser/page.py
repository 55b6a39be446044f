# SPDX-License-Identifier: GPL-3.0-or-later
"""A tab of Chromium: looks, scripts, keys, mouse, fingers, pictures. It is offline, and counts what it would fetch."""
import base64
import json
import os
import time
import urllib.parse

import keyboard

LIMIT = 120  # s, for a condition
# Time that passes only by page.tick(), for what is drawn and how fast: a busy machine changes nothing.
CLOCK = """{
  const due = new Map();
  let now = 1000, last = 0;
  performance.now = () => now;
  window.requestAnimationFrame = call => { due.set(++last, call); return last; };
  window.cancelAnimationFrame = number => due.delete(number);
  window.tick = step => {
    now += step;
    const calls = [...due.values()];
    due.clear();
    for (const call of calls) call(now);
  };
}"""


class ScriptError(Exception):
    pass


class Page:
    """messages: what the console says, exceptions, dialogs. requests: addresses, but for its own, blob: and data:."""

    def __init__(self, browser, target, session, width=1440, height=900, density=1, dark=False, still=False,
                 touch=False, before="", clock=False):
        """still: prefers-reduced-motion; touch: a finger instead of a mouse; before: a script that runs before the page's;
        clock: time stands still but for tick()."""
        self.browser, self.target, self.session = browser, target, session
        self.messages, self.requests, self.loaded, self.address = [], [], False, None
        self.clock = clock
        for domain in "Page", "Runtime", "Network", "Log", "Inspector":
            self.call(domain + ".enable")
        self.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=-1,
                  uploadThroughput=-1)
        self.call("Emulation.setFocusEmulationEnabled", enabled=True)
        self.resize(width, height, density, touch)
        self.prefer(dark, still)
        if clock or before:
            self.call("Page.addScriptToEvaluateOnNewDocument", source=CLOCK * clock + before)

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def hear(self, method, event):
        if method == "Runtime.consoleAPICalled":
            words = [str(part.get("value", part.get("description", part["type"]))) for part in event["args"]]
            self.messages.append(f"console.{event['type']}: {' '.join(words)}")
        elif method == "Runtime.exceptionThrown":
            details = event["exceptionDetails"]
            self.messages.append("exception: " + details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded":
            self.messages.append(f"log: {event['entry']['text']} {event['entry'].get('url', '')}")
        elif method == "Page.javascriptDialogOpening":
            self.messages.append("dialog: " + event["message"])
            self.call("Page.handleJavaScriptDialog", accept=False)
        elif method == "Network.requestWillBeSent":
            address = event["request"]["url"]
            if address.partition("#")[0] != self.address and not address.startswith(("blob:", "data:")):
                self.requests.append(address)
        elif method == "Inspector.targetCrashed":
            raise ScriptError(f"the tab of {self.address} has crashed")
        elif method == "Page.loadEventFired":
            self.loaded = True

    def load(self, path, fragment=""):
        self.address = "file://" + urllib.parse.quote(os.path.abspath(path))
        self.loaded = False
        self.call("Page.navigate", url="about:blank")
        self.until(lambda: self.loaded, "the empty page")
        self.loaded = False
        answer = self.call("Page.navigate", url=self.address + (fragment and "#" + fragment))
        if "errorText" in answer:
            raise ScriptError(f"{path}: {answer['errorText']}")
        self.until(lambda: self.loaded, f"{path} is loaded")
        self.wait(self.browser.ready)

    def until(self, condition, what, limit=LIMIT):
        """Hears events until one makes the condition true."""
        end = time.monotonic() + limit
        while not condition():
            self.browser.hear(what, end)

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)
        del self.browser.pages[self.session]

    # Looks

    def resize(self, width, height, density=1, touch=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=density,
                  mobile=touch)
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch, maxTouchPoints=5)

    def prefer(self, dark, still):
        features = {"prefers-color-scheme": "dark" if dark else "light",
                    "prefers-reduced-motion": "reduce" if still else "no-preference"}
        self.call("Emulation.setEmulatedMedia", features=[{"name": k, "value": v} for k, v in features.items()])

    def screenshot(self, path, whole=False):
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def beyond(self):
        """The elements that end to the right of the window, also those that can be scrolled into it."""
        return self.run("""[...document.querySelectorAll('body *')]
            .filter(each => each.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
            .map(each => `${each.tagName} ${each.className} ${each.textContent.slice(0, 40)}`)""")

    # Scripts

    def run(self, script, *values):
        """What the script's expression is, or will be if it is a promise. $0, $1, ... stand for values."""
        for i, value in reversed(list(enumerate(values))):
            script = script.replace(f"${i}", json.dumps(value))
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True,
                           userGesture=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise ScriptError(f"{script[:200]}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def wait(self, script, *values, limit=LIMIT):
        """Waits until the expression is true, and returns it."""
        end = time.monotonic() + limit
        while True:
            found = self.run(script, *values)
            if found:
                return found
            if time.monotonic() > end:
                raise ScriptError(f"in {limit} s it did not become true: {script[:200]}")
            time.sleep(0.01)

    def settle(self):
        """Waits until what was changed is drawn: two frames of the browser. With a clock of its own, in no time."""
        if self.clock:
            self.tick(0)
            return
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def tick(self, seconds, frames=1):
        """Lets time pass, and the browser draw so many frames in it."""
        self.run("{ for (let i = 0; i < $0; i++) tick($1); }", frames, 1000 * seconds / frames)

    # Keys

    def press(self, *names):
        """Keys in turn, by the names of KeyboardEvent.key, with "Shift+" and the like before them."""
        for name in names:
            for event in keyboard.events(name):
                self.call("Input.dispatchKeyEvent", **event)
        self.settle()

    # Mouse and fingers: pixels of CSS in the window

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def point(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.settle()

    def click(self, x, y, count=1):
        self.mouse("mouseMoved", x, y)
        for kind in "mousePressed", "mouseReleased":
            self.mouse(kind, x, y, button="left", clickCount=count)
        self.settle()

    def drag(self, points):
        self.mouse("mouseMoved", *points[0])
        self.mouse("mousePressed", *points[0], button="left", clickCount=1)
        for x, y in points[1:]:
            self.mouse("mouseMoved", x, y, button="left", buttons=1)
        self.mouse("mouseReleased", *points[-1], button="left", clickCount=1)
        self.settle()

    def wheel(self, x, y, turn):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=turn)
        self.settle()

    def touch(self, *steps):
        """Fingers down at the places of the first step, moved through the others, and up."""
        for i, places in enumerate(steps):
            points = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(places)]
            self.call("Input.dispatchTouchEvent", type="touchStart" if i == 0 else "touchMove", touchPoints=points)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.settle()

    def middle(self, selector):
        """The middle of an element, scrolled into view."""
        found = self.run("(e => { if (e === null) return null; e.scrollIntoView({block: 'nearest'}); const b ="
                         " e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })"
                         "(document.querySelector($0))", selector)
        if found is None:
            raise ScriptError(f"the page has no {selector}")
        return found
