# SPDX-License-Identifier: Apache-2.0
"""`pelage why` says of a pixel what `pelage render` shows there."""
import json
import struct
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)


class Why(ProgramTest):
    def why(self, x, y, *arguments, code=0):
        out, err = self.run_pelage("why", "scene.yaml", x, y, *arguments, code=code)
        return out if code == 0 else err

    def test_text_and_json_agree(self):
        kinds = set()
        for x, y in ((10, 6), (11, 10), (11, 8), (0, 8)):
            text = self.why(x, y)
            answer = json.loads(self.why(x, y, "--json"))
            self.assertEqual(answer["pixel"], [x, y])
            self.assertTrue(text.startswith(f"pixel {x} {y}: radiance "), text)
            # Only the cost and the memory of a chunk may differ from run to run.
            self.assertEqual(text.split("\ncost:")[0], answer["text"].split("\ncost:")[0])
            total = [sum(term["radiance"][c] for term in answer["lights"]) for c in range(3)]
            for a, b in zip(total, answer["radiance"]):
                self.assertAlmostEqual(a, b, delta=1e-5 * b + 1e-7)
            kinds.add("strand" if answer["strand"] else "skin" if answer["skin"] else "nothing")
        self.assertEqual(kinds, {"strand", "skin", "nothing"})

    def test_the_result_depends_on_no_thread_and_no_memory(self):
        def rest(*arguments):
            answer = json.loads(self.why(10, 6, "--json", *arguments))
            for key in ("cost", "chunk", "text"):
                del answer[key]
            return answer
        self.assertEqual(rest("--threads", "1"), rest("--threads", "3", "--memory", "1G"))
        self.assertNotEqual(rest()["radiance"], rest("--set", "render.seed=5")["radiance"])

    def test_the_picture(self):
        self.why(10, 6, "-o", "why.png")
        header = (self.path / "why.png").read_bytes()[:24]
        self.assertEqual(header[1:4], b"PNG")
        self.assertGreaterEqual(struct.unpack(">I", header[16:20])[0], 640)

    def test_mistakes_are_one_line(self):
        for arguments, wanted in [(("5000", "3"), "pixel 5000 3: the picture has"), (("3", "5000"), "pixel 3 5000:"),
                                  (("-1", "3"), "pixel -1 3:"), (("1.5", "3"), "X: expected a whole number, got '1.5'"),
                                  (("3", "x"), "Y: expected a whole number, got 'x'"), (("3",), "Y is required"),
                                  (("3", "9" * 30), "Y: expected a whole number"),
                                  (("3", "3", "-o", "a.exr"), "-o a.exr: the picture is written as .png or .jpg"),
                                  (("3", "3", "-o", "cube.obj/a.png"), "cube.obj/a.png: cannot write")]:
            code = 1 if "obj/" in arguments[-1] else 2
            _, err = self.run_pelage("why", "scene.yaml", *arguments, code=code)
            self.assertEqual(err.count("\n"), 1, err)
            self.assertIn(wanted, err)
        self.assertEqual(self.names(), ["cube.obj", "scene.yaml"])
        _, err = self.run_pelage("why", "none.yaml", "3", "3", code=3)
        self.assertIn("none.yaml", err)


if __name__ == "__main__":
    unittest.main()
