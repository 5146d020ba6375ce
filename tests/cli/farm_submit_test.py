# SPDX-License-Identifier: Apache-2.0
"""`pelage farm submit`, `status` and `cancel` with programs that stand in for Slurm: sbatch runs each job at once.
tests/farm/slurm_test.py does the same with a real Slurm. Run: farm_submit_test.py PROGRAM"""
import json
import os
import signal
import sys
import time
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)
SMALL = ["--set", "image={width: 64, height: 48}"]
SHOT = ["-o", "a b.%04d.exr", "--frames", "1-2", "--threads", "1", *SMALL]

# Runs the elements of an array one after the other, like a Slurm whose jobs never wait. $FAIL: an element that is killed
# the first time. A job that queues itself again is run again.
SBATCH = r"""#!/bin/bash
echo "$@" >> "$FAKE/calls"
for word; do
  case $word in --array=*) last=${word##*-} ;; --*) ;; *) break ;; esac
  shift
done
number=$(($(cat "$FAKE/number" 2>/dev/null || echo 100) + 1)); echo $number > "$FAKE/number"
for ((i = 1; i <= last; i++)); do
  rm -f "$FAKE/again"; restarts=0
  while :; do
    SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_JOB_ID=$number SLURM_JOB_ID=$number SLURM_RESTART_COUNT=$restarts bash "$@" >> "$FAKE/log" 2>&1
    [ -e "$FAKE/again" ] || break
    rm "$FAKE/again"; restarts=$((restarts + 1))
  done
done
echo "$number;cluster"
"""


class FarmSubmit(ProgramTest):
    def setUp(self):
        super().setUp()
        self.bin = self.path / "bin"
        self.bin.mkdir()
        os.environ["FAKE"] = str(self.bin)
        self.old = os.environ["PATH"]
        os.environ["PATH"] = f"{self.bin}:{self.old}"
        self.addCleanup(os.environ.__setitem__, "PATH", self.old)
        self.fake("sbatch", SBATCH)
        self.fake("scontrol", '#!/bin/sh\necho "$@" > "$FAKE/again"\n')
        self.fake("squeue", '#!/bin/sh\ncat "$FAKE/queue" 2>/dev/null\nexit 0\n')
        self.fake("scancel", '#!/bin/sh\necho "$@" >> "$FAKE/cancelled"\n: > "$FAKE/queue"\n')

    def fake(self, name, text):
        (self.bin / name).write_text(text)
        (self.bin / name).chmod(0o755)

    def farm(self, *arguments, code=0):
        return self.run_pelage("farm", *arguments, code=code)

    def state(self, folder="farm"):
        return {t["name"]: t for t in json.loads(self.farm("status", folder, "--json")[0])["tasks"]}

    def test_a_shot_is_rendered_merged_and_shown(self):
        out, _ = self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1", "--partition", "fur", "--time", "5",
                           "--sbatch=--qos=low")
        self.assertIn("6 tasks in 4 jobs", out)
        calls = (self.bin / "calls").read_text()
        self.assertEqual(calls.count("--partition=fur"), 4)
        self.assertEqual(calls.count("--time=5"), 4)
        self.assertEqual(calls.count("--qos=low"), 4)
        self.assertEqual(calls.count("--dependency=afterok:101 "), 1)
        self.assertEqual(calls.count("--array=1-2"), 2)
        states = self.state()
        self.assertEqual({t["state"] for t in states.values()}, {"done"})
        self.assertGreater(states["render-0001-r0c0"]["peak_rss_bytes"], 1 << 20)
        self.render(*SMALL, "--frames", "1-2", "-o", "whole.%04d.exr")
        for frame in ("0001", "0002"):
            self.assertEqual(exr_pixels(self.path / f"a b.{frame}.exr"), exr_pixels(self.path / f"whole.{frame}.exr"))
            self.assertTrue((self.path / "farm/thumbs" / f"{frame}.png").exists())
        page = (self.path / "farm/index.html").read_text()
        self.assertIn("6 done", page)
        self.assertIn("thumbs/0002.png", page)
        self.assertIn("6 tasks: 6 done", self.farm("status", "farm")[0])

    def test_a_killed_task_is_queued_again_and_a_bad_one_is_not(self):
        self.fake("pelage", '#!/bin/bash\n[ -e "$FAKE/killed" ] || { touch "$FAKE/killed"; kill -9 $$; }\nexit 0\n')
        self.farm("submit", "scene.yaml", *SHOT)
        tasks = self.path / "farm/tasks/render-part0"
        tasks.write_text(tasks.read_text().replace(str(self.PELAGE), str(self.bin / "pelage"), 1))
        (self.path / "farm/state/render-0001").unlink()
        os.environ.update(SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_JOB_ID="101")
        self.addCleanup(os.environ.pop, "SLURM_ARRAY_TASK_ID")
        self.addCleanup(os.environ.pop, "SLURM_ARRAY_JOB_ID")
        for _ in range(2):  # killed, and then queued again
            os.spawnlp(os.P_WAIT, "bash", "bash", str(self.path / "farm/task.sh"), str(tasks))
        events = (self.path / "farm/state/render-0001").read_text()
        self.assertEqual([line.split()[1] for line in events.splitlines() if line], ["start", "end", "requeued", "start", "end"])
        self.assertEqual(self.state()["render-0001"]["starts"], 2)
        page = self.farm("status", "farm") and (self.path / "farm/index.html").read_text()
        self.assertIn("started 2 times", page)

        again = self.bin / "again"  # by scontrol
        self.assertEqual(again.read_text(), "requeue 101_1\n")  # not the whole array
        again.unlink()

        (self.path / "scene.yaml").write_text("nonsense")
        self.farm("submit", "scene.yaml", *SHOT, code=3)  # refused before anything is submitted
        tasks.write_text("render-0001 false\nrender-0002 sh -c 'echo scene.yaml:1:1: bad; exit 3'\n")
        os.environ["SLURM_ARRAY_TASK_ID"] = "2"
        with open(self.path / "farm/logs/render-part0-2.txt", "w") as log:
            pid = os.fork()
            if pid == 0:
                os.dup2(log.fileno(), 1)
                os.execlp("bash", "bash", str(self.path / "farm/task.sh"), str(tasks))
            self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), 3)
        self.assertFalse((self.bin / "again").exists())
        self.assertEqual(self.state()["render-0002"]["state"], "failed")
        self.assertIn("scene.yaml:1:1: bad", self.farm("status", "farm")[0])

    def test_nothing_is_submitted_in_a_dry_run(self):
        out, _ = self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x2", "--dry-run")
        for text in "#!/bin/bash", "render-0002-r1c1 ", "submit merge-0002 1 ", "--mem=":
            self.assertIn(text, out)
        self.assertFalse((self.path / "farm").exists())
        self.assertFalse((self.bin / "calls").exists())

    def test_cancel_is_one_command(self):
        self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1")
        jobs = [line.split()[0] for line in (self.path / "farm/jobs").read_text().splitlines()]
        self.assertGreater(len(jobs), 2)
        (self.bin / "queue").write_text("".join(f"{job} 1 RUNNING\n" for job in jobs))
        self.assertIn(f"{len(jobs)} jobs cancelled", self.farm("cancel", "farm")[0])
        commands = (self.bin / "cancelled").read_text().splitlines()
        self.assertEqual([sorted(command.split()) for command in commands], [sorted(jobs)])

    def test_cancel_ends_only_what_is_queued(self):
        self.farm("submit", "scene.yaml", *SHOT)
        (self.bin / "queue").write_text("101 1 RUNNING\n77 1 RUNNING\n")
        self.assertIn("still in the queue", self.farm("submit", "scene.yaml", *SHOT, code=2)[1])
        self.assertIn("1 job cancelled", self.farm("cancel", "farm")[0])
        self.assertEqual((self.bin / "cancelled").read_text(), "101\n")
        self.assertIn("0 jobs cancelled", self.farm("cancel", "farm")[0])
        self.farm("submit", "scene.yaml", *SHOT)  # finished tasks end at once
        self.assertIn("is finished, skipped", (self.bin / "log").read_text())

    def test_settings_of_the_user_hide_no_job(self):
        self.farm("submit", "scene.yaml", *SHOT)
        (self.bin / "queue").write_text("101 1 PENDING\n")
        self.fake("squeue", '#!/bin/sh\n[ -n "$SQUEUE_STATES$SQUEUE_FORMAT" ] || cat "$FAKE/queue"\n')
        self.fake("scancel", '#!/bin/sh\n[ -n "$SCANCEL_STATE" ] || : > "$FAKE/queue"\n')
        for name in "SQUEUE_STATES", "SQUEUE_FORMAT", "SCANCEL_STATE":
            os.environ[name] = "RUNNING"
            self.addCleanup(os.environ.pop, name)
        self.assertIn("1 job cancelled", self.farm("cancel", "farm")[0])
        self.assertEqual((self.bin / "queue").read_text(), "")

    # $STUBBORN: a job that cannot be cancelled, and makes the whole command fail before it does anything.
    STUBBORN = """#!/bin/sh
case " $* " in
  *" 102 "*) echo 'scancel: error: first' >&2; echo 'scancel: error: Kill job 102' >&2; {} exit 1 ;;
esac
echo "$@" >> "$FAKE/cancelled"
for job; do sed -i "/^$job /d" "$FAKE/queue"; done
"""

    def test_one_job_that_cannot_be_cancelled_spares_no_other(self):
        self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1")
        jobs = [line.split()[0] for line in (self.path / "farm/jobs").read_text().splitlines()]
        (self.bin / "queue").write_text("".join(f"{job} 1 RUNNING\n" for job in jobs))
        self.fake("scancel", self.STUBBORN.format(""))
        error = self.farm("cancel", "farm", code=1)[1]
        self.assertIn(f"{len(jobs) - 1} jobs cancelled, but scancel failed for 102: scancel: error: Kill job 102", error)
        self.assertEqual(len(error.splitlines()), 1)
        self.assertEqual(sorted((self.bin / "cancelled").read_text().split()), sorted(set(jobs) - {"102"}))

    def test_a_job_that_ends_meanwhile_counts_as_cancelled(self):
        self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1")
        (self.bin / "queue").write_text("101 1 RUNNING\n102 1 RUNNING\n103 1 RUNNING\n")
        self.fake("scancel", self.STUBBORN.format('sed -i "/^102 /d" "$FAKE/queue";'))
        self.assertIn("3 jobs cancelled", self.farm("cancel", "farm")[0])

    def test_status_needs_no_slurm(self):
        self.farm("submit", "scene.yaml", *SHOT)
        (self.bin / "squeue").unlink()
        self.assertEqual({t["state"] for t in self.state().values()}, {"done"})

    def test_a_shot_that_slurm_refuses(self):
        self.fake("sbatch", "#!/bin/sh\necho 'sbatch: error: invalid partition' >&2\nexit 1\n")
        self.assertIn("invalid partition", self.farm("submit", "scene.yaml", *SHOT, code=1)[1])

    def test_another_shot_in_the_same_folder_is_refused(self):
        self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1")
        before = {name: (self.path / "farm" / name).read_bytes() for name in ("plan.json", "jobs")}
        scene = (self.path / "scene.yaml").read_text()
        for changed, says in ([*SHOT, "--regions", "2x1", "--set", "render.samples=99"], "`render.samples`"), (
                ["-o", "a b.%04d.exr", "--frames", "1", *SMALL, "--regions", "2x1"], "frames (1,2 before, 1 now)"), (
                [*SHOT, "--regions", "2x2"], "regions (2x1 of 64 x 48 pixels before, 2x2 of 64 x 48 pixels now)"), (
                ["-o", "b.%04d.exr", *SHOT[2:], "--regions", "2x1"], "output ("):
            err = self.farm("submit", "scene.yaml", *changed, code=2)[1]
            self.assertIn("farm: the folder has another shot, because these differ: " + says, err)
            self.assertEqual(err.count("\n"), 1)
        (self.path / "scene.yaml").write_text(scene.replace("color: 0.4", "color: 0.5"))
        self.assertIn("differ: `materials.hide", self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1", code=2)[1])
        (self.path / "scene.yaml").write_text(scene)
        self.assertEqual({name: (self.path / "farm" / name).read_bytes() for name in before}, before)
        # What changes no pixel may change.
        self.farm("submit", "scene.yaml", *SHOT, "--regions", "2x1", "--every", "7s", "--memory", "1G")
        states = self.state()
        self.assertEqual({t["state"] for t in states.values()}, {"done"})
        self.assertEqual({t["starts"] for t in states.values()}, {1})  # finished tasks were only looked at
        self.assertGreater(states["render-0001-r0c0"]["cpu_s"], 0)
        self.assertNotIn("Failures and restarts", (self.path / "farm/index.html").read_text())

    def test_pictures_of_another_shot_do_not_count_as_finished(self):
        self.fake("sbatch", self.IDLE)
        (self.path / "a b.0002.exr").write_text("old")
        for noise in "render.adaptive={noise: 0.05}", "render.time_limit=5":
            err = self.farm("submit", "scene.yaml", *SHOT, "--set", noise, code=2)[1]
            self.assertIn("a b.0002.exr exists, so this frame would count as finished", err)
            self.assertFalse((self.path / "farm/jobs").exists())
        self.farm("submit", "scene.yaml", *SHOT)  # a frame with checkpoints is rendered

    def test_ctrl_c_leaves_no_job_that_no_file_knows(self):
        # Slurm accepts a job at once, and answers late.
        self.fake("sbatch", """#!/bin/bash
number=$(($(cat "$FAKE/number" 2>/dev/null || echo 100) + 1)); echo $number > "$FAKE/number"
echo "$number 1 PENDING" >> "$FAKE/queue"
while [ -e "$FAKE/busy" ]; do sleep 0.01; done
echo "$number"
""")
        self.fake("scancel", '#!/bin/bash\nfor job; do sed -i "/^$job /d" "$FAKE/queue"; done\n')
        (self.bin / "busy").touch()
        process = self.start("farm", "submit", "scene.yaml", *SHOT, "--regions", "2x1")
        while not (self.bin / "queue").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        self.assertIn("stopping after the present job", process.stderr.readline() + process.stderr.readline())
        (self.bin / "busy").unlink()
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, err)
        # The script may submit one more job before it hears of the signal.
        jobs = (self.path / "farm/jobs").read_text().splitlines()
        self.assertEqual(jobs[0], "101 render-0001")
        self.assertLessEqual(len(jobs), 2)
        self.assertIn(f"stopped; {len(jobs)} submitted job", err)
        self.assertEqual((self.bin / "queue").read_text(), "")
        self.assertEqual((self.bin / "number").read_text(), f"{100 + len(jobs)}\n")

    # A Slurm whose jobs never run.
    IDLE = "#!/bin/sh\necho 101\n"

    def test_a_job_that_the_submission_did_not_note_notes_itself(self):
        self.fake("sbatch", self.IDLE)
        self.farm("submit", "scene.yaml", *SHOT)
        (self.path / "farm/tasks/render-part0").write_text("render-0001 true\n")
        os.environ.update(SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_JOB_ID="777")
        self.addCleanup(os.environ.pop, "SLURM_ARRAY_TASK_ID")
        self.addCleanup(os.environ.pop, "SLURM_ARRAY_JOB_ID")
        for _ in range(2):
            os.spawnlp(os.P_WAIT, "bash", "bash", str(self.path / "farm/task.sh"), str(self.path / "farm/tasks/render-part0"))
        self.assertEqual((self.path / "farm/jobs").read_text(), "101 render-part0\n777 render-part0\n")

    def test_no_link_is_followed_in_the_folder_of_a_shot(self):
        self.fake("sbatch", self.IDLE)
        self.farm("submit", "scene.yaml", *SHOT)
        precious = self.path / "precious"
        precious.write_text("precious")
        for name in "index.html", "plan.json", "task.sh", "submit.sh", "submit.log", "jobs", "state/render-0001", "stats/0001.json":
            place = self.path / "farm" / name
            kept = place.read_bytes() if place.exists() else None
            place.unlink(missing_ok=True)
            place.symlink_to(precious)
            self.run_pelage("farm", "status", "farm", code=3 if name == "plan.json" else 0)
            if place.is_symlink():
                self.farm("submit", "scene.yaml", *SHOT, code=0 if name in ("task.sh", "submit.sh") else 3)
            self.assertEqual(precious.read_text(), "precious", name)
            place.unlink()
            if kept is not None:
                place.write_bytes(kept)
        for name in "state", "logs", "tasks", "thumbs", "pieces":
            place, kept = self.path / "farm" / name, self.path / "kept"
            (self.path / "away").mkdir()
            place.mkdir(exist_ok=True)
            place.rename(kept)
            place.symlink_to(self.path / "away")
            self.farm("status", "farm")
            if name != "thumbs":
                self.assertIn("is a symbolic link", self.farm("submit", "scene.yaml", *SHOT, code=3)[1])
            self.assertEqual(list((self.path / "away").iterdir()), [], name)
            (self.path / "away").rmdir()
            place.unlink()
            kept.rename(place)

    def test_a_terminal_obeys_no_log(self):
        self.fake("sbatch", self.IDLE)
        self.farm("submit", "scene.yaml", *SHOT)
        (self.path / "farm/state/render-0001").write_bytes(b"5 start 0 n\x1b[2J 7\n9 end 3\n")
        (self.path / "farm/logs/render-part0-1.txt").write_bytes(b"\x1b]0;title\x07 \xff bad\n")
        out = self.run_pelage("farm", "status", "farm", encoding="latin-1")[0]
        self.assertIn("\\x1b]0;title\\x07", out)
        self.assertIn("n\\x1b[2J", out)
        self.assertNotIn("\x1b", out)
        (self.path / "farm/state/render-0001").write_bytes(b"5 start 0 n\xff 7\n9 end 3\n")
        self.assertEqual(self.state()["render-0001"]["state"], "failed")

    def test_programs_of_slurm_that_print_too_much(self):
        self.fake("sbatch", self.IDLE)
        self.farm("submit", "scene.yaml", *SHOT)
        self.fake("squeue", '#!/bin/sh\nyes | head -c 30000000\necho 101 1 PENDING\n')
        self.assertIn("1 job cancelled", self.farm("cancel", "farm")[0])
        self.fake("squeue", "#!/bin/sh\n")
        self.fake("sbatch", "#!/bin/sh\nyes no | head -c 30000000 | tr '\\n' ' ' >&2\nexit 1\n")
        self.assertLess(len(self.farm("submit", "scene.yaml", *SHOT, code=1)[1]), 1000)
        self.fake("sbatch", "#!/bin/sh\nyes | head -c 3000000\n")
        self.assertIn("sbatch printed no number of a job", self.farm("submit", "scene.yaml", *SHOT, code=1)[1])
        self.assertLess((self.path / "farm/jobs").stat().st_size, 1000)

    def test_mistakes(self):
        self.assertIn("did you mean 'status'?", self.farm("statsu", "farm", code=2)[1])
        self.assertIn("is not the folder of a shot", self.farm("status", ".", code=3)[1])
        self.assertIn("is not the folder of a shot", self.farm("cancel", "nowhere", code=3)[1])
        self.assertIn("-o is required", self.farm("submit", "scene.yaml", code=2)[1])
        (self.bin / "sbatch").unlink()
        os.environ["PATH"] = f"{self.bin}:/nowhere"
        self.assertIn("this machine has no Slurm", self.farm("submit", "scene.yaml", *SHOT, code=1)[1])


if __name__ == "__main__":
    unittest.main()
