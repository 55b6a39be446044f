# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts of scenes/cluster for GNU parallel and OpenMPI.

    scripts.py TWINBOX SOURCES parallel|mpirun [--small] [SEED]

Each study is run by the script as it is, while shards are killed by SIGKILL at random times. The files must be those of
one process, byte for byte, but for times."""
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import shards

# OpenMPI does not start as root, or with more ranks than cores, unless it is told to.
VARIABLES = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
# A shard is killed once, as parallel starts it three times at most; mpirun's script has five rounds, and a kill ends one.
KILLS = {"parallel": 4, "mpirun": 3}
ENDED_WITHIN = 240  # s
STUDIES = {
    "stability": "stability SCENES/stability/stack_height.yaml --vary height --vary iterations --methods engine,momentum",
    "chart": "chart SCENES/stack.yaml SCENES/pyramid_settled.yaml --quick --launches 64 --methods engine,momentum,interior",
}
SMALL = {"stability": "stability SCENES/stability/heavy_on_one.yaml --vary ratio --vary iterations --methods engine"}


def find_shards(twinbox):
    """{shard: process}; the number that the scheduler gave it."""
    found = {}
    for process, variables in shards.find_processes(twinbox).items():
        number = variables.get("OMPI_COMM_WORLD_RANK") or variables.get("PARALLEL_SEQ")
        if number is not None:
            found[int(number)] = process
    return found


def kill_some(twinbox, script, kills, longest, choice):
    """Shards that were killed while the script ran."""
    killed = []
    while len(killed) < kills and script.poll() is None:
        time.sleep(choice.uniform(0, longest))
        found = {shard: process for shard, process in find_shards(twinbox).items() if shard not in killed}
        if found:
            killed.append(choice.choice(sorted(found)))
            os.kill(found[killed[-1]], signal.SIGKILL)
            while find_shards(twinbox).get(killed[-1]) == found[killed[-1]]:
                time.sleep(0.01)
    return killed


def check_study(twinbox, scheduler, name, command, kills, longest, choice):
    begun = time.monotonic()
    output = f"{name}-{scheduler}"
    script = os.path.join(twinbox.scenes, "cluster", f"{scheduler}.sh")
    twinbox.run(f"{command} -o {name}")
    with open("log", "w+", encoding="utf-8") as log:
        process = subprocess.Popen([script, output, *twinbox.words(command), "-o", output], stdin=subprocess.DEVNULL,
                                   stdout=log, stderr=log, env={**twinbox.environment, **VARIABLES},
                                   start_new_session=True)
        try:
            killed = kill_some(twinbox, process, kills, longest, choice)
            status = process.wait(ENDED_WITHIN)
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        log.seek(0)
        text = log.read()
    if status != 0:
        raise shards.Failure(f"{script}: exit status {status}: {text[-800:]}")
    if len(killed) < kills:
        raise shards.Failure(f"{output}: only {len(killed)} of {kills} shards could be killed")
    pieces = shards.expect_clean(os.path.join(output, "shards"))
    files = shards.expect_equal(output, name)
    print(f"{output}: killed {killed}; {pieces} pieces, {files} files as without shards, {time.monotonic() - begun:.0f} s",
          flush=True)


def check(twinbox):
    scheduler, *options = sys.argv[3:]
    small = "--small" in options
    seeds = [int(option) for option in options if option.isdigit()]
    seed = seeds[0] if seeds else random.randrange(10**6)
    print(f"{scheduler}: seed {seed}", flush=True)
    choice = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="cluster-") as folder:
        os.chdir(folder)
        for name, command in (SMALL if small else STUDIES).items():
            check_study(twinbox, scheduler, name, command, 2 if small else KILLS[scheduler], 0.1 if small else 1, choice)
        os.chdir("/")


if __name__ == "__main__":
    if len(sys.argv) < 4 or sys.argv[3] not in KILLS:
        sys.exit("arguments: TWINBOX SOURCES parallel|mpirun [--small] [SEED]")
    if shutil.which(sys.argv[3]) is None:
        print(f"skipped: {sys.argv[3]} is not installed")
        sys.exit(77)
    shards.main(check)
