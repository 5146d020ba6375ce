# SPDX-License-Identifier: Apache-2.0
"""`pelage simulate`: stored motion, what uses it, and what happens without it. Run: simulate_test.py PROGRAM"""
import sys
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)
DYNAMICS = ("grooms.coat.dynamics={guides: 40, diameter: 5e-5, drag: 0.001, youngs_modulus: 1e9, preroll: 2, "
            "wind: {velocity: [4, 0, 0], gusts: 0.5, turbulence: 1}}")
MOVING = ["--set", DYNAMICS]


class Simulate(ProgramTest):
    def simulate(self, frames, folder, *arguments, **options):
        return self.run_pelage("simulate", "scene.yaml", "--frames", frames, *MOVING,
                               "--set", f"grooms.coat.dynamics.directory={folder}", *arguments, **options)

    def motion(self, folder):
        return {p.name: p.read_bytes() for p in (self.path / folder / "motion").glob("motion-[0-9a-f]*")}

    def pixels(self, frame, *arguments):
        self.render("-o", "a.exr", "--frames", str(frame), *arguments)
        return exr_pixels(self.path / "a.exr")

    def test_frames_do_not_depend_on_runs_and_threads(self):
        self.simulate("1-3", "a", "--threads", "1")
        self.simulate("1-2", "b", "--threads", "2")
        out = self.simulate("3", "b", "--threads", "2")[0]
        self.assertRegex(out, r"^box\.coat: 1 frame simulated from frame 3, ")
        self.assertEqual(self.motion("a"), self.motion("b"))
        self.assertEqual(len(self.motion("a")), 5)  # -0, 1 .. 4: two frames of preroll and half a frame behind

    def test_colliders_may_shrink_to_nothing(self):
        (self.path / "hand.yaml").write_text("""pelage: 1
include: scene.yaml
characters:
  hand:
    parts: [{skin: cube, material: hide}]
    transform: {translate: [0, 2.1, 0], scale: {keys: {1: 1, 2: 1e-9}}}
grooms: {coat: {dynamics: {guides: 40, diameter: 5e-5, preroll: 0, collide_with: [hand]}}}
""")
        self.run_pelage("simulate", "hand.yaml", "--frames", "1-3", "--set", "grooms.coat.dynamics.directory=c")

    def test_the_plan_of_a_shot_has_no_flag_that_it_does_not_know(self):
        plan = self.run_pelage("farm", "plan", "scene.yaml", "--frames", "1", "-o", "a.%04d.exr", *MOVING,
                               "--allow-procedurals")[0].splitlines()[0]
        self.assertIn("--allow-procedurals", plan)
        self.simulate("1", "a", "--allow-procedurals")

    def test_damaged_frames_are_made_again(self):
        self.simulate("1-2", "a")
        before = self.motion("a")
        for name in before:
            (self.path / "a/motion" / name).write_bytes(before[name][:-9] + b"damaged!!")
        out, err = self.simulate("1-2", "a")
        self.assertIn("it is made again", err)
        self.assertNotIn("found", out)
        self.assertEqual(self.motion("a"), before)
        self.assertIn("3 found", self.simulate("1-2", "a")[0])

    def test_pictures_move_and_name_what_is_missing(self):
        folder = ["--set", "grooms.coat.dynamics.directory=a"]
        err = self.render("-o", "a.exr", "--frames", "3", *MOVING, *folder, code=3)[1]
        self.assertIn("coat 'box.coat' has no simulated motion for frame 3; run: pelage simulate scene.yaml --set ", err)
        self.assertIn(" --frames 3\n", err)
        self.assertEqual(err.count("\n"), 1)
        (self.path / "zoo.yaml").write_text("pelage: 1\ninclude: scene.yaml\n")
        err = self.run_pelage("render", "zoo.yaml", "-o", "a.exr", *MOVING, *folder, code=3)[1]
        self.assertIn(f"run: pelage simulate zoo.yaml --set '{DYNAMICS}' --set {folder[1]} --frames 1", err)
        # The plan of a shot makes the motion first.
        plan = self.run_pelage("farm", "plan", "scene.yaml", "--frames", "1-3", "-o", "a.%04d.exr", *MOVING)[0]
        self.assertEqual(plan.splitlines()[0],
                         f"pelage simulate scene.yaml --set '{DYNAMICS}' --frames 1-3")
        self.simulate("3", "a")
        moved = self.pixels(3, *MOVING, *folder)
        self.assertNotEqual(moved, self.pixels(3))
        self.assertEqual(moved, self.pixels(3, *MOVING, *folder, "--threads", "1", "--set", "render.bounds=none"))
        # Before the simulation begins, the coat is as groomed.
        self.assertEqual(self.pixels(-4, *MOVING, *folder, "--set", "camera.shutter=[0, 0]"),
                         self.pixels(-4, "--set", "camera.shutter=[0, 0]"))

    def test_strands_are_written_frame_by_frame(self):
        moving = [*MOVING, "--set", "grooms.coat.dynamics.directory=a"]
        self.simulate("1-3", "a")
        self.run_pelage("grow", "scene.yaml", "-o", "coat.%02d.hair", "--frames", "1-3x2", *moving)
        self.run_pelage("grow", "scene.yaml", "-o", "one.hair", "--frames", "3", *moving)
        first, third = ((self.path / f"coat.0{i}.hair").read_bytes() for i in (1, 3))
        self.assertFalse((self.path / "coat.02.hair").exists())
        self.assertNotEqual(first, third)
        self.assertEqual(third, (self.path / "one.hair").read_bytes())

    def test_other_skins_move_guides(self):
        # A second box falls on the first one.
        other = ["--set", "characters.lid={parts: [{skin: cube, material: hide}], transform: {translate: {keys: "
                 "{1: [0, 3, 0], 2: [0, 1.3, 0]}}}}"]
        collide = other + ["--set", "grooms.coat.dynamics.collide_with=[lid, box]"]
        self.simulate("1-2", "a", "--threads", "1", *other)
        self.simulate("1-2", "b", "--threads", "1", *collide)
        self.simulate("1-1", "c", *collide)
        self.simulate("2-2", "c", "--threads", "2", *collide)
        self.assertEqual(self.motion("b"), self.motion("c"))
        self.assertNotEqual(sorted(self.motion("a").values()), sorted(self.motion("b").values()))
        out = self.simulate("1", "b", "--explain", *collide, "--set", "characters.lid.transform.scale=0.5")[0]
        self.assertRegex(out, r"lid\.0 scale +0: 0\.5  \(stale: was 0: 1\)")

    def test_kinematic_coats_need_no_simulation(self):
        kinematic = ["--set", "grooms.coat.dynamics={mode: kinematic, guides: 20}", "--set",
                     "characters.box.transform.translate={keys: {1: [0, 0, 0], 4: [1, 0, 0]}}"]
        self.assertNotEqual(self.pixels(4, *kinematic), self.pixels(4, *kinematic[2:]))
        self.assertEqual(self.pixels(4, *kinematic), self.pixels(4, *kinematic, "--threads", "1"))
        # Before the box moves.
        self.assertEqual(self.pixels(-40, *kinematic), self.pixels(-40, *kinematic[2:]))
        crowd = ["--set", "crowds.herd={of: [box], count: 2, area: {type: disc, radius: 3}}"]
        err = self.render("-o", "a.exr", *MOVING, *crowd, code=3)[1]
        self.assertIn("animals of a crowd need `mode: kinematic`", err)

    def test_changes_are_explained_and_old_motion_is_pruned(self):
        self.simulate("1", "a")
        out = self.simulate("1", "a", "--explain", "--set", "grooms.coat.dynamics.drag=0.002")[0]
        self.assertRegex(out, r"drag +0\.002  \(stale: was 0\.001\)")
        self.assertIn("0 files removed", self.simulate("1", "a", "--prune")[0])  # used within the hour

    def test_mistakes_get_one_line(self):
        for key, message in {"dynamics={after: lenght}": "no operator called 'lenght'; did you mean 'length'?",
                             "dynamics={stiffness: 3}": "'stiffness'",
                             "dynamics={collide_with: [bix]}": "there is no character 'bix'; did you mean 'box'?",
                             "dynamics={density: 0}": "expected a number > 0"}.items():
            err = self.run_pelage("simulate", "scene.yaml", "--set", "grooms.coat." + key, code=3)[1]
            self.assertIn(message, err)
            self.assertEqual(err.count("\n"), 1, err)
        err = self.run_pelage("simulate", "scene.yaml", code=2)[1]
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn("no groom of a character has `dynamics`", err)


if __name__ == "__main__":
    unittest.main()
