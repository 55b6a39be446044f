# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Chromium for tests, and the tabs in it. Python's standard library only.

    with Chromium("!!window.player?.data") as browser:
        page = browser.open("stack.html", width=390, dark=True)
        page.press("Space")
        page.wait("player.view.playing")

It is driven by the DevTools protocol over two pipes (--remote-debugging-pipe): JSON messages, each ended by a zero byte.
The browser ends when the pipes close, so it does not outlive a test that is killed. Every wait is for a condition and has
a limit that only a hanging browser reaches."""
import collections
import fcntl
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

from page import Page

LIMIT = 120  # s, for any answer
OPTIONS = """--headless --no-sandbox --disable-gpu --disable-dev-shm-usage --remote-debugging-pipe --no-first-run
    --disable-background-networking --disable-component-update --disable-default-apps --disable-extensions --disable-sync
    --disable-breakpad --disable-background-timer-throttling --disable-renderer-backgrounding --mute-audio
    --disable-backgrounding-occluded-windows --force-color-profile=srgb --password-store=basic""".split()


class BrowserError(Exception):
    pass


def installed():
    return shutil.which("chromium") is not None


class Chromium:
    def __init__(self, ready="true"):
        """ready: a script that is true in a page that has begun."""
        self.ready = ready
        self.profile = tempfile.mkdtemp(prefix="chromium-")
        self.errors = os.path.join(self.profile, "errors")
        self.pages, self.answers, self.parts, self.last = {}, {}, [], 0
        self.messages = collections.deque()
        self.start()

    def start(self):
        """Chromium reads commands from descriptor 3 and writes to 4."""
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        # Away from 3 and 4, so that bash can put them there in any order.
        theirs = [fcntl.fcntl(end, fcntl.F_DUPFD, 20) for end in (theirs_in, theirs_out)]
        script = f'exec "$@" 3<&{theirs[0]} 4>&{theirs[1]} {theirs[0]}<&- {theirs[1]}>&-'
        with open(self.errors, "wb") as errors:
            self.process = subprocess.Popen(
                ["bash", "-c", script, "bash", "chromium", *OPTIONS, "--user-data-dir=" + self.profile],
                pass_fds=theirs, stdin=subprocess.DEVNULL, stdout=errors, stderr=errors,
                start_new_session=True)
        for end in (theirs_in, theirs_out, *theirs):
            os.close(end)
        self.input, self.output = ours_in, ours_out

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """The pipes first, so that nothing is written into a profile that is being removed."""
        os.close(self.output)
        os.close(self.input)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            pass
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)

    def fail(self, what):
        with open(self.errors, errors="replace") as errors:
            said = [line for line in errors if "dbus/" not in line]  # which no container has
            raise BrowserError("".join([what, "\n", *said[-20:]]))

    def call(self, method, session=None, limit=LIMIT, **parameters):
        """The result of a command. Events that come before it reach their pages."""
        self.last += 1
        number, message = self.last, {"id": self.last, "method": method, "params": parameters}
        if session is not None:
            message["sessionId"] = session
        self.write(json.dumps(message).encode() + b"\0", limit)
        end = time.monotonic() + limit
        while number not in self.answers:
            self.hear(method, end)
        answer = self.answers.pop(number)
        if "error" in answer:
            raise BrowserError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def write(self, data, limit):
        end = time.monotonic() + limit
        while data:
            # A large command must not wait for a browser that waits for its reader.
            readable, writable, _ = select.select([self.input], [self.output], [], max(0, end - time.monotonic()))
            if readable:
                self.read()
            elif writable:
                data = data[os.write(self.output, data[:4096]):]
            else:
                self.fail("Chromium does not read its commands")

    def read(self):
        data = os.read(self.input, 1 << 20)
        if not data:
            self.fail("Chromium has ended")
        *ended, rest = data.split(b"\0")
        for piece in ended:
            self.messages.append(json.loads(b"".join([*self.parts, piece])))
            self.parts = []
        self.parts.append(rest)

    def hear(self, what, end):
        """Takes one message, from a page or as an answer."""
        while not self.messages:
            if not select.select([self.input], [], [], max(0, end - time.monotonic()))[0]:
                self.fail(f"Chromium does not answer: {what}")
            self.read()
        message = self.messages.popleft()
        if "id" in message:
            self.answers[message["id"]] = message
        elif message.get("sessionId") in self.pages:
            self.pages[message["sessionId"]].hear(message["method"], message["params"])

    def until(self, condition, what, limit=LIMIT):
        """Waits for what the browser does outside of a page, such as a file."""
        end = time.monotonic() + limit
        while not (found := condition()):
            if time.monotonic() > end:
                self.fail(f"waited in vain for {what}")
            time.sleep(0.02)
        return found

    def open(self, path, fragment="", **looks):
        """A new tab with this file, and what follows # in its address, loaded; see Page."""
        target = self.call("Target.createTarget", url="about:blank", newWindow=True)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = self.pages[session] = Page(self, target, session, **looks)
        page.load(path, fragment)
        return page

    def allow(self, *permissions):
        """Clipboard and the like, for all pages."""
        self.call("Browser.grantPermissions", permissions=list(permissions))
