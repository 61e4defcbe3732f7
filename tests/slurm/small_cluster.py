# SPDX-License-Identifier: MIT
"""A Slurm of one node on loopback: real munged, slurmctld and slurmd as the user who starts it."""
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import tempfile
import time

DAEMONS = ("munged", "slurmctld", "slurmd")
# cred_expire: a requeued job waits until its credential has expired, two minutes by default.
# config_overrides: the node may have fewer processors and less memory than is said here.
CONFIG = """ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={controller_port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
KillWait=2
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=debug Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def path_of(program):
    """Where the daemon lies, or None; Debian keeps daemons where a user's PATH does not look."""
    return shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_port():
    """A free TCP port."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class SmallCluster:
    """Context manager; `environment` is for Slurm's commands."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="crossnav_slurm_", dir="/tmp"))
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith("SLURM")}
        self.environment["SLURM_CONF"] = str(self.folder / "slurm.conf")
        self.daemons = []

    def __enter__(self):
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _start(self):
        folder = self.folder
        folder.chmod(0o755)  # munged wants to be reachable by everybody
        for name in ("state", "spool"):
            (folder / name).mkdir()
        (folder / "slurm.conf").write_text(CONFIG.format(
            host=socket.gethostname().split(".")[0], folder=folder,
            user=pwd.getpwuid(os.getuid()).pw_name,
            controller_port=free_port(), node_port=free_port()), encoding="ascii")
        key = folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(1024))
        self._daemon("munged", "-F", f"--key-file={key}", f"--socket={folder}/munge.socket",
                     f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log",
                     f"--seed-file={folder}/munge.seed")
        self._until("munged", (folder / "munge.socket").exists)
        self._daemon("slurmctld", "-D", "-f", folder / "slurm.conf")
        self._until("slurmctld", lambda: "UP" in self.ask("scontrol", "ping"))
        self._daemon("slurmd", "-D", "-f", folder / "slurm.conf")
        self._until("slurmd", lambda: "idle" in self.ask("sinfo", "-h", "-o", "%t"))

    def _daemon(self, name, *arguments):
        with open(self.folder / f"{name}.out", "wb") as out:
            self.daemons.append(subprocess.Popen(
                [path_of(name), *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=out,
                stderr=out, env=self.environment))

    def _until(self, name, is_up, limit_s=60):
        end = time.monotonic() + limit_s
        while not is_up():
            if time.monotonic() > end or self.daemons[-1].poll() is not None:
                raise RuntimeError(f"{name} does not start:\n{self.logs()}")
            time.sleep(0.1)

    def logs(self):
        """The ends of all logs, for messages."""
        return "\n".join(f"--- {log.name}\n{log.read_text(errors='replace')[-2000:]}"
                         for log in sorted([*self.folder.glob("*.log"), *self.folder.glob("*.out")]))

    def ask(self, *command):
        """Standard output of one of Slurm's commands, whatever its exit status."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True,
                              check=False).stdout

    def job(self, number):
        """Fields of a job, or of one task ("12_1"), as `scontrol show job` has them."""
        fields = self.ask("scontrol", "-o", "show", "job", str(number)).split()
        return dict(field.split("=", 1) for field in fields if "=" in field)
