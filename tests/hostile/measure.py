# SPDX-License-Identifier: GPL-3.0-or-later
# measure.py TWINBOX SCENES [any]: runs twinbox on the files of make_files.py, in the working directory, within the budgets
# that README.md promises; "any": without limits, for builds with a sanitizer, whose memory and work are not the program's.
import os
import re
import resource
import subprocess
import sys
import time

twinbox, scenes = os.path.abspath(sys.argv[1]), sys.argv[2]
limited = len(sys.argv) == 3
MiB = 1 << 20
MEMORY, INSTRUCTIONS = 64 * MiB, 400e6  # of refused input, beside those of a process that has nothing to do
PER_BYTE_MEMORY, PER_BYTE_INSTRUCTIONS = 2, 200  # of its files
# One thread: each further one has a stack and an arena of its own.
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", MALLOC_ARENA_MAX="1")
single, stack = f"{scenes}/single.yaml", f"{scenes}/stack.yaml"

# Exit status, a part of the message, the files, and the arguments, among which @ is the next file.
CASES = [
    (2, "its arrays take 960000804 bytes; expected at most ", ["bomb.npz"], "export @ -o x.csv"),
    (2, "its arrays take ", ["twins.npz"], "export @ -o x.csv"),
    (2, "body 0: its size must be finite and greater than 0", ["flat.npz"], "export @ -o x.csv"),
    (2, "array 'angular_velocity' has shape (50000, 99); expected (50000, 100)", ["run.npz"], "export @ -o x.csv"),
    (2, "array 'contact_impulse' has shape (999999, 2); expected (1000000, 2)", ["contacts.npz"], "export @ -o x.csv"),
    (2, "array 'changes' has shape", ["dataset.npz"], "train @ -o x.npz"),
    (2, "array 'contact_warm' has shape (999999, 2); expected (1000000, 2)", ["problem.npz"], "solve @ --method engine"),
    (2, "has no array 'weights_1'", ["network.npz"], f"simulate {single} -m pair-net:network=@ -o x.npz"),
    (2, "has no array 'bomb_state_rows'", ["slots.npz"], f"simulate {single} -m scene-net:network=@ -o x.npz"),
    (1, "", ["deep.png", "small.png"], "compare @ @"),
    (1, "", ["small.png", "deep.png"], "compare @ @ --antialias --report report"),
    (1, "", ["interlaced.png", "small.png"], "compare @ @"),
    (1, "", ["wide.png", "small.png"], "compare @ @"),
    (2, "the picture has 40000 x 40000 pixels; at most 100000000", ["pixels.png", "small.png"], "compare @ @"),
    (2, "unexpected end of file", ["cut.png", "small.png"], "compare @ @"),
    (0, "", ["texts.png", "small.png"], "compare @ @"),
    (2, "empty.png: error: not a PNG file, or damaged", ["empty.png", "small.png"], "compare @ @"),
    (2, "deep.png: error: the mask has 10000 x 10000 pixels, but small.png has 8 x 8", ["deep.png", "small.png", "grey.png"],
     "compare --mask @ @ @"),
    (2, "not a regular file", ["/dev/zero", "small.png"], "compare @ @"),
    (2, "not a regular file", ["/dev/zero"], "check @"),
    (2, "results.json: error: 'a.png' is there twice", ["copies/results.json"], "approve copies"),
    (2, "maximum parsing depth reached", ["deep/results.json"], "approve deep"),
    (2, "a value must have at most 65536 bytes", ["long/results.json"], "approve long"),
    (2, "a value must take at most 1048576 bytes of memory", ["many/results.json"], "approve many"),
    (2, "'failed' must be true or false", ["members/results.json"], "approve members"),
    (1, "", ["expected/manifest.json", "actual/manifest.json"], "compare expected actual"),
    (2, "nested at most 8 deep", ["line.yaml"], "check @"),
    (2, "a mapping must have at most 64 keys", ["keys.yaml"], "check @"),
    (2, "is not a key of a scene", ["folded.yaml"], "check @"),
    (2, "bodies.yaml:20001:", ["bodies.yaml"], "check @"),
    (2, "anchors (&) are not allowed", ["aliases.yaml"], "check @"),
    (2, "larger than 1572864 bytes", ["large.yaml"], "check @"),
    (2, "more than 1048576 pairs of boxes overlap", ["heap.yaml"], "simulate @ -o x.npz"),
    (2, "at most 256 rules (got 40000)", ["rules.yaml"], "compare expected actual --rules @"),
    (2, "the table has more than 20000 rows", ["rows.csv"], "chart @ -o x"),
    (2, "longer than 1023 bytes", ["line.csv"], "import @ -o x.npz"),
    (2, "80000 frames of 1000 bodies take 5760000000 bytes; expected at most ", ["sparse.csv"], "import @ -o x.npz"),
    (2, "frame 2000000000 cannot follow from frame 0", ["far.csv"], "import @ -o x.npz"),
    (2, "larger than 12001200 bytes", ["launches.csv"], f"dataset {single} --launches @ -o x.npz"),
]

# What is accepted: arguments, and bytes of memory that it may take beside MEMORY_BASE.
MEMORY_BASE = 12 * MiB
ARRAYS, PIXELS = 6000 * 100 * 6 * 4 + 50000 * 36, 3000 * 3000
ACCEPTED = [
    (1, "compare still.npz still2.npz", lambda size: 2 * 1.25 * ARRAYS, []),
    (1, "compare honest.png changed.png", lambda size: 2 * 12 * PIXELS + size, ["honest.png", "changed.png"]),
    (1, "approve names", lambda size: 4 * size, ["names/results.json"]),
    (0, "import run.csv -o x.npz", lambda size: 8 * size, ["run.csv"]),
]


def start(arguments, address=None, **streams):
    def limit():
        if address is not None:
            resource.setrlimit(resource.RLIMIT_AS, (address, address))
        resource.setrlimit(resource.RLIMIT_CPU, (30, 30))  # what hangs is a failure

    return subprocess.Popen([twinbox, *arguments], preexec_fn=limit, env=ENVIRONMENT, **streams)


def idle_memory():
    """Address space and resident memory of a process that waits for its input."""
    process = start(["import", "-", "-o", "idle.npz"], stdin=subprocess.PIPE)
    try:
        for _ in range(1000):
            with open(f"/proc/{process.pid}/status") as file:
                found = dict(line.split(":", 1) for line in file)
            if os.path.basename(twinbox) == found["Name"].strip() and found["State"].split()[0] == "S":
                break
            time.sleep(0.01)
        time.sleep(0.1)
        return [int(found[key].split()[0]) * 1024 for key in ("VmPeak", "VmHWM")]
    finally:
        process.kill()
        process.wait()


def measure(arguments, address):
    """Exit status, errors, resident memory."""
    with open("errors", "wb") as errors:
        process = start(arguments, address, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = 0
    with open("errors", "rb") as errors:
        words = errors.read().decode("utf-8", "replace")
    return os.waitstatus_to_exitcode(status), words, used.ru_maxrss * 1024


def instructions(arguments):
    """Under valgrind, which no other process disturbs."""
    counter = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", "--log-file=counted"]
    subprocess.run([*counter, twinbox, *arguments], env=ENVIRONMENT, stdin=subprocess.DEVNULL, capture_output=True, check=False)
    with open("counted") as log:
        return int(re.search(r"I +refs: +([\d,]+)", log.read())[1].replace(",", ""))


def check(status, message, words, files, budget, memory, address):
    """What is wrong with a command; "" if nothing. Without a budget its instructions are not limited."""
    found, errors, resident = measure(words.split(), address)
    resident -= idle[1]
    expected = found == status and message in errors
    used = instructions(words.split()) - started if limited and budget is not None and expected else 0
    if verbose:
        print(f"{used / 1e6:6.0f} million {resident / MiB:6.1f} of {memory / MiB:.1f} MiB {size_of(files):9} bytes  {words}", flush=True)
    if not expected:
        return f"exit status {found}, not {status}, or no '{message}' in: {errors[:300]}"
    if budget is not None and used > budget:
        return f"{used / 1e6:.0f} million instructions, not {budget / 1e6:.0f}"
    return f"{resident / MiB:.0f} MiB, not {memory / MiB:.0f}" if limited and resident > memory else ""


def report(words, wrong):
    global failed
    if wrong:
        print(f"FAILED: twinbox {words}: {wrong}")
        failed += 1


def size_of(files):
    return sum(os.stat(name).st_size for name in files)


verbose = os.environ.get("VERBOSE") is not None
idle = idle_memory() if limited else [0, 0]
started = instructions(["--version"]) if limited else 0
failed = 0
for status, message, files, words in CASES:
    names = iter(files * 2)
    words = " ".join(word.replace("@", next(names)) if "@" in word else word for word in words.split())
    memory = MEMORY + PER_BYTE_MEMORY * size_of(files)
    wrong = check(status, message, words, files, INSTRUCTIONS + PER_BYTE_INSTRUCTIONS * size_of(files), memory, idle[0] + memory if limited else None)
    report(words, wrong)
for status, words, allowed, files in ACCEPTED:
    wrong = check(status, "", words, files, None, MEMORY_BASE + allowed(size_of(files)), None)
    report(words, wrong)
# Proof that the limit holds: a picture that needs more.
if limited and measure(["compare", "honest.png", "changed.png"], idle[0] + MEMORY)[0] != 3:
    print("FAILED: pictures of 100 MB fit into the budget of refused input")
    failed += 1
print(f"{len(CASES) + len(ACCEPTED) + limited} cases, {failed} failed")
sys.exit(failed > 0)
