"""`brisance submit --engine slurm` on a Slurm of its own: two nodes of this machine, on the loopback interface only.

24 frames are rendered by an array job while one node is killed with all that runs on it. The frames have the bits of a
serial run. Skipped without Slurm's programs.

usage: test_slurm.py BINARY SOURCE_FOLDER [CLASS]
"""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

import test_cli
from test_cli import SMALL, VolumeCase

PROGRAMS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
FRAMES = 24
LONGEST = 420.0  # seconds, of all jobs together

CONFIGURATION = """ClusterName=brisance
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SchedulerParameters=sched_interval=2,batch_sched_delay=0
SlurmdTimeout=10
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 RealMemory=4000
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[3]} CPUs=1 RealMemory=4000
PartitionName=render Nodes=ALL Default=YES State=UP
"""


def program(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Slurm(VolumeCase):
    def setUp(self):
        missing = [name for name in PROGRAMS if program(name) is None]
        if missing:
            self.skipTest(f"no Slurm: {', '.join(missing)} not there")
        super().setUp()
        self.daemons = {}
        (self.folder / "state").mkdir()
        self.configuration = self.write("slurm.conf", CONFIGURATION.format(
            host=socket.gethostname(), user=getpass.getuser(), folder=self.folder, ports=free_ports(4)))
        self.environment = {**os.environ, "SLURM_CONF": str(self.configuration), "SOURCE_DATE_EPOCH": "1000000000"}
        self.addCleanup(self.stop_all)
        self.start("slurmctld", "-c")
        self.start("n1", "-N", "n1")
        self.start("n2", "-N", "n2")
        self.wait_for(lambda: self.ask("sinfo", "-h", "-o", "%t %D") == "idle 2", 60.0, "two idle nodes")

    def start(self, name, *arguments):
        what = "slurmctld" if name == "slurmctld" else "slurmd"
        with (self.folder / f"{name}.out").open("w", encoding="utf-8") as log:
            self.daemons[name] = subprocess.Popen(
                [program(what), "-D", "-f", self.configuration, *arguments], stdout=log, stderr=log,
                env=self.environment)

    def ask(self, *command):
        return subprocess.run([program(command[0]), *command[1:]], env=self.environment, capture_output=True,
                              text=True, check=False).stdout.strip()

    def wait_for(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                self.fail(f"no {what} after {seconds} s\n{self.ask('squeue')}\n{self.ask('sinfo')}\n" +
                          (self.folder / "slurmctld.log").read_text(encoding="utf-8")[-2000:])
            time.sleep(0.5)

    def of_node(self, node):
        """Processes of jobs on a node of this Slurm."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                environment = (entry / "environ").read_bytes().split(b"\0") if entry.name.isdigit() else []
            except OSError:
                continue
            if f"SLURM_CONF={self.configuration}".encode() in environment and \
                    f"SLURMD_NODENAME={node}".encode() in environment:
                found.append(int(entry.name))
        return found

    def keepers(self, processes):
        """Slurm's own processes, which watch over those and would tell how they end."""
        found = set()
        for process in processes:
            try:
                status = pathlib.Path(f"/proc/{process}/status").read_text(encoding="utf-8")
                parent = next(int(line.split()[1]) for line in status.splitlines() if line.startswith("PPid:"))
                if pathlib.Path(f"/proc/{parent}/comm").read_text(encoding="utf-8").startswith("slurmstepd"):
                    found.add(parent)
            except OSError:
                continue
        return sorted(found)

    def kill_node(self, node):
        """As a power cut: the daemon and what it runs."""
        self.daemons[node].kill()
        self.daemons.pop(node).wait()
        jobs = self.of_node(node)
        for process in [*self.keepers(jobs), *jobs]:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def stop_all(self):
        if "slurmctld" not in self.daemons:
            return
        self.ask("scancel", "--user", getpass.getuser())
        for name in [name for name in self.daemons if name != "slurmctld"]:
            self.kill_node(name)
        self.daemons["slurmctld"].terminate()
        self.daemons["slurmctld"].wait(timeout=60)

    def wait_for_jobs(self):
        def all_ended():
            for line in self.ask("squeue", "-h", "-r", "-t", "PD", "-o", "%i %r").splitlines():
                job, reason = line.split(" ", 1)
                if reason == "BeginTime":  # a job that was put back waits for two minutes
                    self.ask("scontrol", "update", f"JobId={job}", "StartTime=now")
            return self.ask("squeue", "-h") == ""

        self.wait_for(all_ended, LONGEST, "end of all jobs")

    def test_a_node_dies_half_way(self):
        pattern = self.make_sequence(range(1001, 1001 + FRAMES))
        serial, farm = self.folder / "serial", self.folder / "farm"
        asked = [pattern, *SMALL, "--set", "output.png=false", "--set", "output.statistics=false", "--make-folders"]
        self.expect(0, "render", *asked, "-o", serial / "a.####.exr", env=self.environment)
        done = self.expect(0, "submit", *asked, "-o", farm / "a.####.exr", "--engine", "slurm", "--memory", 1000,
                           env=self.environment)
        self.assertIn(f"{FRAMES} tasks of {FRAMES} frames", done.stdout)
        self.wait_for(lambda: len(list(farm.glob("a.*.exr"))) >= FRAMES // 4 and self.of_node("n1"), LONGEST,
                      "quarter of the frames")
        killed_at = len(list(farm.glob("a.*.exr")))
        self.kill_node("n1")
        self.wait_for(lambda: "down" in self.ask("sinfo", "-h", "-N", "-n", "n1", "-o", "%T"), 120.0, "dead node")
        self.wait_for_jobs()
        self.assertLess(killed_at, FRAMES)
        self.assertEqual(sorted(path.name for path in farm.glob("*.exr")),
                         sorted(path.name for path in serial.glob("*.exr")))
        for frame in serial.glob("*.exr"):
            self.assertEqual((farm / frame.name).read_bytes(), frame.read_bytes(), frame.name)
        last = next((farm / "logs").glob("*.last.*.log")).read_text(encoding="utf-8")
        self.assertIn(f"{FRAMES} of {FRAMES} frames finished", last)
        again = (self.folder / "slurmctld.log").read_text(encoding="utf-8").lower().count("requeue")
        self.assertGreater(again, 0, "no task was put back")
        print(f"node killed after {killed_at} of {FRAMES} frames; all bits equal", file=sys.stderr)


if __name__ == "__main__":
    test_cli.main(sys.modules[__name__])
