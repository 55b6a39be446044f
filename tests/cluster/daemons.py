# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm of this machine only: munged with a key of its own, slurmctld and slurmd on free ports, all files in one folder.
Needs the rights of root; no cgroups."""
import os
import secrets
import shutil
import socket
import subprocess
import tempfile
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol"]
STARTED_WITHIN = 30  # s

# Requeued jobs wait until the credential of their first start has expired: 5 s is the least.
CONFIGURATION = """
ClusterName=twinbox
SlurmctldHost={node}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000
NodeName={node} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing_for_slurm():
    """Why Slurm cannot be started, or None."""
    if os.geteuid() != 0:
        return "Slurm's daemons need the rights of root"
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    return f"{', '.join(missing)} not installed" if missing else None


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Slurm:
    """with Slurm(cores) as slurm: environment is what its commands need."""

    def __init__(self, cores):
        self.folder = tempfile.mkdtemp(prefix="slurm-")
        self.node = socket.gethostname().split(".")[0]
        self.cores, self.processes = cores, []
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(self.folder, "slurm.conf")}

    def __enter__(self):
        for name in ("state", "spool"):
            os.mkdir(os.path.join(self.folder, name))
        with open(os.path.join(self.folder, "munge.key"), "wb", opener=lambda p, f: os.open(p, f, 0o600)) as key:
            key.write(secrets.token_bytes(1024))
        controller, daemon = free_ports(2)
        with open(self.environment["SLURM_CONF"], "w", encoding="ascii") as file:
            file.write(CONFIGURATION.format(node=self.node, folder=self.folder, controller=controller, daemon=daemon,
                                            cores=self.cores))
        try:
            self.start("munged", "--foreground", "--force", *(f"--{name}={self.folder}/{file}" for name, file in
                       [("socket", "munge.socket"), ("key-file", "munge.key"), ("pid-file", "munged.pid"),
                        ("log-file", "munged.log"), ("seed-file", "munge.seed")]))
            self.wait("the socket of munged", lambda: os.path.exists(os.path.join(self.folder, "munge.socket")))
            self.start("slurmctld", "-D", "-c")
            self.start("slurmd", "-D", "-N", self.node)
            self.wait("an idle node", lambda: "idle" in self.run("sinfo", "--noheader", "--format=%T", check=False))
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, *command):
        with open(os.path.join(self.folder, command[0] + ".out"), "wb") as out:
            self.processes.append(subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=out,
                                                   stderr=out))

    def wait(self, what, done):
        end = time.monotonic() + STARTED_WITHIN
        while not done():
            if time.monotonic() > end or any(process.poll() is not None for process in self.processes):
                raise RuntimeError(f"Slurm: no {what} in {STARTED_WITHIN} s\n{self.logs()}")
            time.sleep(0.1)

    def logs(self):
        texts = []
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".out"):
                with open(os.path.join(self.folder, name), encoding="utf-8", errors="replace") as file:
                    texts.append(f"{name}: {file.read()[-800:]}")
        return "\n".join(texts)

    def run(self, *command, check=True, **options):
        """The output of one of its commands."""
        done = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False, **options)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: exit status {done.returncode}: {done.stderr.strip()}")
        return done.stdout
