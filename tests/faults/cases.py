# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines that are run with faults, and killed. SCENES stands for the folder of scenes."""

# Three pieces, of which the first shard has two.
SHARDED = "stability SCENES/stability/bomb_speed.yaml --vary speed --quick --methods engine:k=4,momentum:k=3,nncg"

# What the cases start from, in one folder: how each file or folder is made, by a command of twinbox, which needs those that it
# names, by several (" && "), or of the shell (sh).
PREPARED = {
    "a.npz": "simulate SCENES/single.yaml --frames 50 -o a.npz",
    "b.npz": "simulate SCENES/single.yaml --frames 50 -m momentum:k=3 -o b.npz",
    "a.csv": "export a.npz -o a.csv",
    "pairs.npz": "dataset SCENES/single.yaml -o pairs.npz --bomb-x=-2:2:1",
    "net.npz": "train pairs.npz -o net.npz --iterations 1",
    "problem.npz": "solve SCENES/single.yaml --frame 45 -o problem.npz",
    "expected": "render a.npz -o expected --size 64x64 --frames 40:42",
    "actual": "render b.npz -o actual --size 64x64 --frames 41:43",
    "equal": "render a.npz -o equal --size 64x64 --frames 40:42",
    "half": "render a.npz -o half --size 64x64 --frames 40:41",
    "older": "render b.npz -o older --size 64x64 --frames 38:46",
    "report": "compare expected actual --report report",
    "charts": "chart SCENES/single.yaml SCENES/stack.yaml -o charts --quick --methods engine:k=10,momentum:k=20",
    "study": "stability --scenes SCENES --study heavy_on_one --methods engine:k=4 -o study",
    "sharded": f"{SHARDED} -o sharded --shard 1/2",
    # Short scenes for the paper: 60 frames of each.
    "small": "sh mkdir small; cp -r SCENES/networks small; for name in single stack pyramid; do "
             "sed 's/^frames: .*/frames: 60/' SCENES/$name.yaml >small/$name.yaml; done; "
             "cp small/stack.yaml small/pyramid_settled.yaml",
}


class Case:
    """inputs: what is copied of these, also as NEW=OLD; journals: what a failed run may leave behind, because the next run
    continues with it; short: takes a few hundredths of a second, so every call fails in turn; of others, the first from each
    place, and of these one in `sample`; says_how: the output tells how the files were made, which a fault may change. most: kills
    in a run of everything; resume: the command that continues after one (default: the same); early: the file that a run
    which SIGTERM stops early stores; renews: the folder whose old files go before the work begins, so that none looks like its result."""

    def __init__(self, name, arguments, inputs="", journals="", short=False, sample=1, says_how=False, most=0, resume=None, early="", renews=None):
        self.name, self.arguments, self.inputs, self.journals = name, arguments, inputs.split(), journals.split()
        self.short, self.sample, self.says_how, self.most, self.resume, self.early = short, sample, says_how, most, resume, early
        self.renews = renews


TINY = "SCENES/single.yaml --frames 4"
SMALL = "--size 64x64 --jobs 1"
PAGE = "--dpi 50 --width 60"
QUICK_CHART = "chart SCENES/single.yaml -o out --quick --methods engine:k=10 --launches 2"


def render(name, options, inputs="", most=16):
    command = f"render {options}"
    return Case(name, command, f"a.npz {inputs}", "out/manifest.json.part", most=most, resume=command + " --resume")


CASES = [
    Case("new", "new wall.yaml --like wall", short=True),
    Case("new-output", "new - --like wall", short=True),
    Case("simulate-output", f"simulate {TINY} -o -", short=True),
    Case("methods", "methods", short=True),
    Case("simulate", f"simulate {TINY} -o run.npz --hash run.hash --verdict run.json --json",
         "run.npz=b.npz run.hash=a.csv run.json=a.csv", short=True, most=12),
    Case("simulate-csv", f"simulate {TINY} -o run.csv -m momentum:k=5", "run.csv=a.csv", short=True),
    Case("simulate-net", f"simulate {TINY} -m pair-net -o run.npz", "run.npz=b.npz", short=True),
    Case("export-csv", "export a.npz -o out.csv", "a.npz out.csv=a.csv", short=True),
    Case("export-json", "export a.npz -o out.json", "a.npz out.json=a.csv", short=True),
    Case("import", "import a.csv -o out.npz", "a.csv out.npz=b.npz", short=True),
    Case("compare-runs", "compare a.npz b.npz --csv out.csv", "a.npz b.npz out.csv=a.csv", short=True),
    Case("compare-equal", "compare expected equal", "expected equal", short=True),
    Case("compare-json", "compare expected actual --json --antialias", "expected actual", short=True),
    Case("approve", "approve report --remove", "report expected actual", short=True, most=20),
    Case("page", "page a.npz b.npz -o out.html --frames 40:50", "a.npz b.npz out.html=a.csv", short=True, most=8),
    Case("compare-runs-json", "compare a.npz b.npz --json", "a.npz b.npz", short=True),
    Case("solve-step", "solve SCENES/single.yaml --frame 45 -o out.npz -m engine:k=3", "out.npz=problem.npz", short=True),
    Case("solve", "solve problem.npz -m engine:k=3 -m momentum:k=3 --json", "problem.npz", short=True),
    Case("compare-report", "compare expected actual --report report", "expected actual report", most=12, renews="report"),
    Case("dataset", "dataset SCENES/single.yaml -o out.npz --bomb-x=0:4:1 --context", "out.npz=pairs.npz", most=14),
    Case("train-pair-net", "train pairs.npz -o net.npz --iterations 2", "pairs.npz net.npz", most=14, early="net.npz"),
    Case("train-from", "train pairs.npz -o net.npz --from net.npz --iterations 2", "pairs.npz net.npz"),
    Case("train-lm", "train pairs.npz -o out.npz --iterations 2 --layers 10-8-8-6 --optimizer lm", "pairs.npz"),
    Case("train-bfgs", "train pairs.npz -o out.npz --iterations 2 --optimizer bfgs", "pairs.npz"),
    Case("train-scene-net", "train --kind scene-net SCENES/stack.yaml -o out.npz --launches 10 --rounds 1 --iterations 1"
         " --width 16", most=12, early="out.npz"),
    Case("train-sain", "train --kind sain SCENES/single.yaml -o out.npz --launches 2 --rounds 1 --steps 3", most=20),
    Case("train-hybrid", "train --kind hybrid SCENES/single.yaml -o out.npz --launches 2 --steps 3", most=20),
    Case("train-gns", "train --kind gns -o out.npz --scenes SCENES/single.yaml --launches 1 --steps 2 --rounds 1", most=20),
    Case("train-subspace", "train --kind subspace SCENES/single.yaml -o out.npz --launches 2 --epochs 2 --width 16", most=12),
    Case("check", "check SCENES/single.yaml -o out.png", "out.png=expected/frame_000040.png"),
    Case("figure-pdf", f"figure strip a.npz b.npz -o out.pdf --at 0.7 {PAGE}", "a.npz b.npz out.pdf=a.csv"),
    Case("figure-svg", f"figure annotated a.npz -o out.svg --at 0.75 {PAGE} --outlines", "a.npz out.svg=a.csv"),
    Case("figure-png", f"figure strobe a.npz -o out.png --at 0.5,0.7 {PAGE}", "a.npz out.png=a.csv"),
    Case("figure-plot", f"figure divergence a.npz b.npz -o out.pdf {PAGE}", "a.npz b.npz out.pdf=a.csv"),
    render("render", f"a.npz b.npz -o out --frames 40:42 {SMALL}", "b.npz"),
    Case("render-resume", f"render a.npz -o half --frames 40:42 {SMALL} --resume", "a.npz half",
         "half/manifest.json.part", says_how=True),
    render("render-jobs", "a.npz -o out --size 64x64 --frames 0:9 --jobs 3"),
    render("render-over-older", "a.npz -o out --size 64x64 --jobs 2 --frames 40:45", "out=older"),
    render("render-video", f"a.npz -o out --frames 40:42 {SMALL} --video out.mp4 --video out.gif", "out.mp4=a.csv out.gif=a.csv"),
    render("render-output", f"a.npz -o out --frames 40:42 {SMALL} --video -", most=0),
    Case("chart", QUICK_CHART, "", "out/parts-*", most=16),
    Case("chart-draw", "chart charts/chart.csv -o out", "charts", most=16),
    Case("stability", "stability --scenes SCENES --study heavy_on_one --methods engine:k=4 -o out", "", "out/parts-*", most=16),
    Case("stability-renew", "stability --scenes SCENES --study heavy_on_one --methods engine:k=5 -o study", "study",
         "study/parts-*", most=12),
    Case("shard", f"{SHARDED} -o out --shard 1/2", "", "out/parts-*", most=20),
    Case("after-shard", f"{SHARDED} -o sharded", "sharded", "sharded/parts-*", most=16),
    Case("paper", "paper -o out --quick --scenes small", "small", "out/parts-*", sample=300, most=6),
]
