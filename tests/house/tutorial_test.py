# SPDX-License-Identifier: Apache-2.0
"""tutorial_test.py PELAGE: docs/TUTORIAL.md as a reader follows it; the recipe and the program of README.md."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import tutorial  # noqa: E402

PELAGE = str(pathlib.Path(sys.argv.pop()).resolve())
TEXT = tutorial.PAGE.read_text()
SMALL = "image.width=48 image.height=32 render.samples=1".split()


def thinned(scene):
    """The scene with a tenth of the strands, so that the test is short."""
    return re.sub(r"\b(strands: [1-9]\d*)0\b", r"\1", scene)


def follow(text, folder, to_failure=False):
    """Does in `folder` what the page says, with small pictures; gives the standard error of each block of commands.
    With `to_failure`, stops at the first block that fails."""
    program = folder / "build/release/bin/pelage"
    program.parent.mkdir(parents=True)
    flags = " ".join(f"--set {override}" for override in SMALL)
    program.write_text(f'#!/bin/sh\nif [ "$1" = render ]; then set -- "$@" {flags} --quiet; fi\n'
                       f'exec {shlex.quote(PELAGE)} "$@"\n')
    program.chmod(0o755)
    (folder / "dev").write_text("#!/bin/sh\n")   # the program is built already
    (folder / "dev").chmod(0o755)
    for name in ("examples", "tools"):
        (folder / name).symlink_to(ROOT / name)
    place, path, scene, said = folder, os.environ["PATH"], {}, []
    for kind, content in tutorial.blocks(text):
        if kind == "yaml":
            scene.update(tutorial.sections(content))
            (place / "hamster.yaml").write_text(thinned("\n".join(scene.values())))
        elif kind == "sh":
            run = subprocess.run(["bash", "-euc", content + '\nprintf "\\n%s\\n%s" "$PWD" "$PATH"'], cwd=place,
                                 env={**os.environ, "PATH": path}, capture_output=True, text=True, timeout=240)
            said.append((run.returncode, run.stderr))
            if to_failure and run.returncode != 0:
                break
            if "pelage new" in content and run.returncode == 0:
                scene = tutorial.sections((place / "hamster.yaml").read_text())
            if run.returncode == 0:
                place, path = pathlib.Path(run.stdout.splitlines()[-2]), run.stdout.splitlines()[-1]
    return place, said


class Tutorial(unittest.TestCase):
    def test_every_command_and_every_scene_works(self):
        with tempfile.TemporaryDirectory() as name:
            place, said = follow(TEXT, pathlib.Path(name).resolve())
            self.assertGreaterEqual(len(said), 7)
            self.assertEqual(said, [(0, "")] * len(said))
            self.assertGreater((place / "hamster.png").stat().st_size, 1000)
            self.assertNotIn("vt ", (place / "body.obj").read_text())

    def test_a_mistake_in_the_page_is_noticed(self):
        for wrong in (TEXT.replace("clump:", "clmup:"), TEXT.replace("cd hamster\n", "cd hamper\n", 1)):
            with tempfile.TemporaryDirectory() as name:
                _, said = follow(wrong, pathlib.Path(name).resolve(), to_failure=True)
                self.assertNotEqual(said[-1][0], 0)

    def test_every_step_shows_its_picture(self):
        steps = re.split(r"^## (?=\d)", TEXT, flags=re.MULTILINE)[1:]
        self.assertEqual([len(re.findall(r"!\[", step)) for step in steps], [1] * len(steps))
        for picture in tutorial.scenes(TEXT, {}):
            self.assertLessEqual((tutorial.PAGE.parent / picture).stat().st_size, tutorial.MAX_BYTES, picture)


class Readme(unittest.TestCase):
    README = (ROOT / "README.md").read_text()

    def test_its_recipe_renders_a_mesh_without_texture_coordinates(self):
        new = re.search(r"build/release/bin/pelage (new my_animal.obj -o fur.yaml)", self.README).group(1)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            subprocess.run([ROOT / "examples/make_hamster.py", folder], check=True)
            (folder / "body.obj").rename(folder / "my_animal.obj")
            subprocess.run([PELAGE, *new.split(), "--strands", "3000"], cwd=folder, check=True, capture_output=True)
            command = [PELAGE, "render", folder / "fur.yaml", "-o", folder / "fur.exr", "--quiet"]
            for override in SMALL:
                command += ["--set", override]
            run = subprocess.run(command, capture_output=True, text=True, timeout=240)
            self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_its_program_is_that_of_the_consumer(self):
        """Which another test builds and runs."""
        consumer = (ROOT / "tests/consumer/consumer.cpp").read_text().splitlines()
        program = dict(tutorial.blocks(self.README))["cpp"].splitlines()
        self.assertLessEqual(len(program), 32)
        self.assertEqual([line for line in program if line not in consumer], [])

    def test_its_error_is_what_pelage_says(self):
        said = re.search(r"`(rat\.yaml:.*?)`", self.README).group(1)
        with tempfile.TemporaryDirectory() as name:
            scene = pathlib.Path(name, "rat.yaml")
            scene.write_text((ROOT / "examples/rat.yaml").read_text().replace("- clump:", "- clmup:", 1))
            run = subprocess.run([PELAGE, "info", scene], capture_output=True, text=True, timeout=60)
            self.assertIn(said, run.stderr)


if __name__ == "__main__":
    unittest.main()
