"""A headless Chromium, by the protocol of WebDriver (chromedriver, plain HTTP)."""

import base64
import json
import socket
import subprocess
import time
import urllib.error
import urllib.request

# WebGL by the CPU: test machines have no GPU.
ARGUMENTS = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--ignore-gpu-blocklist", "--hide-scrollbars", "--no-proxy-server"]


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Browser:
    """Used with `with`: the browser is ended at the end."""

    def __init__(self, width=1280, height=800):
        port = free_port()
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        self.base = f"http://127.0.0.1:{port}"
        try:
            self.wait_for_driver()
            options = {"args": [*ARGUMENTS, f"--window-size={width},{height}"]}
            session = self.call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome", "goog:loggingPrefs": {"browser": "ALL"}, "goog:chromeOptions": options}}})
            self.base += "/session/" + session["sessionId"]
            self.call("POST", "/timeouts", {"script": 120000})
        except BaseException:
            self.driver.kill()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()

    def wait_for_driver(self):
        for _ in range(200):
            try:
                urllib.request.urlopen(self.base + "/status", timeout=1)
                return
            except OSError:
                time.sleep(0.1)
        raise RuntimeError("chromedriver does not answer")

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, method=method, data=data,
                                         headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode(errors="replace")[:1000]) from None

    def go(self, url):
        self.call("POST", "/url", {"url": url})

    def run(self, script):
        """The value that the script returns."""
        return self.call("POST", "/execute/sync", {"script": script, "args": []})

    def wait_for(self, expression):
        """The value of a promise."""
        return self.call("POST", "/execute/async", {
            "script": f"const done = arguments[0]; Promise.resolve({expression}).then(done);", "args": []})

    def click(self, x, y):
        """At a place of the page, pixels."""
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            {"type": "pointerMove", "duration": 0, "x": int(x), "y": int(y)},
            {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]}]})

    def until(self, condition, timeout_s=60):
        """Waits until the JavaScript expression is true; its value."""
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            value = self.run(f"return {condition}")
            if value:
                return value
            time.sleep(0.2)
        raise AssertionError(f"after {timeout_s} s not true: {condition}; stats: {self.run('return window.kintsugi && kintsugi.stats()')}")

    def messages(self):
        """Errors on the console, and requests that failed or were blocked."""
        return [entry["message"] for entry in self.call("POST", "/se/log", {"type": "browser"})
                if entry["level"] == "SEVERE"]

    def picture(self, file):
        with open(file, "wb") as png:
            png.write(base64.b64decode(self.call("GET", "/screenshot")))
