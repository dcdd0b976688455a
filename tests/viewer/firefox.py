"""A headless Firefox with the hands of browser.py, driven by WebDriver BiDi over a WebSocket: no package is needed."""
import base64
import io
import json
import os
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

from browser import HANG, Browser, BrowserError

KEYS = {"ArrowLeft": "\ue012", "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015", "PageUp": "\ue00e", "PageDown": "\ue00f", "Home": "\ue011",
        "Enter": "\ue007", "Escape": "\ue00c", "Delete": "\ue017", "Tab": "\ue004"}
MODIFIERS = {1: "\ue00a", 2: "\ue009", 4: "\ue03d", 8: "\ue008"}  # alt, ctrl, meta, shift, as the DevTools protocol counts them
BUTTONS = {"left": 0, "middle": 1, "right": 2}


class Socket:
    """A WebSocket's client (RFC 6455), for texts."""

    def __init__(self, port):
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=HANG)
        self._buffer = b""
        self._socket.sendall((f"GET /session HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        while b"\r\n\r\n" not in self._buffer:
            self._more()
        head, self._buffer = self._buffer.split(b"\r\n\r\n", 1)
        if b" 101 " not in head:
            raise BrowserError(f"Firefox refuses: {head[:100]}")

    def _more(self):
        piece = self._socket.recv(1 << 20)
        if not piece:
            raise BrowserError("Firefox has ended")
        self._buffer += piece

    def _take(self, count):
        while len(self._buffer) < count:
            self._more()
        taken, self._buffer = self._buffer[:count], self._buffer[count:]
        return taken

    def wait(self, seconds):
        """How long the next texts may take."""
        self._socket.settimeout(seconds)

    def send(self, text):
        payload, mask = text.encode(), os.urandom(4)
        size = len(payload)
        head = bytes([0x81]) + (bytes([0x80 | size]) if size < 126 else bytes([0xfe]) + struct.pack(">H", size) if size < 65536 else bytes([0xff]) + struct.pack(">Q", size))
        self._socket.sendall(head + mask + bytes(byte ^ mask[n % 4] for n, byte in enumerate(payload)))

    def receive(self):
        """The next text; pings need no answer within a test."""
        text = b""
        while True:
            first, second = self._take(2)
            size = second & 0x7f
            size = struct.unpack(">H", self._take(2))[0] if size == 126 else struct.unpack(">Q", self._take(8))[0] if size == 127 else size
            payload = self._take(size)
            if first & 0x0f in (0, 1):
                text += payload
                if first & 0x80:
                    return text.decode()

    def close(self):
        self._socket.close()


def value_of(remote):
    """The Python value of one that the protocol tells."""
    kind, value = remote["type"], remote.get("value")
    if kind == "array":
        return [value_of(one) for one in value]
    if kind == "object":
        return {key: value_of(one) for key, one in value or ()}
    if kind == "number" and isinstance(value, str):
        return {"NaN": float("nan"), "-0": -0.0, "Infinity": float("inf"), "-Infinity": float("-inf")}[value]
    return value if kind in ("string", "number", "boolean") else None


class Firefox:
    """One browser with one page."""

    fingers = 1  # of several, the first alone arrives
    def __init__(self, program="firefox-esr", size=(1280, 720)):
        self._folder = tempfile.mkdtemp(prefix="halflight-firefox-")
        self._process = subprocess.Popen([program, "--headless", "--no-remote", "--profile", self._folder, "--remote-debugging-port", "0"],
                                         env={**os.environ, "HOME": self._folder}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for line in self._process.stderr:
            found = re.search(r"WebDriver BiDi listening on ws://[^:]+:(\d+)", line)
            if found:
                break
        else:
            raise BrowserError("Firefox does not start")
        # Firefox stops where nobody reads what it writes.
        threading.Thread(target=shutil.copyfileobj, args=(self._process.stderr, io.StringIO()), daemon=True).start()
        self._socket = Socket(int(found[1]))
        self._number = 0
        self.problems = []
        self.call("session.new", capabilities={})
        self.call("session.subscribe", events=["log.entryAdded"])
        self._context = self.call("browsingContext.getTree")["contexts"][0]["context"]
        self.resize(*size)

    def close(self):
        self._socket.close()
        self._process.kill()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def call(self, method, **parameters):
        """Calls a method of the protocol and returns its result."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.receive())
            if answer.get("method") == "log.entryAdded" and answer["params"]["level"] == "error":
                self.problems.append(answer["params"]["text"])
            if answer.get("id") == self._number:
                if answer["type"] == "error":
                    raise BrowserError(f"{method}: {answer['error']}: {answer['message']}")
                return answer["result"]

    def run(self, script, timeout=HANG):
        """The value of a JavaScript expression; promises are awaited."""
        self._socket.wait(timeout)
        answer = self.call("script.evaluate", expression=script, target={"context": self._context}, awaitPromise=True)
        if answer["type"] != "success":
            raise BrowserError(f"{script}: {answer['exceptionDetails']['text']}")
        return value_of(answer["result"])

    holds = Browser.holds
    wait = Browser.wait

    def resize(self, width, height):
        self._size = width, height
        self.call("browsingContext.setViewport", context=self._context, viewport={"width": width, "height": height})

    def open(self, url):
        self.call("browsingContext.navigate", context=self._context, url=url, wait="complete")

    def _perform(self, *sources):
        self.call("input.performActions", context=self._context, actions=list(sources))

    def _held(self, modifiers, down):
        keys = [value for bit, value in MODIFIERS.items() if modifiers & bit]
        if keys:
            self._perform({"type": "key", "id": "keys", "actions": [{"type": "keyDown" if down else "keyUp", "value": key} for key in keys]})

    def _pointer(self, *actions):
        self._perform({"type": "pointer", "id": "mouse", "actions": list(actions)})

    def drag(self, start, end, steps=8, button="left", modifiers=0):
        """Presses at start, moves to end and lets go."""
        # The protocol's pointer cannot leave the window.
        places = [[min(max(round(a + (b - a) * step / steps), 0), size - 1) for a, b, size in zip(start, end, self._size)] for step in range(steps + 1)]
        moves = [{"type": "pointerMove", "x": x, "y": y} for x, y in places]
        self._held(modifiers, True)
        self._pointer(moves[0], {"type": "pointerDown", "button": BUTTONS[button]}, *moves[1:], {"type": "pointerUp", "button": BUTTONS[button]})
        self._held(modifiers, False)

    def click(self, place, count=1):
        x, y = map(round, place)
        self._pointer({"type": "pointerMove", "x": x, "y": y}, *([{"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}] * count))
        time.sleep(0 if count > 1 else 0.6)  # the next click is another one

    def touch(self, *steps):
        """Fingers on the screen. A step: [[x, y] of each finger]; None: this finger is not down. After the last step all leave."""
        fingers, pause = [], {"type": "pause"}
        for finger in range(len(steps[0])):
            places, actions, was_down = [step[finger] for step in steps] + [None], [], False
            for place in places: # two ticks: to the place, then down or up
                move = pause if place is None else {"type": "pointerMove", "x": round(place[0]), "y": round(place[1])}
                is_down = place is not None
                button = pause if is_down == was_down else {"type": "pointerDown" if is_down else "pointerUp", "button": 0}
                actions += [move, button]
                was_down = is_down
            fingers.append({"type": "pointer", "id": f"finger {finger}", "parameters": {"pointerType": "touch"}, "actions": actions})
        self._perform(*fingers)

    def wheel(self, x, y, pixels, modifiers=0):
        self._held(modifiers, True)
        self._perform({"type": "wheel", "id": "wheel", "actions": [{"type": "scroll", "x": round(x), "y": round(y), "deltaX": 0, "deltaY": pixels}]})
        self._held(modifiers, False)

    def mouse(self, kind, x, y, button="left", modifiers=0):
        actions = [{"type": "pointerMove", "x": round(x), "y": round(y)}]
        if kind != "mouseMoved":
            actions.append({"type": "pointerDown" if kind == "mousePressed" else "pointerUp", "button": BUTTONS[button]})
        self._held(modifiers, True)
        self._pointer(*actions)
        self._held(modifiers, False)

    def key(self, key, modifiers=0):
        self._held(modifiers, True)
        self.type(KEYS.get(key, key))
        self._held(modifiers, False)

    def reload(self):
        self.call("browsingContext.reload", context=self._context, wait="complete")

    def save_in(self, folder):
        """Files that the page saves arrive in this folder."""
        self.call("browser.setDownloadBehavior", downloadBehavior={"type": "allowed", "destinationFolder": os.path.abspath(folder)})

    def offline(self, is_offline):
        """Takes the network away, or gives it back."""
        self.call("emulation.setNetworkConditions", networkConditions={"type": "offline"} if is_offline else None, contexts=[self._context])

    def used_memory(self):
        """Bytes of the page's objects, without those that are garbage; None: the browser does not tell."""
        return None

    def type(self, text):
        self._perform({"type": "key", "id": "keys", "actions": [{"type": kind, "value": letter} for letter in text for kind in ("keyDown", "keyUp")]})

    def choose(self, selector, files):
        """Chooses files in an input of the page."""
        found = self.call("browsingContext.locateNodes", context=self._context, locator={"type": "css", "value": selector})["nodes"][0]
        self.call("input.setFiles", context=self._context, element={"sharedId": found["sharedId"]}, files=[str(file) for file in files])

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("browsingContext.captureScreenshot", context=self._context)["data"]))


def browser_named(name):
    """The class that drives "chromium" or "firefox-esr"; ends the test as skipped where that is not installed."""
    if shutil.which(name) is None:
        print(f"{name} is not installed")
        sys.exit(77)
    return {"chromium": Browser, "firefox-esr": Firefox}[name]
