# SPDX-License-Identifier: Apache-2.0
"""Guides as strand files, one per frame: `pelage simulate -o` writes them, `dynamics: {files: ...}` reads them. Run:
guide_files_test.py PROGRAM"""
import math
import struct
import sys
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)
GUIDES = 40
SIMULATED = ["--set", f"grooms.coat.dynamics={{guides: {GUIDES}, diameter: 5e-5, drag: 0.001, youngs_modulus: 1e9, "
             "preroll: 2, directory: a, wind: {velocity: [4, 0, 0], gusts: 0.5, turbulence: 1}}"]
FROM_FILES = ["--set", f"grooms.coat.dynamics={{guides: {GUIDES}, files: guides.%04d.hair}}"]
# The box walks and turns, so that its guides move with the skin, too.
WALKS = ["--set", "characters.box.transform={translate: {keys: {1: [0, 0, 0], 4: [1, 0, 0]}}, "
         "rotate: {keys: {1: [0, 0, 0], 4: [0, 30, 0]}}, scale: 1.5}"]
CLOSED = ["--set", "camera.shutter=[0, 0]"]


def read_hair(path):
    """The strands of a .hair file: lists of points."""
    data = path.read_bytes()
    strands, points, flags, segments = struct.unpack_from("<4I", data, 4)
    assert data[:4] == b"HAIR"
    at, counts = 128, [segments] * strands
    if flags & 1:
        counts = struct.unpack_from(f"<{strands}H", data, at)
        at += 2 * strands
    assert sum(counts) + strands == points and flags & 2
    result = []
    for count in counts:
        numbers = struct.unpack_from(f"<{3 * (count + 1)}f", data, at)
        result.append([numbers[i:i + 3] for i in range(0, len(numbers), 3)])
        at += 12 * (count + 1)
    return result


def length(strand):
    return sum(math.dist(a, b) for a, b in zip(strand, strand[1:]))


class GuideFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.path / "walk.yaml").write_text("pelage: 1\ninclude: scene.yaml\n")

    def simulate(self, *arguments, **options):
        return self.run_pelage("simulate", "scene.yaml", "--groom", "coat", *arguments, **options)

    def grow(self, name, frame, *arguments, **options):
        self.run_pelage("grow", "scene.yaml", "-o", name, "--frames", str(frame), *arguments, **options)
        return read_hair(self.path / name)

    def assert_near(self, some, others, tolerance):
        """The points differ by less than this fraction of the length of their strands."""
        self.assertEqual(len(some), len(others))
        for a, b in zip(some, others):
            self.assertEqual(len(a), len(b))
            for p, q in zip(a, b):
                self.assertLess(math.dist(p, q), tolerance * length(a))

    def one_line(self, err, *texts):
        self.assertEqual(err.count("\n"), 1, err)
        for text in texts:
            self.assertIn(text, err)

    def test_a_simulation_comes_back(self):
        out = self.simulate("-o", "guides.%04d.hair", "--frames", "1-3", *SIMULATED, *WALKS)[0]
        self.assertIn(f"box.coat: {GUIDES} guides of 3 frames written to guides.%04d.hair\n", out)
        self.assertEqual(len(read_hair(self.path / "guides.0003.hair")), GUIDES)
        for frame in (1, 3):
            simulated = self.grow("s.hair", frame, *SIMULATED, *WALKS, *CLOSED)
            read = self.grow("r.hair", frame, *FROM_FILES, *WALKS, *CLOSED)
            # Coordinates below 4 are rounded by at most 2^-23 at both ends of a segment of 0.15, which turns it
            # by less than 3e-6. A simulation rounds the four numbers of a turn by at most 1.6e-5, so by an angle
            # of 6.4e-5, of which the file loses the part about the segment.
            self.assert_near(simulated, read, 7e-5)
        still = self.grow("still.hair", 3, *WALKS, *CLOSED)
        self.assertGreater(max(math.dist(a[-1], b[-1]) for a, b in zip(still, simulated)), 0.05)
        # What is read can be written again. The guides have not lost anything but the rounding of the file.
        self.simulate("-o", "again.%04d.hair", "--frames", "1-3", *FROM_FILES, *WALKS)
        self.assert_near(read_hair(self.path / "guides.0003.hair"), read_hair(self.path / "again.0003.hair"), 1e-5)

    def test_strands_do_not_depend_on_threads_and_formats(self):
        self.simulate("-o", "guides.%04d.hair", "--frames", "1-3", *SIMULATED, "--threads", "1")
        one = self.grow("one.hair", 2, *FROM_FILES, "--threads", "1")
        self.assertEqual(one, self.grow("two.hair", 2, *FROM_FILES, "--threads", "2"))
        first = (self.path / "guides.0003.hair").read_bytes()
        self.simulate("-o", "guides.%04d.hair", "--frames", "2-3", *SIMULATED, "--threads", "2")
        self.assertEqual(first, (self.path / "guides.0003.hair").read_bytes())
        for ending in ("usda", "abc", "tfx"):
            self.simulate("-o", f"guides.%04d.{ending}", "--frames", "1-3", *SIMULATED)
            self.assert_near(one, self.grow("other.hair", 2, "--set",
                             f"grooms.coat.dynamics={{guides: {GUIDES}, files: guides.%04d.{ending}}}"), 1e-5)

    def test_guides_as_groomed_need_no_simulation(self):
        out = self.simulate("-o", "guides.%04d.hair", "--as-groomed", "--frames", "1-4", *FROM_FILES, *WALKS, code=2)[1]
        self.one_line(out, "-o guides.0001.hair: would overwrite a file that this run reads")
        self.simulate("-o", "still.%04d.hair", "--as-groomed", "--frames", "1-4", *FROM_FILES, *WALKS)
        self.assertNotEqual(read_hair(self.path / "still.0001.hair"), read_hair(self.path / "still.0004.hair"))
        self.simulate("-o", "guides.%04d.hair", "--as-groomed", "--frames", "1-4", *SIMULATED, *WALKS)
        self.assertFalse((self.path / "a").exists())
        for ending in ("still", "guides"):
            self.assertEqual((self.path / f"{ending}.0004.hair").read_bytes(),
                             (self.path / "guides.0004.hair").read_bytes())
        groomed = self.grow("groomed.hair", 4, *WALKS)
        self.assert_near(groomed, self.grow("read.hair", 4, *FROM_FILES, *WALKS), 1e-5)
        self.one_line(self.simulate("--as-groomed", *SIMULATED, code=2)[1], "--as-groomed requires")

    def test_every_command_reads_them_without_a_simulation(self):
        self.simulate("-o", "guides.%04d.hair", "--frames", "1-3", *SIMULATED)
        self.render("-o", "a.exr", "--frames", "2", *FROM_FILES)
        self.render("-o", "b.exr", "--frames", "2", *FROM_FILES, "--threads", "1")
        self.render("-o", "c.exr", "--frames", "2")
        pictures = [exr_pixels(self.path / f"{name}.exr") for name in "abc"]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])
        self.run_pelage("why", "scene.yaml", 12, 8, "--frames", "2", *FROM_FILES)
        self.run_pelage("rib", "scene.yaml", "-o", "a.rib", "--frames", "2", *FROM_FILES)
        plan = self.run_pelage("farm", "plan", "scene.yaml", "--frames", "1-3", "-o", "a.%04d.exr", *FROM_FILES)[0]
        self.assertNotIn("simulate", plan)
        err = self.run_pelage("simulate", "scene.yaml", *FROM_FILES, code=2)[1]
        self.one_line(err, "scene.yaml: nothing to simulate (box.coat: guides from guides.%04d.hair)")

    def test_other_coats_are_simulated(self):
        (self.path / "two.yaml").write_text("""pelage: 1
include: scene.yaml
grooms:
  coat: {dynamics: {files: guides.%04d.hair}}
  more: {skin: cube, strands: 100, dynamics: {guides: 10, directory: a, preroll: 0}}
characters: {box: {parts: [{skin: cube, material: hide, grooms: {coat: fur, more: fur}}]}}
""")
        out = self.run_pelage("simulate", "two.yaml", "--frames", "1")[0]
        self.assertIn("not simulated: box.coat: guides from guides.%04d.hair\n", out)
        self.assertIn("box.more: 1 frame simulated", out)
        err = self.run_pelage("simulate", "two.yaml", "-o", "all.%04d.hair", code=2)[1]
        self.one_line(err, "there are box.coat, box.more; choose one groom with --groom")
        self.run_pelage("simulate", "two.yaml", "-o", "more.hair", "--groom", "more", "--frames", "1")
        self.assertEqual(len(read_hair(self.path / "more.hair")), 10)

    def test_an_edited_file_is_seen_by_checkpoints(self):
        self.simulate("-o", "guides.%04d.hair", "--frames", "1-4", *SIMULATED)
        saved = ["-o", "a.exr", "--frames", "2", "--checkpoint", "ck", *FROM_FILES]
        self.render(*saved)
        self.render(*saved, "--resume")
        (self.path / "guides.0004.hair").write_bytes((self.path / "guides.0001.hair").read_bytes())
        self.render(*saved, "--resume")
        (self.path / "guides.0003.hair").write_bytes((self.path / "guides.0001.hair").read_bytes())
        self.one_line(self.render(*saved, "--resume", code=3)[1], "because these differ: guides.%04d.hair; remove the file")

    def test_bad_files_get_one_line(self):
        self.simulate("-o", "guides.%04d.hair", "--frames", "1-3", *SIMULATED)
        render = ["-o", "a.exr", "--frames", "2", *FROM_FILES]
        self.one_line(self.render("-o", "a.exr", "--frames", "9", *FROM_FILES, code=3)[1],
                      "guides.0009.hair: there is no such file")
        file = self.path / "guides.0002.hair"
        whole = file.read_bytes()
        for damaged in (b"", b"no hair", whole[:200], whole[:-1], whole[:4] + b"\xff" * 8 + whole[12:]):
            file.write_bytes(damaged)
            self.one_line(self.render(*render, code=3)[1], "guides.0002.hair")
        file.write_bytes(whole)
        fewer = ["--set", "grooms.coat.dynamics={guides: 30, files: guides.%04d.hair}"]
        self.one_line(self.render("-o", "a.exr", "--frames", "2", *fewer, code=3)[1],
                      "guides.0002.hair: has 40 strands, but coat 'box.coat' has 30 guides")
        self.one_line(self.render(*render, "--set", "grooms.coat.points=6", code=3)[1],
                      "strand 0 has 5 points, but the guides of coat 'box.coat' have 6")

    def test_mistakes_in_the_scene_get_one_line(self):
        for value, message in {
                "{files: guides.hair}": "'guides.hair': expected the frame number in the name, as in guides.%04d.hair",
                "{files: guides.%04d.obj}": "'guides.%04d.obj': expected strand files ending in .hair",
                "{files: g.%d.hair, mode: kinematic}": "`mode` has no effect beside `files`",
                "{files: g.%d.hair, wind: {gusts: 1}}": "`wind` has no effect beside `files`"}.items():
            self.one_line(self.render("-o", "a.exr", "--set", "grooms.coat.dynamics=" + value, code=3)[1], message)
        (self.path / "bad.yaml").write_text("pelage: 1\ninclude: scene.yaml\ngrooms:\n  coat:\n    dynamics:\n"
                                            "      files: guides.hair\n      drag: 1\n")
        err = self.run_pelage("render", "bad.yaml", code=3)[1].splitlines()
        self.assertIn("bad.yaml:6:14: 'guides.hair': expected the frame number", err[0])
        self.assertIn("bad.yaml:7:13: `drag` has no effect beside `files`", err[1])
        crowd = ["--set", "crowds.herd={of: [box], count: 2, area: {type: disc, radius: 3}}"]
        self.one_line(self.render("-o", "a.exr", *FROM_FILES, *crowd, code=3)[1],
                      "animals of a crowd need `mode: kinematic`")
        twin = ["--set", "characters.twin={parts: [{skin: cube, material: hide, grooms: {coat: fur}}]}"]
        self.one_line(self.render("-o", "a.exr", *FROM_FILES, *twin, code=3)[1],
                      "`files` hold the guides of one coat, but box.coat and twin.coat have the groom 'coat'")
        self.one_line(self.simulate("-o", "g.%04d.hair", *SIMULATED, *twin, code=2)[1],
                      "give each character a groom of its own")
        self.one_line(self.simulate("-o", "g.obj", *SIMULATED, code=2)[1], "guides are written as .hair")
        self.one_line(self.simulate("-o", "g.hair", "--frames", "1-2", *SIMULATED, code=2)[1],
                      "put the frame number into the name")
        self.one_line(self.simulate("-o", "g.hair", code=2)[1], "no character has it with `dynamics`")
        self.one_line(self.simulate(code=2)[1], "no character has the groom 'coat' with `dynamics`")
        self.one_line(self.run_pelage("simulate", "scene.yaml", "--groom", "coot", *SIMULATED, code=2)[1],
                      "there is no groom 'coot'; did you mean 'coat'?")
        self.assertNotIn("a", self.names())


if __name__ == "__main__":
    unittest.main()
