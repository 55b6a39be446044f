# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Firefox with one tab, driven by Marionette: "LENGTH:[0, number, command, parameters]" over a local
connection. Every address but local files leads to a proxy that does not exist."""
import base64
import json
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time

LIMIT = 120  # s
PREFERENCES = {"marionette.port": 0, "network.proxy.type": 1, "network.proxy.http": "127.0.0.1",
               "network.proxy.http_port": 9,
               "network.proxy.ssl": "127.0.0.1", "network.proxy.ssl_port": 9, "app.update.enabled": False,
               "browser.shell.checkDefaultBrowser": False, "datareporting.policy.dataSubmissionEnabled": False,
               "browser.aboutwelcome.enabled": False, "toolkit.telemetry.enabled": False}


class FirefoxError(Exception):
    pass


def program():
    return shutil.which("firefox-esr") or shutil.which("firefox")


class Firefox:
    def __init__(self, width=1440, height=900):
        self.folder = tempfile.mkdtemp(prefix="firefox-")
        self.profile = os.path.join(self.folder, "profile")
        os.mkdir(self.profile)
        with open(os.path.join(self.profile, "user.js"), "w") as file:
            for name, value in PREFERENCES.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        self.process, self.connection, self.rest, self.last = None, None, b"", 0
        try:
            self.start(width, height)
        except BaseException:
            self.__exit__()
            raise

    def start(self, width, height):
        with open(os.path.join(self.folder, "errors"), "wb") as errors:
            self.process = subprocess.Popen(
                [program(), "--headless", "--marionette", "--no-remote", "--profile", self.profile, f"--width={width}",
                 f"--height={height}", "about:blank"],
                stdin=subprocess.DEVNULL, stdout=errors, stderr=errors, start_new_session=True,
                env={**os.environ, "HOME": self.folder, "MOZ_CRASHREPORTER_DISABLE": "1"})
        end = time.monotonic() + LIMIT
        while self.connection is None:
            try:
                with open(os.path.join(self.profile, "MarionetteActivePort")) as file:
                    self.connection = socket.create_connection(("127.0.0.1", int(file.read())), LIMIT)
            except (OSError, ValueError):
                if time.monotonic() > end or self.process.poll() is not None:
                    with open(os.path.join(self.folder, "errors"), errors="replace") as errors:
                        raise FirefoxError("Firefox does not start\n" + errors.read()[-2000:]) from None
                time.sleep(0.05)
        self.receive()  # its greeting
        self.version = self.call("WebDriver:NewSession")["capabilities"]["browserVersion"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.connection is not None:
            self.connection.close()
        if self.process is not None:
            try:
                os.killpg(self.process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def receive(self):
        while b":" not in self.rest:
            self.more()
        length, _, self.rest = self.rest.partition(b":")
        while len(self.rest) < int(length):
            self.more()
        message, self.rest = self.rest[:int(length)], self.rest[int(length):]
        return json.loads(message)

    def more(self):
        data = self.connection.recv(1 << 20)
        if not data:
            raise FirefoxError("Firefox has ended")
        self.rest += data

    def call(self, command, **parameters):
        self.last += 1
        text = json.dumps([0, self.last, command, parameters]).encode()
        self.connection.sendall(b"%d:%s" % (len(text), text))
        while True:
            kind, number, error, result = self.receive()
            if kind == 1 and number == self.last:
                if error is not None:
                    raise FirefoxError(f"{command}: {error['message']}")
                return result

    def open(self, path, fragment=""):
        """The page, in the only tab: it has what scripts need of a Page of Chromium."""
        self.call("WebDriver:Navigate", url="file://" + os.path.abspath(path) + (fragment and "#" + fragment))
        self.wait("window.player?.data !== undefined")  # the page unpacks its script
        return self

    def close(self):
        """The next page takes its place."""

    def run(self, script, *values):
        """What the expression is, or will be if it is a promise. $0, $1, ... stand for values."""
        for i, value in reversed(list(enumerate(values))):
            script = script.replace(f"${i}", json.dumps(value))
        script = ("const done = arguments[arguments.length - 1];"
                  f"(async () => ({script}))().then(value => done({{value}}), error => done({{error: String(error)}}))")
        answer = self.call("WebDriver:ExecuteAsyncScript", args=[], scriptTimeout=LIMIT * 1000, script=script)["value"]
        if "error" in answer:
            raise FirefoxError(answer["error"])
        return answer.get("value")

    def wait(self, script):
        end = time.monotonic() + LIMIT
        while not (found := self.run(script)):
            if time.monotonic() > end:
                raise FirefoxError(f"in {LIMIT} s it did not become true: {script[:200]}")
            time.sleep(0.02)
        return found

    def settle(self):
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def mouse(self, kind, x, y, **_):
        """As in Chromium: mouseMoved, mousePressed, mouseReleased; the left button, which stays as it is between calls."""
        button = {"mousePressed": "pointerDown", "mouseReleased": "pointerUp"}.get(kind)
        actions = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0}]
        actions += [{"type": button, "button": 0}] if button else []
        self.call("WebDriver:PerformActions", actions=[{"type": "pointer", "id": "mouse", "actions": actions}])

    def press(self, key):
        actions = [{"type": kind, "value": key} for kind in ("keyDown", "keyUp")]
        self.call("WebDriver:PerformActions", actions=[{"type": "key", "id": "keys", "actions": actions}])

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"]))
