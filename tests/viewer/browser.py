"""A headless Chromium, driven by the DevTools protocol over a pair of pipes: no package is needed."""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

HANG = 300  # seconds, for a browser that hangs alone
# What Chromium and Firefox answer where a page is left before an expression in it has its value.
PAGE_LEFT = ("Inspected target navigated", "Execution context was destroyed", "Cannot find context", "Actor 'MessageHandlerFrame' destroyed")
# What the page is doing, for the message of a test that waits in vain.
STATE = """JSON.stringify({ ...globalThis.halflight?.frames?.statistics,
  says: [...document.querySelectorAll('#message, #stage, #progress')].map((e) => e.textContent.trim()), visible: document.visibilityState })"""


class BrowserError(Exception):
    """The browser has answered with an error, or not at all."""


class Browser:
    """One browser with one page."""

    fingers = 5

    def __init__(self, program="chromium", size=(1280, 720)):
        self._folder = tempfile.mkdtemp(prefix="halflight-chromium-")
        to_browser, self._to = os.pipe()
        self._from, from_browser = os.pipe()

        def place():
            # The protocol's pipes are descriptors 3 and 4. Copies first: one may lie where the other goes.
            read, write = os.dup(to_browser), os.dup(from_browser)
            high_read, high_write = os.dup2(read, 100), os.dup2(write, 101)
            os.dup2(high_read, 3)
            os.dup2(high_write, 4)

        self._process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--hide-scrollbars", "--remote-debugging-pipe",
             f"--user-data-dir={self._folder}", f"--window-size={size[0]},{size[1]}", "about:blank"],
            preexec_fn=place, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self._buffer = b""
        self._number = 0
        self._session = None
        self.problems = []  # exceptions and errors of the page's console
        target = self._wait_for_page()
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(*size)

    def _wait_for_page(self):
        end = time.monotonic() + HANG
        while time.monotonic() < end:
            for target in self.call("Target.getTargets")["targetInfos"]:
                if target["type"] == "page":
                    return target["targetId"]
            time.sleep(0.05)
        raise BrowserError("Chromium shows no page")

    def close(self):
        self._process.kill()
        self._process.wait()
        os.close(self._to)
        os.close(self._from)
        shutil.rmtree(self._folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _receive(self, timeout):
        """The next message."""
        end = time.monotonic() + timeout
        while b"\0" not in self._buffer:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self._from], [], [], left)[0]:
                raise BrowserError("Chromium does not answer")
            piece = os.read(self._from, 1 << 20)
            if not piece:
                raise BrowserError("Chromium has ended")
            self._buffer += piece
        line, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(line)

    def _note(self, message):
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.problems.append(str(parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            self.problems.append(parameters["entry"]["text"] + " " + parameters["entry"].get("url", ""))

    def call(self, method, timeout=HANG, **parameters):
        """Calls a method of the protocol and returns its result."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive(timeout)
            self._note(answer)
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise BrowserError(f"{method}: {answer['error']}")
                return answer["result"]

    def touch(self, *steps):
        """Fingers on the screen. A step: [[x, y] of each finger]; None: this finger is not down. After the last step all leave."""
        self.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)
        down = {}
        for places in (*steps, ()):
            now = {finger: {"x": place[0], "y": place[1], "id": finger} for finger, place in enumerate(places) if place is not None}
            lifted = [point for finger, point in down.items() if finger not in now]
            if lifted:
                self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=lifted)
            if now:
                self.call("Input.dispatchTouchEvent", type="touchMove" if now.keys() <= down.keys() else "touchStart", touchPoints=list(now.values()))
            down = now
        self.call("Emulation.setTouchEmulationEnabled", enabled=False)

    def run(self, script, timeout=HANG):
        """The value of a JavaScript expression; promises are awaited."""
        answer = self.call("Runtime.evaluate", timeout=timeout, expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise BrowserError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def holds(self, condition):
        """Whether a JavaScript expression is true. A page that is left while the browser asks it holds nothing."""
        try:
            return self.run(condition)
        except BrowserError as error:
            if any(sign in str(error) for sign in PAGE_LEFT):
                return False
            raise

    def wait(self, condition, timeout=HANG):
        """Waits until a JavaScript expression is true."""
        end = time.monotonic() + timeout
        while not self.holds(condition):
            if time.monotonic() > end:
                raise BrowserError(f"never true: {condition}; {self.run(STATE)}; {self.problems}")
            time.sleep(0.03)

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, url):
        self.call("Page.navigate", url=url)

    def mouse(self, kind, x, y, button="left", modifiers=0, **more):
        buttons = {"left": 1, "right": 2, "middle": 4, "none": 0}[button] if kind != "mouseReleased" else 0
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=buttons, modifiers=modifiers,
                  clickCount=1, **more)

    def drag(self, start, end, steps=8, button="left", modifiers=0):
        """Presses at start, moves to end and lets go."""
        self.mouse("mousePressed", *start, button, modifiers)
        for step in range(1, steps + 1):
            place = [a + (b - a) * step / steps for a, b in zip(start, end)]
            self.mouse("mouseMoved", *place, button, modifiers)
        self.mouse("mouseReleased", *end, button, modifiers)

    def click(self, place, count=1):
        """count: the number of this click at its place: 2 is the second of a double click."""
        for kind in ("mousePressed", "mouseReleased"):
            buttons = 1 if kind == "mousePressed" else 0
            self.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", buttons=buttons, clickCount=count)

    def wheel(self, x, y, pixels, modifiers=0):
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=pixels, modifiers=modifiers)

    def type(self, text):
        self.call("Input.insertText", text=text)

    def key(self, key, text=None, modifiers=0):
        told = {"key": key, "modifiers": modifiers, **({"code": "Tab", "windowsVirtualKeyCode": 9} if key == "Tab" else {})}
        self.call("Input.dispatchKeyEvent", type="keyDown", text="" if modifiers else text or (key if len(key) == 1 else ""), **told)
        self.call("Input.dispatchKeyEvent", type="keyUp", **told)

    def reload(self):
        self.call("Page.reload")

    def save_in(self, folder):
        """Files that the page saves arrive in this folder."""
        self.call("Page.setDownloadBehavior", behavior="allow", downloadPath=os.path.abspath(folder))

    def offline(self, is_offline):
        """Takes the network away, or gives it back."""
        self.call("Network.emulateNetworkConditions", offline=is_offline, latency=0, downloadThroughput=-1, uploadThroughput=-1)

    def used_memory(self):
        """Bytes of the page's objects, without those that are garbage; None: the browser does not tell."""
        self.call("HeapProfiler.collectGarbage")
        return self.run("performance.memory.usedJSHeapSize")

    def choose(self, selector, files):
        """Chooses files in an input of the page."""
        document = self.call("DOM.getDocument")["root"]["nodeId"]
        chooser = self.call("DOM.querySelector", nodeId=document, selector=selector)["nodeId"]
        self.call("DOM.setFileInputFiles", nodeId=chooser, files=[str(file) for file in files])

    def drop(self, place, files):
        """Drops files or folders on the page."""
        data = {"items": [], "files": [str(file) for file in files], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.call("Input.dispatchDragEvent", type=kind, x=place[0], y=place[1], data=data)

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
