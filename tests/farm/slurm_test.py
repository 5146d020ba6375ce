# SPDX-License-Identifier: Apache-2.0
"""A shot on a real Slurm: `pelage farm submit`, and tasks that are killed, stopped, damaged or cancelled. Starts and ends
its own Slurm on this machine, and therefore runs only as root with PELAGE_SLURM=1, where Slurm is installed. With
PELAGE_SOAK, the shot has 12 frames.
Run: slurm_test.py PROGRAM"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))
from program_scene import ProgramTest, exr_pixels  # noqa: E402

ProgramTest.PELAGE = sys.argv.pop(1)
NEEDED = ("slurmctld", "slurmd", "munged", "sbatch")
SMALL = ["--set", "image={width: 160, height: 96}", "--set", "render.samples=3000"]
FRAMES = 12 if os.environ.get("PELAGE_SOAK") else 2
SHOT = ["-o", "shot.%04d.exr", *SMALL, "--frames", f"1-{FRAMES}", "--regions", "2x2", "--threads", "1", "--memory", "500M",
        "--every", "0.2s"]
CONFIG = """ClusterName=pelage
SlurmctldHost=%(host)s(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort=%(port)d
SlurmdPort=%(next)d
AuthType=auth/munge
AuthInfo=socket=%(folder)s/munge/socket
CredType=cred/munge
StateSaveLocation=%(folder)s/state
SlurmdSpoolDir=%(folder)s/spool
SlurmctldPidFile=%(folder)s/slurmctld.pid
SlurmdPidFile=%(folder)s/slurmd.pid
SlurmctldLogFile=%(folder)s/slurmctld.log
SlurmdLogFile=%(folder)s/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=200000
ReturnToService=2
MpiDefault=none
MailProg=/bin/true
KillWait=5
NodeName=%(host)s NodeAddr=127.0.0.1 CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=%(host)s Default=YES MaxTime=INFINITE State=UP
"""


class Slurm:
    """A Slurm of one node, as child of a folder."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("munge", "state", "spool"):
            (folder / name).mkdir(mode=0o700)
        key = folder / "key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host = os.uname().nodename.split(".")[0]
        port = 20000 + os.getpid() % 20000 * 2
        config = folder / "slurm.conf"
        config.write_text(CONFIG % {"host": host, "port": port, "next": port + 1, "folder": folder})
        self.environment = {**os.environ, "SLURM_CONF": str(config)}
        self.config, self.key = config, key

    def start(self):
        place = {"key-file": self.key, "socket": self.folder / "munge/socket", "pid-file": self.folder / "munge/pid",
                 "log-file": self.folder / "munge/log", "seed-file": self.folder / "munge/seed"}
        self.call("munged", "--force", *(f"--{name}={path}" for name, path in place.items()))
        self.call("slurmctld", "-f", self.config)
        self.call("slurmd", "-f", self.config)

    def call(self, *words, check=True, **options):
        return subprocess.run([str(w) for w in words], env=self.environment, check=check, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options).stdout

    def is_ready(self):
        return self.call("sinfo", "-h", "-o", "%T", check=False).strip() == "idle"

    def jobs(self):
        """Id, state and reason of each array element that is not over, by the name of its log."""
        lines = self.call("squeue", "-h", "-r", "-o", "%j-%K|%i|%T|%r").splitlines()
        return {name: rest for name, *rest in (line.split("|") for line in lines)}

    def start_delayed(self):
        """Starts the jobs that Slurm would start two minutes after they queued themselves again."""
        time.sleep(2.5)  # Slurm revokes a job that starts in the second in which it was queued again
        for job, _, reason in self.jobs().values():
            if reason == "BeginTime":
                self.call("scontrol", "update", f"JobId={job}", "StartTime=now", check=False)

    def processes(self):
        """The daemons, and the processes of Slurm that watch over jobs: they name the folder, or have its configuration."""
        found = []
        for place in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (place / "cmdline").read_bytes() + (place / "environ").read_bytes()
                if str(self.folder).encode() in words and int(place.name) != os.getpid():
                    found.append(int(place.name))
            except OSError:
                pass  # it has ended
        return found

    def end(self):
        """Ends all jobs and daemons, first politely."""
        self.call("scancel", "--user=root", check=False)
        self.wait(lambda: not self.call("squeue", "-h", check=False))
        self.call("scontrol", "shutdown", check=False)
        if (self.folder / "munge/pid").exists():
            self.wait(lambda: not any((self.folder / name).exists() for name in ("slurmctld.pid", "slurmd.pid")))
            os.kill(int((self.folder / "munge/pid").read_text()), signal.SIGTERM)
        if not self.wait(lambda: not self.processes()):
            for process in self.processes():
                os.kill(process, signal.SIGKILL)
            raise AssertionError("daemons of Slurm did not end by themselves")

    @staticmethod
    def wait(condition):
        """Waits for a condition, up to a minute."""
        for _ in range(1200):
            if condition():
                return True
            time.sleep(0.05)
        return False


@unittest.skipUnless(os.environ.get("PELAGE_SLURM") == "1", "starts the daemons of Slurm only with PELAGE_SLURM=1")
@unittest.skipUnless(all(map(shutil.which, NEEDED)) and os.geteuid() == 0, "needs root and Slurm: slurm-wlm munge")
class SlurmTest(ProgramTest):
    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.slurm = Slurm(pathlib.Path(folder.name))
        self.addCleanup(self.slurm.end)
        self.slurm.start()
        self.until(self.slurm.is_ready)

    def until(self, condition):
        """Waits for a condition; the limit is far beyond what it can take."""
        for _ in range(2400):
            if condition():
                return
            time.sleep(0.05)
        self.fail(f"waited in vain; {self.slurm.jobs()}; {self.logs()}")

    def logs(self):
        return "".join(log.read_text() for log in sorted(self.path.glob("farm/logs/*.txt")))

    def process_of(self, region):
        """The process that renders a region; none if it does not run."""
        for status in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (status / "cmdline").read_text().split("\0")
                if words[0].endswith("pelage") and region in words and os.readlink(status / "cwd") == str(self.path.resolve()):
                    return int(status.name)
            except OSError:
                pass
        return None

    def checkpoint(self, task):
        return self.path / "farm/checkpoints" / f"frame-{task['frame']:04}-{'-'.join(map(str, task['region']))}.checkpoint"

    def farm(self, *arguments):
        return self.slurm.call(self.PELAGE, "farm", *arguments, cwd=self.path)

    def submit(self):
        self.farm("submit", "scene.yaml", *SHOT)

    def states(self):
        tasks = json.loads(self.farm("status", "farm", "--json"))["tasks"]
        return {task["name"]: task for task in tasks}

    def finish(self):
        def is_over():
            self.slurm.start_delayed()
            return not self.slurm.jobs()
        self.until(is_over)

    def test_a_shot_survives_what_a_farm_does_to_it(self):
        self.submit()
        tasks = {task["name"]: task for task in json.loads((self.path / "farm/plan.json").read_text())["tasks"]}
        killed, stopped, cancelled = (tasks[f"render-{place}"] for place in ("0001-r0c0", "0001-r0c1", "0002-r1c1"))
        element = {"render-0001-r0c0": "render-0001-1", "render-0001-r0c1": "render-0001-2", "render-0002-r1c1": "render-0002-4"}

        def job(task):
            return self.slurm.jobs().get(element[task["name"]])

        def run_until_saved(task):
            self.until(lambda: self.checkpoint(task).exists() or not job(task))
            return self.process_of(",".join(map(str, task["region"])))

        self.slurm.call("scancel", job(cancelled)[0])  # it waits for those of the first frame
        if (process := run_until_saved(killed)):
            os.kill(process, signal.SIGKILL)
        if run_until_saved(stopped):  # what Slurm does ahead of the time limit
            self.slurm.call("scancel", "--batch", "--signal=USR1", job(stopped)[0], check=False)
        self.until(lambda: (job(killed) or ["", "", "BeginTime"])[2] == "BeginTime")
        self.checkpoint(killed).write_bytes(self.checkpoint(killed).read_bytes()[:-100])
        self.assertEqual(self.states()[killed["name"]]["state"], "queued again")
        self.finish()
        self.assertTrue((self.path / "shot.0001.exr").exists())
        self.assertFalse((self.path / "shot.0002.exr").exists())
        log = self.logs()
        self.assertIn("damaged cache file", log)
        self.assertIn("is continued", log)
        states = self.states()
        self.assertEqual(states[cancelled["name"]]["state"], "cancelled")
        self.assertEqual(states["merge-0001"]["state"], "done")
        self.assertEqual(states["merge-0002"]["state"], "cancelled")
        self.assertEqual({states[task["name"]]["starts"] for task in (killed, stopped)}, {2})
        finished = {name: (self.path / task["output"]).stat().st_ino for name, task in tasks.items()
                    if "region" in task and task is not cancelled}

        self.submit()  # finished tasks end at once
        self.finish()
        for name, inode in finished.items():
            self.assertEqual((self.path / tasks[name]["output"]).stat().st_ino, inode, name)
        self.assertEqual(self.logs().count("is finished, skipped"), len(finished))
        self.assertEqual({task["state"] for task in self.states().values()}, {"done"})
        self.assertIn(f"{5 * FRAMES} done", (self.path / "farm/index.html").read_text())
        self.check_pictures()

    def check_pictures(self):
        """Every picture of the shot equals that of one uninterrupted run."""
        self.render(*SMALL, "--frames", f"1-{FRAMES}", "-o", "whole.%04d.exr")
        for frame in range(1, FRAMES + 1):
            self.assertEqual(exr_pixels(self.path / f"shot.{frame:04}.exr"), exr_pixels(self.path / f"whole.{frame:04}.exr"))

    def test_a_full_disk_delays_a_shot(self):
        pieces = self.path / "farm/pieces"
        pieces.mkdir(parents=True)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(pieces)], check=False).returncode:
            self.skipTest("cannot mount a small disk here")
        self.addCleanup(subprocess.run, ["umount", "-l", str(pieces)], check=False)
        self.submit()
        self.until(lambda: "No space left on device" in self.logs())
        self.until(lambda: any(job[2] == "BeginTime" for job in self.slurm.jobs().values()))
        subprocess.run(["mount", "-o", "remount,size=256m", str(pieces)], check=True)
        self.finish()
        self.assertEqual({task["state"] for task in self.states().values()}, {"done"})
        self.check_pictures()

    def test_a_cancelled_shot_leaves_the_queue(self):
        self.submit()
        self.until(lambda: any(job[1] == "RUNNING" for job in self.slurm.jobs().values()))
        self.assertIn("still in the queue", self.slurm.call(self.PELAGE, "farm", "submit", "scene.yaml", *SHOT,
                                                            cwd=self.path, check=False))
        self.assertIn("cancelled", self.farm("cancel", "farm"))
        self.until(lambda: not self.slurm.jobs())
        self.assertIn("cancelled", {task["state"] for task in self.states().values()})


if __name__ == "__main__":
    unittest.main()
