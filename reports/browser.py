"""A headless Chromium, driven over the DevTools protocol with what Python brings."""

import base64
import contextlib
import json
import os
import shutil
import signal
import socket
import subprocess
import tempfile
from pathlib import Path

PROGRAM = os.environ.get("SLIPSTICK_CHROMIUM") or shutil.which("chromium-headless-shell") or shutil.which("chromium")
MISSING = "no Chromium was found: install chromium-headless-shell or chromium, or set SLIPSTICK_CHROMIUM to its path"
PATIENCE = 300.0  # seconds for an answer: for what hangs, not for busy machines
GRACE = 10.0  # seconds to end by itself
FLAGS = ("--headless", "--remote-debugging-pipe", "--no-first-run", "--disable-gpu", "--in-process-gpu",
         "--disable-extensions", "--disable-sync", "--disable-background-networking", "--disable-component-update",
         "--disable-default-apps", "--disable-breakpad", "--disable-dev-shm-usage", "--mute-audio")
A4 = (210 / 25.4, 297 / 25.4)  # inches
KEYS = {"Enter": (13, "\r"), "Space": (32, " "), "Tab": (9, "")}


class BrowserError(RuntimeError):
    """What the browser or the page answered instead of a value."""


class Browser:
    """One page. `requests` and `errors` hold what it asked for and complained of since it was opened last."""

    def __init__(self, program=PROGRAM):
        self.program, self.number, self.session = program, 0, None
        self.process = None
        self.received, self.loaded, self.requests, self.errors = b"", set(), [], []

    def __enter__(self):
        if not self.program:
            raise BrowserError(MISSING)
        self.profile = tempfile.TemporaryDirectory(prefix="slipstick-browser-", ignore_cleanup_errors=True)
        self.pipe, inner = socket.socketpair()
        self.pipe.settimeout(PATIENCE)
        self.words = open(Path(self.profile.name) / "words", "w+b")  # what it prints
        flags = [*FLAGS, f"--user-data-dir={self.profile.name}", *(["--no-sandbox"] if os.geteuid() == 0 else [])]
        try:
            # It reads from descriptor 3, writes to 4, and ends by itself where this program is killed.
            self.process = subprocess.Popen(
                ["sh", "-c", f'exec "$@" 3<&{inner.fileno()} 4>&{inner.fileno()}', "sh", self.program, *flags],
                stdin=subprocess.DEVNULL, stdout=self.words, stderr=self.words, pass_fds=[inner.fileno()],
                start_new_session=True, env={**os.environ, "TMPDIR": self.profile.name})
            inner.close()
            target = self.call("Target.createTarget", url="about:blank")["targetId"]
            self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
            for domain in ("Page", "Runtime", "Log", "Network"):
                self.call(f"{domain}.enable")
            self.call("Page.setLifecycleEventsEnabled", enabled=True)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.pipe.close()  # upon which it ends and takes its own processes along
        try:
            if self.process:
                self.process.wait(GRACE)
        except subprocess.TimeoutExpired:
            pass
        finally:
            if self.process:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()
            self.words.close()
            self.profile.cleanup()

    def silent(self):
        self.words.seek(0)
        return BrowserError(f"{self.program} does not answer; it said:\n"
                            + self.words.read().decode(errors="replace")[-2000:])

    def read(self):
        """The next message."""
        while b"\0" not in self.received:
            try:
                more = self.pipe.recv(1 << 20)
            except OSError:
                more = b""
            if not more:
                raise self.silent()
            self.received += more
        message, _, self.received = self.received.partition(b"\0")
        return json.loads(message)

    def note(self, event):
        """Keeps what an event says of the page."""
        kind, values = event.get("method"), event.get("params", {})
        if kind == "Page.lifecycleEvent" and values["name"] == "load":
            self.loaded.add(values["loaderId"])
        elif kind == "Network.requestWillBeSent":
            self.requests.append(values["request"]["url"])
        elif kind == "Runtime.exceptionThrown":
            details = values["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif kind == "Runtime.consoleAPICalled" and values["type"] in ("error", "warning", "assert"):
            self.errors.append(" ".join(str(each.get("value", each.get("description"))) for each in values["args"]))
        elif kind == "Log.entryAdded" and values["entry"]["level"] in ("error", "warning"):
            self.errors.append(f"{values['entry']['text']} {values['entry'].get('url', '')}".strip())

    def call(self, method, **values):
        """Result of a method of the protocol."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": values}
        if self.session:
            message["sessionId"] = self.session
        try:
            self.pipe.sendall(json.dumps(message).encode() + b"\0")
        except OSError:
            raise self.silent() from None
        while (answer := self.read()).get("id") != self.number:
            self.note(answer)
        if "error" in answer:
            raise BrowserError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def open(self, file):
        """Opens a file and waits until it and what it asks for are there."""
        self.go("about:blank")
        self.requests, self.errors = [], []
        self.go(Path(file).resolve().as_uri())

    def go(self, address):
        answer = self.call("Page.navigate", url=address)
        if "errorText" in answer:
            raise BrowserError(f"{address}: {answer['errorText']}")
        while answer["loaderId"] not in self.loaded:
            self.note(self.read())

    def width(self, pixels, height=900):
        self.call("Emulation.setDeviceMetricsOverride", width=pixels, height=height, deviceScaleFactor=1, mobile=False)

    def media(self, kind="screen", scheme="light"):
        """kind: screen or print; scheme: light or dark."""
        self.call("Emulation.setEmulatedMedia", media=kind,
                  features=[{"name": "prefers-color-scheme", "value": scheme}])

    def evaluate(self, script):
        """The value of an expression, of a promise when it is kept."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise BrowserError(details.get("exception", {}).get("description") or details["text"])
        return answer["result"].get("value")

    def press(self, key):
        """Presses and releases a key where the focus is."""
        code, text = KEYS[key]
        named = {"key": text if key == "Space" else key, "code": key, "windowsVirtualKeyCode": code}
        self.call("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", text=text, **named)
        self.call("Input.dispatchKeyEvent", type="keyUp", **named)

    def screenshot(self, whole=True):
        """The page, or what of it is on the screen, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", captureBeyondViewport=whole, **(
            {"clip": dict(self.call("Page.getLayoutMetrics")["cssContentSize"], scale=1)} if whole else {}))["data"])

    def pdf(self, paper=A4, margin=0.4, pages=""):
        """The page as it is printed, all of it or a range as "2-5"; lengths in inches."""
        edges = {f"margin{edge}": margin for edge in ("Top", "Bottom", "Left", "Right")}
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True, paperWidth=paper[0],
                                          paperHeight=paper[1], pageRanges=pages, **edges)["data"])
