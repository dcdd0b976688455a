#!/usr/bin/env python3
"""Where the token of the page's URL is: printed to the user, and in a private file for the browser. In no command line,
title, log, error or answer.

usage: private_url.py PROGRAM
"""
import glob
import http.client
import os
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import urllib.parse

import checks
from browser import Browser
from checks import check
from viewer import need_viewer

PROGRAM = os.path.abspath(sys.argv[1])

# In place of xdg-open: it notes what it was given, and what others could see of the file.
OPENER = """#!/bin/sh
{ echo "$#"; echo "$1"; stat -c %a "$1" "$(dirname "$1")"; tr '\\0' ' ' < "/proc/$$/cmdline"; } > told.part
cp "$1" redirect.html
mv told.part told
"""


def command_lines():
    lines = []
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            with open(path, "rb") as file:
                lines.append(file.read())
        except OSError:
            pass
    return lines


def wait_for(what, seconds=60):
    end = time.monotonic() + seconds
    while not what():
        check(time.monotonic() < end, "it comes")
        time.sleep(0.05)


def start(*arguments, **environment):
    process = subprocess.Popen([PROGRAM, "view", "torus.nrrd", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**os.environ, **environment})
    url = process.stdout.readline().strip()
    return process, url, urllib.parse.urlsplit(url)


def answer(parts, method, path, body=None, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", parts.port, timeout=60)
    connection.request(method, path, body, headers)
    response = connection.getresponse()
    return response.status, str(response.headers), response.read()


def end(process):
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    check(process.returncode == 0, f"it ends well: {process.returncode} {errors}")
    return output + errors


def redirect(place):
    """The browser gets the name of a file that its user alone can read, and that goes once the page was loaded."""
    process, url, parts = start()
    token = parts.path.strip("/")
    wait_for(lambda: os.path.exists("told"))
    count, path, mode, folder_mode, line = open("told").read().split("\n")[:5]
    check(count == "1" and path.startswith(f"{place}/") and os.path.basename(path) == "open.html", f"one file in {place}: {path}")
    check(mode == "600" and folder_mode == "700", f"of this user alone: {mode} in {folder_mode}")
    check(token not in line and token not in path, "without the token in its command line")
    check(not any(token.encode() in other for other in command_lines()), "nor in any other")
    with open("redirect.html") as file:
        check(url in file.read(), "it leads to the page")
    check(os.path.exists(path), "the file stays until the page was loaded")
    check(answer(parts, "GET", "/")[0] == 403 and os.path.exists(path), "and is not for strangers to remove")
    check(answer(parts, "GET", parts.path)[0] == 200, "the page")
    wait_for(lambda: not os.path.exists(os.path.dirname(path)))
    check(token not in end(process), "the token is in no message")
    os.remove("told")


def without_a_visit():
    """A file that no browser has read goes at the end; --no-browser makes none."""
    process, _, _ = start()
    wait_for(lambda: os.path.exists("told"))
    path = open("told").read().split("\n")[1]
    end(process)
    check(not os.path.exists(os.path.dirname(path)), "the file goes at the end")
    os.remove("told")
    process, _, _ = start("--no-browser")
    time.sleep(0.3)
    end(process)
    check(not os.path.exists("told"), "--no-browser opens none")


def answers(process, parts):
    """What the server answers does not hold the token, least of all what it refuses."""
    token = parts.path.strip("/")
    for method, path in (("GET", ""), ("GET", "start.json"), ("GET", "main.js"), ("GET", "folder.json?at="), ("GET", "nothing"), ("POST", "scene"),
                         ("POST", "frame"), ("POST", "open?file=none.nrrd"), ("POST", "open?file=torus.nrrd"), ("POST", "upload?name=a.txt"),
                         ("POST", f"open?file={token}"), ("PUT", ""), ("GET", "opening.json")):
        status, headers, body = answer(parts, method, f"{parts.path}{path}", b"{" if method == "POST" else None)
        check(token not in headers and token.encode() not in body, f"{method} {path}: the token is not in the answer ({status})")
        check("Referrer-Policy: no-referrer" in headers, f"{method} {path}: nor will it be a Referer")
    status, headers, body = answer(parts, "GET", parts.path, Host="example.com")
    check(status == 403 and token not in headers and token.encode() not in body, "nor in what a stranger gets")


def in_a_browser(chromium, parts, url):
    """The redirect page leads a real browser to the page, which shows no token."""
    token = parts.path.strip("/")
    with open("redirect.html") as before, open("leads.html", "w") as file:
        text = before.read()
        begin = text.index("http://")
        file.write(text.replace(text[begin:text.index('"', begin)], url))
    with Browser(chromium, (400, 300)) as browser:
        browser.open(f"file://{os.path.abspath('leads.html')}")
        browser.wait(f"location.href === {url!r} && document.title.startsWith('torus')")
        check(not browser.run(f"document.title.includes({token!r})") and browser.run("document.referrer") == "", "neither in its title nor as a referrer")
        check(not browser.run(f"document.documentElement.outerHTML.includes({token!r})"), "nor in the page")
        check(not any(token.encode() in line for line in command_lines()), "nor in a command line of the browser")


with tempfile.TemporaryDirectory() as folder:
    folder = os.path.realpath(folder)
    os.chdir(folder)
    for name in ("bin", "runtime", "temporary"):
        os.mkdir(name)
    with open("bin/xdg-open", "w") as file:
        file.write(OPENER)
    os.chmod("bin/xdg-open", stat.S_IRWXU)
    os.environ.update(PATH=f"{folder}/bin:{os.environ['PATH']}", TMPDIR=f"{folder}/temporary", DISPLAY=":9", XDG_RUNTIME_DIR=f"{folder}/runtime")
    need_viewer(PROGRAM)
    subprocess.run([PROGRAM, "make", "torus", "--size", "16", "--quiet"], check=True)
    redirect(f"{folder}/runtime")
    without_a_visit()
    del os.environ["XDG_RUNTIME_DIR"]
    redirect(f"{folder}/temporary")
    process, url, parts = start("--no-browser")
    answers(process, parts)
    chromium = shutil.which("chromium")
    if chromium is not None:
        in_a_browser(chromium, parts, url)
    check(parts.path.strip("/") not in end(process), "the token is in no message")
    left = [name for place in ("temporary", "runtime") for name in os.listdir(place) if "halflight-view" in name]
    check(left == [], f"nothing is left: {left}")
    print(f"{checks.count} checks passed")
