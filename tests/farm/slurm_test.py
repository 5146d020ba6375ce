# SPDX-License-Identifier: Apache-2.0
"""A shot on a real Slurm: `pelage farm submit`, and tasks that are killed, stopped, damaged or cancelled. Starts and ends
its own Slurm on this machine, and therefore runs only as root with PELAGE_SLURM=1, where Slurm is installed. Nothing
depends on time: a render that something shall happen to is frozen (SIGSTOP) until it has happened.
Run: slurm_test.py PROGRAM"""
import json
import os
import pathlib
import resource
import signal
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))
from program_scene import SCENE, ProgramTest, exr_pixels  # noqa: E402
from slurm_daemons import NEEDED, Slurm, is_installed  # noqa: E402

ProgramTest.PELAGE = sys.argv.pop(1)
FRAMES = 12
# A herd of five furry cubes, which the camera passes; its coat has a cache, so the shot begins with the task `grow`.
HERD = SCENE.replace("position: [3, 2, 8]", "position: {keys: {1: [3, 2, 8], 12: [1, 3, 9]}}").replace(
    "    points: 5\n", "    points: 5\n    cache: {directory: cache, freeze: width}\n") + """
crowds: {herd: {of: [box], count: 5, spacing: 2.2, area: {type: rectangle, size: [7, 5]}}}
"""
SMALL = ["--set", "image={width: 96, height: 64}", "--set", "render.samples=150"]
SHOT = ["-o", "shot.%04d.exr", *SMALL, "--frames", f"1-{FRAMES}", "--regions", "2x2", "--threads", "1", "--memory", "500M",
        "--every", "0.1s"]


def status_of(process):
    """State of a process, as the kernel prints it: T is frozen. X for a process that has ended."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return "X"


def waits_for_sigterm(process):
    """Whether a SIGTERM waits for a frozen process; also true if the process has ended."""
    try:
        lines = pathlib.Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return True
    waiting = next(int(line.split()[1], 16) for line in lines if line.startswith("ShdPnd"))
    return bool(waiting >> (signal.SIGTERM - 1) & 1)


@unittest.skipUnless(os.environ.get("PELAGE_SLURM") == "1", "starts the daemons of Slurm only with PELAGE_SLURM=1")
@unittest.skipUnless(is_installed(), f"needs root, and slurm-wlm munge: {', '.join(NEEDED)}")
class SlurmTest(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.path / "scene.yaml").write_text(HERD)
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.slurm = Slurm(pathlib.Path(folder.name))
        self.addCleanup(self.slurm.end)
        self.slurm.start()
        self.until(self.slurm.is_ready)

    def until(self, condition):
        """Calls condition() until it returns something true, and returns that. Fails after five minutes."""
        end = time.monotonic() + 300
        while time.monotonic() < end:
            if (found := condition()):
                return found
            time.sleep(0.02)
        return self.fail(f"waited in vain; {self.slurm.jobs()}; {self.logs()[-4000:]}")

    def logs(self):
        return "".join(log.read_text() for log in sorted(self.path.glob("farm/logs/*.txt")))

    def expect_log(self, name, text):
        self.assertIn(text, (self.path / f"farm/logs/{self.elements[name]}.txt").read_text())

    def farm(self, *arguments, **options):
        return self.slurm.call(self.PELAGE, "farm", *arguments, cwd=self.path, **options)

    def submit(self):
        self.farm("submit", "scene.yaml", *SHOT)
        self.tasks = {task["name"]: task for task in json.loads((self.path / "farm/plan.json").read_text())["tasks"]}
        self.elements = {}  # job and element of each task, as Slurm.jobs() names them
        for job in (self.path / "farm/tasks").iterdir():
            for number, line in enumerate(job.read_text().splitlines(), 1):
                self.elements[line.split()[0]] = f"{job.name}-{number}"

    def states(self):
        return {task["name"]: task for task in json.loads(self.farm("status", "farm", "--json"))["tasks"]}

    def events(self, name):
        return [line.split()[1] for line in (self.path / "farm/state" / name).read_text().splitlines() if line]

    def output(self, name):
        return self.path / self.tasks[name]["output"]

    def inodes(self, names):
        return {name: self.output(name).stat().st_ino for name in names}

    def checkpoint(self, name):
        task = self.tasks[name]
        return self.path / "farm/checkpoints" / f"frame-{task['frame']:04}-{'-'.join(map(str, task['region']))}.checkpoint"

    def renders(self):
        """The processes that render a region of the shot now, by the name of their task."""
        names = {task["output"]: name for name, task in self.tasks.items() if "region" in task}
        found = {}
        for place in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (place / "cmdline").read_text(errors="replace").split("\0")
                if words[1:2] == ["render"] and os.readlink(place / "cwd") == str(self.path.resolve()):
                    found[names[words[words.index("-o") + 1]]] = int(place.name)
            except OSError:
                pass  # it has ended
        return found

    def freeze_one(self, taken):
        """Freezes a render that has written a checkpoint and not yet its picture. Returns its task and process."""
        def find():
            for name, process in self.renders().items():
                if name in taken or not self.checkpoint(name).exists():
                    continue
                os.kill(process, signal.SIGSTOP)
                self.until(lambda p=process: status_of(p) in "TXZ")
                if status_of(process) == "T" and not self.output(name).exists():
                    taken.append(name)
                    return name, process
                if status_of(process) == "T":
                    os.kill(process, signal.SIGCONT)
            return None
        return self.until(find)

    def thaw_when_ended(self, process):
        """Lets a frozen render run when a SIGTERM waits for it, or has reached it."""
        self.until(lambda: waits_for_sigterm(process))
        try:
            os.kill(process, signal.SIGCONT)
        except ProcessLookupError:
            pass  # Slurm has let it run

    def job(self, name):
        return self.slurm.jobs().get(self.elements[name])

    def cancel_one(self, taken):
        """Cancels a render, and returns its task. One that was frozen after its last sample still writes its picture; then
        cancels another."""
        while True:
            cancelled, process = self.freeze_one(taken)
            self.slurm.call("scancel", self.job(cancelled)[0])
            self.thaw_when_ended(process)
            self.until(lambda: not self.job(cancelled))  # called before the loop goes on
            if not self.output(cancelled).exists():
                return cancelled

    def finish(self):
        """Waits until no job is left in the queue."""
        def is_over():
            self.slurm.start_delayed()
            return not self.slurm.jobs()
        self.until(is_over)

    def hurt(self):
        """Freezes renders, does to each what a farm can do, and returns their tasks."""
        taken = []
        limited, late = self.freeze_one(taken)  # its time limit of a minute comes while it is frozen
        self.slurm.call("scontrol", "update", f"JobId={self.job(limited)[0]}", "TimeLimit=1")

        cancelled = self.cancel_one(taken)

        killed, process = self.freeze_one(taken)
        os.kill(process, signal.SIGKILL)

        damaged, process = self.freeze_one(taken)
        os.kill(process, signal.SIGKILL)
        self.until(lambda: "requeued" in self.events(damaged))
        self.checkpoint(damaged).write_bytes(self.checkpoint(damaged).read_bytes()[:-100])

        full, process = self.freeze_one(taken)  # its log still fits, its picture and its checkpoints do not
        resource.prlimit(process, resource.RLIMIT_FSIZE, (20000, 20000))
        os.kill(process, signal.SIGCONT)

        self.thaw_when_ended(late)
        self.until(lambda: "requeued" in self.events(limited))
        self.assertEqual(self.states()[limited]["state"], "queued again")
        return limited, cancelled, killed, damaged, full

    def test_a_shot_survives_what_a_farm_does_to_it(self):
        self.submit()
        limited, cancelled, killed, damaged, full = self.hurt()
        self.finish()

        self.expect_log(damaged, self.checkpoint(damaged).name + ": damaged cache file")
        self.expect_log(full, self.tasks[full]["output"] + ": cannot write: File too large")
        for name in (limited, killed, full):
            self.expect_log(name, self.checkpoint(name).name + "  is continued")
        states = self.states()
        merge = f"merge-{self.tasks[cancelled]['frame']:04}"
        unfinished = {name for name, state in states.items() if state["state"] != "done"}
        self.assertEqual(unfinished, {cancelled, merge})
        self.assertEqual({states[name]["state"] for name in unfinished}, {"cancelled"})
        # Nothing else was started twice.
        self.assertEqual({name for name, state in states.items() if state["starts"] > 1}, {limited, killed, damaged, full})
        self.assertEqual({states[name]["starts"] for name in (limited, killed, damaged, full)}, {2})

        finished = self.inodes(name for name, task in self.tasks.items() if "output" in task and name not in unfinished)
        self.submit()  # finished tasks end at once
        self.finish()
        self.assertEqual(self.inodes(finished), finished)
        self.assertEqual(self.logs().count("is finished, skipped"), len(finished))
        self.expect_log(cancelled, self.checkpoint(cancelled).name + "  is continued")
        self.assertEqual({task["state"] for task in self.states().values()}, {"done"})
        self.assertIn(f"{len(self.tasks)} done", (self.path / "farm/index.html").read_text())
        for frame in range(1, FRAMES + 1):
            self.render(*SMALL, "--frames", str(frame), "-o", "whole.exr")
            self.assertEqual(exr_pixels(self.path / f"shot.{frame:04}.exr"), exr_pixels(self.path / "whole.exr"), frame)

    def test_a_cancelled_shot_leaves_the_queue(self):
        self.submit()
        self.until(lambda: any(job[1] == "RUNNING" for job in self.slurm.jobs().values()))
        self.assertIn("still in the queue", self.farm("submit", "scene.yaml", *SHOT, check=False))
        self.assertIn("cancelled", self.farm("cancel", "farm"))
        self.until(lambda: not self.slurm.jobs())
        self.assertIn("cancelled", {task["state"] for task in self.states().values()})


if __name__ == "__main__":
    unittest.main()
