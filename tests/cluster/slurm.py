# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies as job arrays of a Slurm that this test starts on this machine (daemons.py), as root.

    slurm.py TWINBOX SOURCES [SEED]

Each study is run twice in 16 tasks, of which four are killed by SIGKILL at random times. The first time the killed tasks
are requeued by scontrol. The second time scenes/cluster/slurm.sh does it all: its job behind the array submits what
`twinbox merge` names. The files must be those of one process, byte for byte, but for times."""
import os
import random
import re
import signal
import sys
import tempfile
import time

import daemons
import shards

TASKS, KILLS = 16, 4
ENDED_WITHIN = 240  # s, all tasks of an array
STUDIES = {
    "stability": "stability SCENES/stability/stack_height.yaml --vary height --vary iterations "
                 "--methods engine,momentum,block",
    "chart": "chart SCENES/stack.yaml SCENES/pyramid_settled.yaml --quick --launches 64 --methods engine,momentum,interior",
}


def find_tasks(twinbox, job):
    """Processes of twinbox in tasks of the job: {task: process}."""
    return {int(variables["SLURM_ARRAY_TASK_ID"]): process for process, variables in shards.find_processes(twinbox).items()
            if variables.get("SLURM_ARRAY_JOB_ID") == job}


class Killer:
    def __init__(self, twinbox, slurm, seed):
        self.twinbox, self.slurm, self.random = twinbox, slurm, random.Random(seed)

    def strike(self, job, killed):
        """Kills a task that is at work and was not killed before. Returns it."""
        end = time.monotonic() + ENDED_WITHIN
        while time.monotonic() < end:
            time.sleep(self.random.uniform(0.05, 2))
            tasks = {task: process for task, process in find_tasks(self.twinbox, job).items() if task not in killed}
            if tasks:
                task = self.random.choice(sorted(tasks))
                os.kill(tasks[task], signal.SIGKILL)
                return task
        raise shards.Failure(f"job {job}: no task to kill")

    def state(self, job, task):
        return re.search(r"JobState=(\w+)", self.slurm.run("scontrol", "show", "job", f"{job}_{task}"))[1]

    def kill_some(self, job, requeue):
        killed = []
        while len(killed) < KILLS:
            killed.append(self.strike(job, killed))
            while self.state(job, killed[-1]) in ("RUNNING", "COMPLETING", "PENDING"):
                time.sleep(0.1)
            if self.state(job, killed[-1]) == "COMPLETED":
                killed.pop()  # it had ended just before
            elif requeue:
                self.slurm.run("scontrol", "requeue", f"{job}_{killed[-1]}")
        return killed


def wait_for_jobs(slurm):
    end = time.monotonic() + ENDED_WITHIN
    while slurm.run("squeue", "--noheader"):
        if time.monotonic() > end:
            raise shards.Failure("jobs are left:\n" + slurm.run("squeue"))
        time.sleep(0.2)


def requeued(twinbox, slurm, killer, name, command):
    output = f"{name}-requeued"
    job = slurm.run("sbatch", "--parsable", f"--array=1-{TASKS}", "--requeue", "--ntasks=1", "--output=/dev/null",
                    "--wrap", f"exec twinbox {' '.join(twinbox.words(command))} -o {output}").strip()
    killed = killer.kill_some(job, True)
    wait_for_jobs(slurm)
    twinbox.run(f"merge {output}")
    return output, f"killed and requeued {killed}"


def retried(twinbox, slurm, killer, name, command):
    output = f"{name}-retried"
    script = os.path.join(twinbox.scenes, "cluster", "slurm.sh")
    slurm.run(script, output, *twinbox.words(command), "-o", output)
    job = min(slurm.run("squeue", "--noheader", "--format=%F").split(), key=int)
    killed = killer.kill_some(job, False)
    wait_for_jobs(slurm)
    rounds = 0
    for log in filter(lambda log: log.startswith("slurm-"), os.listdir(".")):
        with open(log, encoding="utf-8") as file:
            rounds += f"{output}/shards: error: " in file.read()
    if rounds == 0:
        raise shards.Failure(f"{output}: nothing was missing after {killed} were killed")
    return output, f"killed {killed}, submitted again {rounds} times"


def check(twinbox):
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(10**6)
    print(f"slurm: seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="cluster-") as folder, daemons.Slurm(len(os.sched_getaffinity(0))) as slurm:
        os.chdir(folder)
        slurm.environment = {**twinbox.environment, "SLURM_CONF": slurm.environment["SLURM_CONF"]}
        killer = Killer(twinbox, slurm, seed)
        for name, command in STUDIES.items():
            twinbox.run(f"{command} -o {name}")
            for way in (requeued, retried):
                begun = time.monotonic()
                output, how = way(twinbox, slurm, killer, name, command)
                pieces = shards.expect_clean(os.path.join(output, "shards"))
                files = shards.expect_equal(output, name)
                print(f"{output}: {TASKS} tasks, {how}; {pieces} pieces, {files} files as without shards, "
                      f"{time.monotonic() - begun:.0f} s", flush=True)
        os.chdir("/")


if __name__ == "__main__":
    reason = daemons.missing_for_slurm()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    shards.main(check)
