# SPDX-License-Identifier: Apache-2.0
"""`pelage view` as its clients see it: what it answers, and what it survives."""
import json
import pathlib
import socket
import struct
import sys
import time
import unittest

from program_view import ProgramTest, ViewTest

ProgramTest.PELAGE = sys.argv.pop(1)


class View(ViewTest):
    def test_the_picture_at_rest_is_that_of_render(self):
        self.view()
        state = self.rest()
        self.assertEqual((state["width"], state["height"], state["samples"], state["error"]), (24, 16, 2, ""))
        self.assertEqual(state["strands_regrown"], 0)
        self.assertGreater(state["first_pixels_s"], 0)
        status, shown = self.get("picture.exr")
        self.assertEqual(status, 200)
        self.render("-o", "a.exr")
        rendered = (self.path / "a.exr").read_bytes()
        # The headers differ in times; the rows are at the end.
        self.assertEqual(shown[-2000:], rendered[-2000:])
        self.assertEqual(len(shown), len(rendered))

    def test_the_layers_of_a_picture(self):
        self.view()
        layers = self.rest()["layers"]
        for layer in ("beauty", "Z", "N", "tangent", "forward", "root", "id", "sky.diffuse"):
            self.assertIn(layer, layers)
        for layer in layers:
            status, body = self.get("layer.bin", name=layer)
            self.assertEqual(status, 200, layer)
            head = body.index(b"\n") + 1
            self.assertEqual(head % 8, 0)
            channels = body[:head].count(b'"type"')
            self.assertIn(len(body) - head, (24 * 16 * 2 * channels, 24 * 16 * 4 * channels))
        for layer in ("", "none", "../scene.yaml", "beauty\0"):
            self.assertEqual(self.get("layer.bin", name=layer)[0], 404)

    def test_a_light_regrows_nothing_and_a_groom_its_coat(self):
        self.view()
        self.rest()
        self.replace("radiance: 0.3", "radiance: 0.6")
        state = self.wait(lambda state: state["done"] and state["edits"] == 1)
        self.assertEqual(state["strands_regrown"], 0)
        self.replace("length: {value: 0.4}", "length: {value: 0.2}")
        state = self.wait(lambda state: state["done"] and state["edits"] == 2)
        self.assertGreaterEqual(state["strands_regrown"], 1)

    def test_files_of_lights_are_followed(self):
        profile = "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n{0} {0}\n"
        (self.path / "lamp.ies").write_text(profile.format(500))
        (self.path / "gobo.ppm").write_bytes(b"P6 1 1 255\n\xff\xff\xff")
        self.replace("lights: {sky: {type: environment, radiance: 0.3}}", """lights:
  lamp: {type: point, position: [2, 4, 5], profile: lamp.ies}
  panel: {type: rectangle, position: [-4, 4, 4], look_at: [0, 0, 0], file: gobo.ppm}""")
        self.view()
        _, last = (self.rest(), self.get("picture.exr")[1])
        for edit, (name, data) in enumerate((("lamp.ies", profile.format(2000).encode()), ("gobo.ppm", b"P6 1 1 255\n\xff\0\0")), 1):
            (self.path / name).write_bytes(data)
            state = self.wait(lambda state: state["done"] and state["edits"] == edit)
            self.assertEqual((state["error"], state["strands_regrown"]), ("", 0), name)
            self.assertNotEqual(self.get("picture.exr")[1][-2000:], last[-2000:], name)
            self.expect_rendered()
            last = self.get("picture.exr")[1]
        # A mistake is named with its line, and the last picture stays.
        (self.path / "lamp.ies").write_text(profile.format(-1))
        state = self.wait(lambda state: state["error"])
        self.assertIn("lamp.ies:7: expected a candela value not below 0", state["error"])
        self.assertEqual(self.get("picture.exr")[1][-2000:], last[-2000:])

    def test_strangers_are_refused(self):
        self.view()
        self.rest()
        own = f"127.0.0.1:{self.port}"
        for name in ("", "state.json", "picture.exr", "layer.bin", "main.js", "none"):
            self.assertEqual(self.get(name, token="")[0], 403)
            self.assertEqual(self.get(name, token="0" * 32)[0], 403)
            self.assertEqual(self.get(name, {"Host": "evil.example"})[0], 403)
            self.assertEqual(self.get(name, {"Origin": "http://evil.example"})[0], 403)
        self.assertEqual(self.get("", {"Origin": "http://" + own})[0], 200)
        for name in ("scene.yaml", "../scene.yaml", "..%2fscene.yaml", "/etc/passwd", "%2fetc%2fpasswd", "page/main.js"):
            self.assertEqual(self.get(name)[0], 404, name)
        self.assertEqual(self.get("state.json", {"Content-Length": "1000000"})[0], 413)
        self.assertGreaterEqual(self.get("state.json", {"X": "y" * 100000})[0], 400)
        self.assertGreaterEqual(self.get("state.json", pad="y" * 100000)[0], 400)

    def expect_rendered(self, *arguments):
        """The picture at rest has the pixels of a render."""
        _, shown = self.get("picture.exr")
        self.render("-o", "a.exr", *arguments)
        rendered = (self.path / "a.exr").read_bytes()
        self.assertEqual(shown[-2000:], rendered[-2000:])  # the headers differ in times

    def settled(self, edits, moved):
        return self.wait(lambda state: state["done"] and state["edits"] == edits and state["camera"]["moved"] == moved)

    def test_a_moved_camera_stays_until_that_of_the_file_changes(self):
        self.view()
        self.rest()
        move = {"action": "move", "position": [-3, 2.5, 7], "look_at": [0, 0.25, 0]}
        flags = ["--set", "camera.position=[-3, 2.5, 7]", "--set", "camera.look_at=[0, 0.25, 0]"]
        self.assertEqual(self.post("camera.json", move)[0], 200)
        state = self.settled(1, True)
        self.assertEqual(state["camera"]["position"], [-3, 2.5, 7])
        self.expect_rendered(*flags)
        self.replace("radiance: 0.3", "radiance: 0.6")
        self.assertEqual(self.settled(2, True)["camera"]["look_at"], [0, 0.25, 0])
        self.expect_rendered(*flags)
        self.replace("fov: 40", "fov: 50")
        self.assertIn("camera of the scene file", self.settled(3, False)["camera"]["note"])
        self.expect_rendered()

        self.assertEqual(self.post("camera.json", move)[0], 200)
        self.assertEqual(self.settled(4, True)["camera"]["note"], "")
        self.assertEqual(self.post("camera.json", {"action": "reset"})[0], 200)
        self.settled(5, False)
        self.expect_rendered()

        self.post("camera.json", move)
        self.settled(6, True)
        before = (self.path / "scene.yaml").read_text()
        status, answer = self.post("camera.json", {"action": "write"})
        self.assertEqual((status, answer["written"]), (200, True))
        written = before.replace("[3, 2, 8], look_at: [0, 0, 0]", "[-3, 2.5, 7], look_at: [0, 0.25, 0]")
        self.assertEqual((self.path / "scene.yaml").read_text(), written)
        self.assertEqual(self.settled(6, False)["camera"]["note"], "")  # the picture is the same
        self.expect_rendered()

    def test_a_region_is_refined_first_and_changes_no_pixel(self):
        self.view("--set", "render.samples=2000", "--set", "image={width: 64, height: 48}")
        self.wait(lambda state: state["first_pixels_s"] > 0)
        self.assertEqual(self.post("region.json", {"region": [5, 6, 20, 15]})[0], 200)

        def has_region(state):
            _, body = self.get("layer.bin", name="beauty")
            return json.loads(body[:body.index(b"\n")])["full"] == [5, 6, 20, 15]

        self.assertEqual(self.wait(has_region)["region"], [5, 6, 20, 15])
        self.assertEqual(self.post("region.json", {"region": None})[0], 200)
        self.replace("samples: 2", "samples: 3")  # --set takes precedence: nothing changes
        self.assertEqual(self.rest()["region"], None)
        self.expect_rendered("--set", "render.samples=2000", "--set", "image={width: 64, height: 48}")

    def test_a_pixel_is_explained(self):
        process = self.view()
        self.rest()
        status, body = self.get("why.json", x=10, y=10)
        self.assertEqual(status, 200)
        shown = json.loads(body)
        rendered = json.loads(self.run_pelage("why", "scene.yaml", 10, 10, "--json")[0])
        self.assertTrue(shown["strand"])
        for answer in (shown, rendered):
            for key in ("cost", "chunk", "text"):  # they differ from run to run
                del answer[key]
        self.assertEqual(shown, rendered)
        for values in ({"x": 24, "y": 8}, {"x": 12, "y": -1}, {"x": 12}, {}, {"x": "1.5", "y": 2}, {"x": "", "y": 2},
                       {"x": "9" * 40, "y": 2}, {"x": "1e1", "y": 2}, {"x": " 1", "y": 2}, {"x": "0x1", "y": "2"}):
            status, body = self.get("why.json", **values)
            self.assertEqual(status, 400, values)
            self.assertTrue(json.loads(body)["error"], values)
        self.assertEqual(self.get("why.json", token="0" * 32, x=12, y=8)[0], 403)
        self.interrupt(process)

    def test_a_frame_is_chosen(self):
        self.view("--set", "frames=1-3", "--set", "camera.position={keys: {1: [3, 2, 8], 3: [-3, 2, 8]}}")
        self.assertEqual(self.rest()["frames"], [1, 2, 3])
        self.assertEqual(self.post("frame.json", {"frame": 4})[0], 400)
        self.assertEqual(self.post("frame.json", {"frame": 3})[0], 200)
        state = self.wait(lambda state: state["done"] and state["edits"] == 1)
        self.assertEqual((state["frame"], state["camera"]["position"]), (3, [-3, 2, 8]))
        self.expect_rendered("--frames", "3", "--set", "camera.position={keys: {1: [3, 2, 8], 3: [-3, 2, 8]}}")

    def test_commands_of_strangers_are_refused(self):
        self.view()
        self.rest()
        scene = (self.path / "scene.yaml").read_text()
        body = {"action": "write", "edit": 0, "lights": {"sky": {"stops": 1}}}
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"}):
            self.assertEqual(self.post("lights.json", body, headers)[0], 403)
        for token in ("", "0" * 32):
            self.assertEqual(self.post("lights.json", body, token=token)[0], 403)
        for type in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
            self.assertEqual(self.post("lights.json", body, {"Content-Type": type})[0], 415)
        for headers in ({"Transfer-Encoding": "chunked"}, {"Content-Encoding": "gzip"}):
            self.assertEqual(self.post("lights.json", body, headers)[0], 411)
        self.assertEqual(self.post("lights.json", body, {"Content-Length": "-1"})[0], 400)
        self.assertEqual(self.post("lights.json", b"{" + b" " * 20000 + b"}")[0], 413)
        for name in ("", "state.json", "main.js", "none", "../lights.json", "lights.json/"):
            self.assertEqual(self.post(name, body)[0], 405, name)
        self.assertEqual(self.get("lights.json")[0], 405)
        self.assertEqual((self.path / "scene.yaml").read_text(), scene)
        own = {"Origin": f"http://127.0.0.1:{self.port}"}
        self.assertEqual(self.post("lights.json", body, own)[0], 200)
        self.assertIn("radiance: 0.3, intensity: 2", (self.path / "scene.yaml").read_text())
        self.wait(lambda state: state["done"] and state["edits"] == 1)

    def test_no_address_of_the_page_leads_elsewhere(self):
        self.view()
        page = pathlib.Path(__file__).resolve().parents[2] / "view/page"
        for name in ["", *(file.name for file in page.iterdir())]:
            status, body = self.get(name)
            self.assertEqual(status, 200, name)
            self.assertNotIn(b"{{token}}", body)
            self.assertNotIn(b"//", body.replace(b"// ", b""), name)

    def test_a_port_in_use_is_one_line(self):
        self.view()
        _, err = self.run_pelage("view", "scene.yaml", "--port", self.port, code=1)
        self.assertIn(f"--port {self.port}: cannot be used", err)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertEqual(self.get("state.json")[0], 200)
        _, err = self.run_pelage("view", "scene.yaml", "--bind", "192.0.2.1", code=1)
        self.assertIn("this machine has no such address", err)

    def test_a_scene_with_mistakes_is_not_begun(self):
        (self.path / "scene.yaml").write_text("pelage: [")
        _, err = self.run_pelage("view", "scene.yaml", code=3)
        self.assertIn("scene.yaml:1:", err)

    def test_ctrl_c_ends_it_within_a_second(self):
        process = self.view("--set", "render.samples=1000000")
        self.wait(lambda state: state["first_pixels_s"] > 0)
        # One client sends nothing, one sends half a request, one does not read its answer.
        silent = [socket.create_connection(("127.0.0.1", self.port)) for _ in range(3)]
        silent[1].sendall(b"GET / HT")
        silent[2].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
        silent[2].sendall(f"GET /?token={self.token} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n".encode())
        time.sleep(0.1)
        seconds = self.interrupt(process)
        print(f"ended after {seconds:.2f} s")
        for client in silent:
            client.close()

    def test_clients_that_vanish_do_no_harm(self):
        process = self.view("--set", "image={width: 240, height: 160}")
        for _ in range(100):
            client = socket.create_connection(("127.0.0.1", self.port))
            # With this option, close() resets the connection.
            client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            client.sendall(f"GET /layer.bin?name=beauty&token={self.token} HTTP/1.1\r\n"
                           f"Host: 127.0.0.1:{self.port}\r\n\r\n".encode())
            client.close()
        self.rest()
        self.interrupt(process)


if __name__ == "__main__":
    unittest.main()
