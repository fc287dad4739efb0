"""A headless browser for tests: Chromium, driven by its own protocol through two pipes."""

import base64
import json
import os
import shutil
import subprocess

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
_KEYS = {"Tab": 9, "Enter": 13, " ": 32}


class Browser:
    """One page of a browser; a context manager."""

    def __init__(self, folder):
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()
        line = [BROWSER, "--headless", "--disable-gpu", "--no-first-run", "--no-sandbox", "--remote-debugging-pipe"]
        line += [f"--user-data-dir={folder}", "about:blank"]

        def numbered():
            # The protocol reads from the file 3 and writes to the file 4; duplicates first, lest one is overwritten.
            ends = os.dup(to_read), os.dup(to_write)
            for number, end in zip((3, 4), ends, strict=True):
                os.dup2(end, number)

        # Its processes talk to each other by sockets; under `make test-no-network`, these are not of the project.
        environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self._process = subprocess.Popen(line, preexec_fn=numbered, close_fds=False, env=environment, **quiet)
        os.close(to_read)
        os.close(to_write)
        self._lines, self._count, self._session = b"", 0, None
        self.events = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._read)
        os.close(self._write)

    def call(self, method, **parameters):
        """Send a command, and return its result; what happens meanwhile is added to ``events``."""
        self._count += 1
        message = {"id": self._count, "method": method, "params": parameters}
        message |= {"sessionId": self._session} if self._session else {}
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while (answer := self._next()).get("id") != self._count:
            self.events.append(answer)
        assert "error" not in answer, answer
        return answer["result"]

    def _next(self):
        while b"\0" not in self._lines:
            more = os.read(self._read, 1 << 16)
            assert more, "the browser ended"
            self._lines += more
        line, _, self._lines = self._lines.partition(b"\0")
        return json.loads(line)

    def open(self, path, width=1280, height=900, *, phone=False):
        """Open a file in a window of so many pixels, and wait until it is there."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        self.events.clear()
        self.call("Page.navigate", url=path.absolute().as_uri())
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self._next())

    def value(self, script):
        """The value of an expression of JavaScript."""
        told = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in told, told
        return told["result"].get("value")

    def press(self, key, shift=False):
        """Press a key, as a hand would."""
        text = {"Enter": "\r", " ": " "}.get(key, "")
        values = {"key": key, "windowsVirtualKeyCode": _KEYS[key], "modifiers": 8 if shift else 0}
        self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **values)
        self.call("Input.dispatchKeyEvent", type="keyUp", **values)

    def write(self, text):
        """Type a text where the cursor is."""
        self.call("Input.insertText", text=text)

    def click(self, selector):
        """Click the middle of what a selector of CSS finds."""
        box = self.value(
            f"(() => {{ const own = document.querySelector({json.dumps(selector)}); own.scrollIntoView(); "
            "const box = own.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    def picture(self, path):
        """Write a screenshot."""
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
