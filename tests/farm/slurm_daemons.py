# SPDX-License-Identifier: Apache-2.0
"""A Slurm of one node for tests: its configuration, its daemons and its queue. Needs root."""
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import time

NEEDED = ("slurmctld", "slurmd", "munged", "sbatch")
CONFIG = """ClusterName=pelage
SlurmctldHost=%(host)s(127.0.0.1)
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=root
SlurmdUser=root
SlurmctldPort=%(controller)d
SlurmdPort=%(node)d
AuthType=auth/munge
AuthInfo=socket=%(folder)s/munge/socket
CredType=cred/munge
StateSaveLocation=%(folder)s/state
SlurmdSpoolDir=%(folder)s/spool
SlurmctldPidFile=%(folder)s/slurmctld.pid
SlurmdPidFile=%(folder)s/slurmd.pid
SlurmctldLogFile=%(folder)s/slurmctld.log
SlurmdLogFile=%(folder)s/slurmd.log
SlurmdParameters=config_overrides
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
KillWait=600
MessageTimeout=100
NodeName=%(host)s NodeAddr=127.0.0.1 CPUs=4 RealMemory=8000 State=UNKNOWN
PartitionName=main Nodes=%(host)s Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    """Ports of this machine that nobody uses, and that the kernel gives to nobody who asks for any port."""
    first_of_kernel = int(pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    found = []
    for port in random.sample(range(first_of_kernel // 2, first_of_kernel), 1000):
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)) != 0:
                found.append(port)
        if len(found) == count:
            return found
    raise AssertionError("no free ports")


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
        controller, node = free_ports(2)
        config = folder / "slurm.conf"
        config.write_text(CONFIG % {"host": host, "controller": controller, "node": node, "folder": folder})
        self.environment = {**os.environ, "SLURM_CONF": str(config)}
        self.config, self.key = config, key
        self.delayed = {}  # when start_delayed() first saw a job

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
        delayed = {job for job, _, reason in self.jobs().values() if reason == "BeginTime"}
        self.delayed = {job: self.delayed.get(job, time.monotonic()) for job in delayed}
        for job, seen in self.delayed.items():
            if time.monotonic() > seen + 2.5:  # Slurm revokes a job that starts in the second in which it was queued again
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


def is_installed():
    return all(map(shutil.which, NEEDED)) and os.geteuid() == 0
