"""A headless Chromium that opens a page at a width and tells what it sees, without any package.

It is spoken to in its own protocol over a pair of pipes: texts in JSON, each ended by a zero byte.
"""

import base64
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
#: Time without a word from the browser after which it is given up [s].
PATIENCE = 90.0
#: Begins a program whose third and fourth files are two of this process.
LAUNCH = """
import fcntl, os, sys
given = [fcntl.fcntl(int(word), fcntl.F_DUPFD, 10) for word in sys.argv[1:3]]
os.dup2(given[0], 3)
os.dup2(given[1], 4)
os.execvp(sys.argv[3], sys.argv[3:])
"""
#: What a page shows: script of the figures' sizes and what leaves the window sideways.
SEEN = """
(() => {
  const width = document.documentElement.clientWidth;
  const box = item => { const r = item.getBoundingClientRect();
    return {tag: item.tagName, left: r.left, right: r.right, width: r.width, height: r.height}; };
  const shown = item => !item.closest('details:not([open])');
  return {
    width: width,
    inner: window.innerWidth,
    scroll: document.documentElement.scrollWidth,
    figures: [...document.querySelectorAll('img, body svg, canvas')].filter(shown).map(box),
    outside: [...document.querySelectorAll('body *')].filter(shown).map(box)
      .filter(r => r.width > 0 && (r.right > width + 1 || r.left < -1)).map(r => r.tag),
    smallest: Math.min(...[...document.querySelectorAll('body svg text')].filter(shown)
      .map(item => item.getBoundingClientRect().height)),
  };
})()
"""


class Browser:
    """A browser with one page, as a context."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        ours, theirs = os.pipe(), os.pipe()
        words = [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-dev-shm-usage",
            f"--user-data-dir={self.folder.name}",
            "--remote-debugging-pipe",
            "about:blank",
        ]
        self.process = subprocess.Popen(
            [sys.executable, "-c", LAUNCH, str(ours[0]), str(theirs[1]), *words],
            pass_fds=(ours[0], theirs[1]),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(ours[0])
        os.close(theirs[1])
        self.writer, self.reader = ours[1], theirs[0]
        self.rest, self.number, self.session, self.events = b"", 0, None, []
        page = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{domain}.enable")
        return self

    def __exit__(self, *_):
        os.close(self.writer)
        os.close(self.reader)
        self.process.terminate()
        self.process.wait(20)
        self.folder.cleanup()

    def ask(self, method, **parameters):
        """Answer to a command; events that come before it are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.writer, json.dumps(message).encode() + b"\0")
        while True:
            found = self._next()
            if found.get("id") == self.number:
                assert "error" not in found, found
                return found["result"]
            self.events.append(found)

    def _next(self):
        while b"\0" not in self.rest:
            ready = select.select([self.reader], [], [], PATIENCE)[0]
            assert ready, f"the browser has said nothing for {PATIENCE} s"
            more = os.read(self.reader, 1 << 16)
            assert more, "the browser has gone"
            self.rest += more
        message, _, self.rest = self.rest.partition(b"\0")
        return json.loads(message)

    def open(self, path, width, height=900, *, dark=False):
        """Open a file at a width [px]; returns what is seen of it."""
        self.events = []
        self.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=width < 600,
        )
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.ask("Emulation.setEmulatedMedia", features=[scheme])
        self.ask("Page.navigate", url=Path(path).resolve().as_uri())
        while self.evaluate("document.readyState") != "complete":
            time.sleep(0.05)
        time.sleep(0.3)  # for scripts that begin with the page
        return self.evaluate(SEEN)

    def evaluate(self, script):
        """Value of an expression in the page."""
        found = self.ask("Runtime.evaluate", expression=script, returnByValue=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    @property
    def complaints(self):
        """Script errors and errors on the console since the page was opened."""
        bad = []
        for event in self.events:
            method, told = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                bad.append(told["exceptionDetails"])
            if method == "Log.entryAdded" and told["entry"]["level"] == "error":
                bad.append(told["entry"])
            if method == "Runtime.consoleAPICalled" and told["type"] == "error":
                bad.append(told["args"])
        return bad

    @property
    def loaded(self):
        """Addresses the page asked for, itself and what it holds apart."""
        asked = [
            event["params"]["request"]["url"]
            for event in self.events
            if event.get("method") == "Network.requestWillBeSent"
        ]
        return [url for url in asked[1:] if not url.startswith("data:")]

    def picture(self, path):
        """Write a picture of the whole page."""
        shown = self.ask("Page.captureScreenshot", captureBeyondViewport=True, format="png")
        Path(path).write_bytes(base64.b64decode(shown["data"]))
