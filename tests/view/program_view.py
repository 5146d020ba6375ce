# SPDX-License-Identifier: Apache-2.0
"""How tests run `pelage view` and ask its server."""
import http.client
import json
import os
import pathlib
import re
import signal
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from program_scene import ProgramTest  # noqa: E402


class ViewTest(ProgramTest):
    def view(self, *arguments):
        process = self.start("view", "scene.yaml", "--threads", "2", *arguments)
        line = process.stdout.readline()
        match = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})\n", line)
        self.assertTrue(match, line)
        self.url, self.port, self.token = line.strip(), int(match.group(1)), match.group(2)
        return process

    def get(self, page, headers=None, token=None, **values):
        """Status and body."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=240)
        values["token"] = self.token if token is None else token
        connection.request("GET", f"/{page}?{urllib.parse.urlencode(values)}", headers=headers or {})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, body

    def post(self, page, body, headers=None, token=None):
        """Status and answer. `body`: bytes, or values for JSON."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=240)
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        query = urllib.parse.urlencode({"token": self.token if token is None else token})
        connection.request("POST", f"/{page}?{query}", data, {"Content-Type": "application/json", **(headers or {})})
        answer = connection.getresponse()
        text = answer.read()
        connection.close()
        return answer.status, json.loads(text) if text[:1] == b"{" else text

    def state(self):
        status, body = self.get("state.json")
        self.assertEqual(status, 200)
        return json.loads(body)

    def wait(self, holds, seconds=240):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.state()
            if holds(state):
                return state
            time.sleep(0.05)
        self.fail(f"never: {state}")

    def rest(self):
        return self.wait(lambda state: state["done"])

    def replace(self, old, new):
        text = (self.path / "scene.yaml").read_text()
        self.assertIn(old, text)
        self.write(text.replace(old, new))

    def write(self, text):
        """Edits the scene as many editors do: writes another file and renames it."""
        (self.path / "scene.new").write_text(text)
        os.replace(self.path / "scene.new", self.path / "scene.yaml")

    def interrupt(self, process):
        """Seconds that it takes to end after Ctrl-C."""
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 0)
        return time.monotonic() - began
