"""A running `halflight view`, for tests."""
import http.client
import signal
import subprocess
import sys
import urllib.parse


def need_viewer(program):
    """Ends the test as skipped where the program was built without the viewer."""
    if subprocess.run([program, "view", "none.nrrd", "--no-browser"], capture_output=True, check=False).returncode == 4:
        print("built without the viewer")
        sys.exit(77)


class Viewer:
    """The program with one INPUT; its requests can be made in Python."""

    def __init__(self, program, *arguments):
        self.process = subprocess.Popen([program, "view", "--no-browser", "--quiet", *arguments], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        parts = urllib.parse.urlsplit(self.url)
        self.port, self.token = parts.port, parts.path.strip("/")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        died = self.process.poll() not in (None, 0)
        if self.process.poll() is None:
            self.process.kill()
        _, errors = self.process.communicate()
        if died:
            print(f"the viewer has ended with status {self.process.returncode}: {errors[-8000:]}", file=sys.stderr)

    def request(self, method, path, body=None, headers=None, timeout=600, **query):
        """(status, headers, body); path without its token where it begins with '/'."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        whole = path if path.startswith("/") else f"/{self.token}/{path}"
        connection.request(method, f"{whole}?{urllib.parse.urlencode(query, safe=',')}" if query else whole, body, headers or {})
        answer = connection.getresponse()
        result = answer.status, answer.headers, answer.read()
        connection.close()
        return result

    def interrupt(self, timeout=300):
        """Ctrl-C; returns the exit status."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout)
