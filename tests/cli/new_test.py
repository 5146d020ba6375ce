# SPDX-License-Identifier: Apache-2.0
"""First scenes for meshes: `pelage new`. Run: new_test.py PROGRAM"""
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)


class NewTest(ProgramTest):
    def new(self, *arguments, code=0):
        return self.run_pelage("new", "cube.obj", "-o", "fur.yaml", *arguments, code=code)

    def scene(self):
        return (self.path / "fur.yaml").read_text()

    def test_the_scene_of_every_preset_renders(self):
        for preset in ("plush", "short", "long", "woolly", "wiry", "fox", "human-curly"):
            self.new("--preset", preset, "--strands", "300", "--force")
            self.assertIn("strands: 300 ", self.scene())
            said = self.run_pelage("render", "fur.yaml", "-o", "fur.exr", "--quiet", "--samples", "1",
                                   "--set", "image.width=24", "--set", "image.height=16")
            self.assertEqual(said[1], "")

    def test_a_mesh_of_usd_is_one_too(self):
        (self.path / "box.usda").write_text("""#usda 1.0
def Mesh "box"
{
    int[] faceVertexCounts = [3, 3, 3, 3]
    int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0)]
}
""")
        self.run_pelage("new", "box.usda", "-o", "fur.yaml", "--strands", "10")
        self.run_pelage("grow", "fur.yaml", "-o", "a.abc", "--quiet")
        self.assertIn("strands (alembic)", self.run_pelage("info", "a.abc")[0])

    def test_axes_can_be_chosen(self):
        self.assertIn("faces -x, with z up", self.new("--facing", "-x", "--up", "z")[0])
        self.assertIn("up: [0, 0, 1]", self.scene())
        self.assertIn("faces -x", self.new("--facing=-x", "--force")[0])

    def test_the_mesh_is_named_relative_to_the_scene(self):
        self.run_pelage("new", "cube.obj", "-o", "scenes/fur.yaml", "--strands", "10")
        self.assertIn("mesh: '../cube.obj'", (self.path / "scenes/fur.yaml").read_text())
        self.run_pelage("info", "scenes/fur.yaml")

    def test_an_existing_scene_is_kept(self):
        (self.path / "fur.yaml").write_text("mine")
        self.assertIn("-o fur.yaml: the file exists; --force replaces it", self.new(code=2)[1])
        self.assertEqual(self.scene(), "mine")

    def test_mistakes_are_named_and_nothing_is_written(self):
        for arguments, message in ((["--preset", "wooly"], "--preset 'wooly' is not known; did you mean 'woolly'?"),
                                   (["--facing", "w"], "--facing 'w': expected one of x, -x, y, -y, z, -z"),
                                   (["--facing", "y", "--up", "-y"], "--facing y is along --up -y")):
            self.assertIn(message, self.new(*arguments, code=2)[1])
        (self.path / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
        self.assertIn("bad.obj:2:", self.run_pelage("new", "bad.obj", "-o", "fur.yaml", code=3)[1])
        self.assertIn("named .yaml", self.run_pelage("new", "cube.obj", "-o", "fur.txt", code=2)[1])
        self.assertIn("expected an .obj, .usda or .abc mesh", self.run_pelage("new", "a.ply", "-o", "fur.yaml", code=3)[1])
        self.assertFalse((self.path / "fur.yaml").exists())

    def test_info_suggests_what_new_would_do(self):
        said = self.run_pelage("info", "cube.obj")[0]
        self.assertIn("  size: 2 x 2 x 2, longest along x\n", said)
        self.assertIn("  suggested: facing z, up y, scheme catmull-clark, meters_per_unit 1\n", said)
        self.assertIn("  doubled faces: 0\n  texture coordinates: no\n", said)


if __name__ == "__main__":
    unittest.main()
