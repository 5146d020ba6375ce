# SPDX-License-Identifier: Apache-2.0
"""Where a program writes: files that must not be replaced, links, modes, and outputs that take nothing."""
import os
import resource
import stat
import subprocess
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)


class Output(ProgramTest):
    def refuses(self, *arguments, says):
        out, err = self.render(*arguments, code=2)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn(says, err)

    def test_statistics_replace_neither_the_picture_nor_the_scene(self):
        scene = (self.path / "scene.yaml").read_text()
        self.refuses("-o", "a.exr", "--stats", "a.exr", says="--stats")
        self.refuses("-o", "a.exr", "--stats", "./x/../a.exr", says="a.exr")
        self.refuses("-o", "a.exr", "--stats", "scene.yaml", says="scene.yaml")
        self.refuses("-o", "%d.exr", "--frames", "1-3", "--stats", "3.exr", says="3.exr")
        os.link(self.path / "scene.yaml", self.path / "hard")
        os.symlink("scene.yaml", self.path / "soft")
        os.symlink("a.exr", self.path / "to the picture")
        self.refuses("--stats", "hard", says="scene.yaml")
        self.refuses("--stats", "soft", says="scene.yaml")
        self.refuses("-o", "a.exr", "--stats", "to the picture", says="a.exr")
        os.symlink("scene.yaml", self.path / "b.exr")
        self.refuses("-o", "b.exr", says="scene.yaml")
        (self.path / "outer.yaml").write_text("include: scene.yaml\n")
        _, err = self.run_pelage("render", "outer.yaml", "--stats", "scene.yaml", code=2)
        self.assertIn("scene.yaml", err)
        self.assertEqual((self.path / "scene.yaml").read_text(), scene)
        self.assertFalse((self.path / "a.exr").exists())

    def test_nothing_that_the_scene_names_is_replaced(self):
        scene = self.path / "scene.yaml"
        text = scene.read_text()
        self.render("-o", "sky.exr")
        self.run_pelage("grow", "scene.yaml", "-o", "guides.hair", "--quiet")
        text = text.replace("radiance: 0.3", "file: sky.exr").replace("color: 0.4", "color: {map: sky.exr}")
        scene.write_text(text.replace("operators: [", "operators: [{guides: {file: guides.hair}}, "))
        os.symlink("guides.hair", self.path / "link.hair")
        before = {name: (self.path / name).read_bytes() for name in self.names()}
        self.refuses("-o", "a.exr", "--stats", "cube.obj", says="cube.obj")
        self.refuses("-o", "a.exr", "--stats", "guides.hair", says="guides.hair")
        self.refuses("-o", "./sky.exr", says="sky.exr")
        for output in ("guides.hair", "link.hair"):
            _, err = self.run_pelage("grow", "scene.yaml", "-o", output, "--quiet", code=2)
            self.assertIn("guides.hair", err)
        self.assertEqual({name: (self.path / name).read_bytes() for name in self.names()}, before)

    def test_inputs_that_are_loops_of_links_cannot_be_read(self):
        scene, text = self.path / "scene.yaml", (self.path / "scene.yaml").read_text()
        strands = text[text.index("strands: 400"):text.index("materials:")].rstrip()
        for kind, old, new in (("mesh", "mesh: cube.obj", "mesh: loop.obj"), ("strands", strands, "strands_file: loop.hair"),
                               ("environment", "radiance: 0.3", "file: loop.exr"),
                               ("RIB", "lights:", "archives: {a: {rib: loop.rib}}\nlights:"),
                               ("include", "pelage: 1", "pelage: 1\ninclude: loop.yaml")):
            self.assertIn(old, text)
            scene.write_text(text.replace(old, new))
            name = new[new.index("loop."):].split()[0].rstrip("}")
            if not (self.path / name).is_symlink():
                (self.path / name).symlink_to(name)
            err = self.render("-o", "a.exr", code=3)[1]
            self.assertRegex(err, rf"^scene.yaml:\d+:\d+: .*{name}: cannot read: [^\n]*\n$", kind)

    def test_other_commands_refuse_it_too(self):
        self.render("-o", "a.exr")
        before = (self.path / "a.exr").read_bytes()
        for arguments in (("motionblur", "a.exr", "-o", "b.exr", "--stats", "a.exr"),
                          ("motionblur", "a.exr", "-o", "b.exr", "--stats", "b.exr"),
                          ("grow", "scene.yaml", "-o", "a.hair", "--stats", "a.hair"),
                          ("grow", "scene.yaml", "--stats", "scene.yaml"),
                          ("compare", "scene.yaml", "--stats", "scene.yaml")):
            _, err = self.run_pelage(*arguments, "--quiet", code=2)
            self.assertIn("--stats", err)
        self.assertEqual((self.path / "a.exr").read_bytes(), before)

    def test_no_frame_replaces_an_input(self):
        self.run_pelage("grow", "scene.yaml", "-o", "g.0002.hair", "--quiet")
        before = (self.path / "g.0002.hair").read_bytes()
        err = self.run_pelage("grow", "scene.yaml", "-o", "g.%04d.hair", "--frames", "1-3", "--quiet", "--set",
                              "grooms.coat={skin: cube, strands_file: g.0002.hair}", code=2)[1]
        self.assertIn("-o g.0002.hair: would overwrite", err)
        self.assertEqual((self.path / "g.0002.hair").read_bytes(), before)

    def test_an_empty_name_is_refused(self):
        self.refuses("-o", "", says="-o")
        self.refuses("--stats", "", says="--stats")
        for arguments in (("compare", "scene.yaml", "-o", ""), ("grow", "scene.yaml", "-o", ""),
                          ("measure", "bounds", "scene.yaml", "-o", "")):
            _, err = self.run_pelage(*arguments, "--quiet", code=2)
            self.assertIn("-o", err)

    def test_a_link_stays_a_link_and_a_mode_the_mode(self):
        (self.path / "disk").mkdir()
        os.symlink("disk/a.exr", self.path / "a.exr")
        self.render("-o", "a.exr")
        self.assertTrue((self.path / "a.exr").is_symlink())
        os.chmod(self.path / "disk/a.exr", 0o640)
        self.render("-o", "a.exr")
        self.assertTrue((self.path / "a.exr").is_symlink())
        self.assertEqual(stat.S_IMODE((self.path / "disk/a.exr").stat().st_mode), 0o640)
        self.assertEqual(os.listdir(self.path / "disk"), ["a.exr"])

    def test_a_file_that_may_not_grow_is_a_write_error(self):
        self.render("-o", "a.exr")
        before = (self.path / "a.exr").read_bytes()
        for limit in (1000, len(before) // 2, len(before) - 1):
            cut = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            _, err = self.render("-o", "a.exr", code=1, preexec_fn=cut)
            self.assertIn("a.exr: cannot write: File too large", err)
            self.assertEqual(err.count("\n"), 1, err)
            self.assertEqual((self.path / "a.exr").read_bytes(), before)
        self.assertEqual(self.names(), ["a.exr", "cube.obj", "scene.yaml"])

    def test_output_that_does_not_arrive_is_an_error(self):
        with open("/dev/full", "w") as full:
            _, err = self.run_pelage("manual", code=1, stdout=full)
            self.assertEqual(err, "pelage: error: cannot write to standard output: No space left on device\n")
            self.run_pelage("info", "scene.yaml", code=1, stdout=full)
            self.run_pelage("--help", code=1, stdout=full)
        _, err = self.run_pelage("manual", code=1, stdout=None, preexec_fn=lambda: os.close(1))
        self.assertIn("standard output", err)
        self.assertEqual(err.count("\n"), 1)
        # Nothing to print: nothing is missing.
        self.run_pelage("render", "scene.yaml", "-o", "a.exr", "--quiet", stdout=None,
                        preexec_fn=lambda: [os.close(i) for i in (0, 1, 2)])
        self.run_pelage("info", "a.exr")

    def test_a_reader_that_leaves_ends_it_silently(self):
        reader, writer = os.pipe()
        os.close(reader)
        _, err = self.run_pelage("manual", code=1, stdout=writer)
        os.close(writer)
        self.assertEqual(err, "")
        # Nor does a reader of messages end an hour of rendering.
        reader, writer = os.pipe()
        os.close(reader)
        self.run_pelage("render", "scene.yaml", "-o", "a.exr", "--progress", "json", stderr=writer)
        os.close(writer)
        self.assertTrue((self.path / "a.exr").exists())


if __name__ == "__main__":
    unittest.main()
