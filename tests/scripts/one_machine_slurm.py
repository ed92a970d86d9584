#!/usr/bin/env python3
"""Slurm on this machine alone: munge, controller and one node in a folder of their own, with ports of their own, ended
by their numbers.

    tests/scripts/one_machine_slurm.py COMMAND [ARG...]      runs a command for which this Slurm is the only one
"""

import getpass
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
PATIENCE_S = 30  # for what has to happen sooner or later
CONFIG = """\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=1000,bf_interval=1
MpiDefault=none
MailProg=/bin/true
KillWait=2
MaxArraySize={longest_array}
NodeName=node NodeAddr=127.0.0.1 NodeHostname={host} CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class NoSlurm(Exception):
    """Why it cannot be started here."""


class OneMachineSlurm:
    """`environment` has what its commands need. To be ended with close()."""

    def __init__(self, longest_array=1001):
        os.environ["PATH"] += ":/usr/sbin:/sbin"  # where the daemons are
        for name in PROGRAMS:
            if not shutil.which(name):
                raise NoSlurm(f"there is no {name}; scripts/packages-fleet.txt has what this needs")
        self.folder = Path(tempfile.mkdtemp(prefix="slurm"))  # a socket has a path of at most 107 characters
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self._processes = []
        try:
            self._start(longest_array)
        except BaseException:
            self.close()
            raise

    def _start(self, longest_array):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(1024))
        version = 2 if os.path.exists("/sys/fs/cgroup/cgroup.controllers") else 1
        (self.folder / "cgroup.conf").write_text(f"CgroupPlugin=cgroup/v{version}\nIgnoreSystemd=yes\n")
        controller_port, node_port = free_ports(2)
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            host=socket.gethostname().partition(".")[0], user=getpass.getuser(), folder=self.folder, cpus=os.cpu_count(),
            controller_port=controller_port, node_port=node_port, longest_array=longest_array))
        # --force: the folders above may be writable for all, as that for temporary files.
        self._spawn("munged", "--foreground", "--force", f"--socket={self.folder}/munge.sock", f"--key-file={key}",
                    f"--pid-file={self.folder}/munged.pid", f"--seed-file={self.folder}/munge.seed",
                    f"--log-file={self.folder}/munged.log")
        self._wait_until((self.folder / "munge.sock").exists)
        self._spawn("slurmctld", "-D")
        self._wait_until(lambda: self.call("scontrol", "ping").returncode == 0)
        self._spawn("slurmd", "-D", "-N", "node")
        self._wait_until(lambda: self.call("sinfo", "--noheader", "--format=%T").stdout.strip() == "idle")

    def call(self, *command):
        return subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False, timeout=PATIENCE_S)

    def _spawn(self, *command):
        with open(self.folder / f"{command[0]}.txt", "wb") as output:
            self._processes.append(subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                                    stdout=output, stderr=subprocess.STDOUT, start_new_session=True))

    def _wait_until(self, condition):
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            for process in self._processes:
                if process.poll() is not None or time.monotonic() > deadline:
                    name = self._processes[-1].args[0]
                    said = (self.folder / f"{name}.txt").read_text(errors="replace").splitlines()
                    raise NoSlurm(f"{name} does not come up: {' / '.join(said[-2:])}")
            time.sleep(0.05)

    def close(self):
        for process in reversed(self._processes):  # the node before the controller, munge last
            process.terminate()
            try:
                process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def free_ports(count):
    """Ports that nobody listens on now."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def main(command):
    if not command or command[0] in ("-h", "--help"):
        sys.exit(__doc__)
    try:
        slurm = OneMachineSlurm()
    except NoSlurm as reason:
        sys.exit(f"one_machine_slurm: {reason}")
    try:
        return subprocess.call(command, env=slurm.environment)
    finally:
        slurm.close()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
