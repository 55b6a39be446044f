# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines that are run with faults. SCENES stands for the folder of scenes."""

# Three pieces, of which the first shard has two.
SHARDED = "stability SCENES/stability/bomb_speed.yaml --vary speed --quick --methods engine:k=4,momentum:k=3,nncg"

# What the cases start from, in one folder; made once per run of the driver.
PREPARATION = [
    "simulate SCENES/single.yaml --frames 50 -o a.npz -q",
    "simulate SCENES/single.yaml --frames 50 -m momentum:k=3 -o b.npz -q",
    "export a.npz -o a.csv -q",
    "dataset SCENES/single.yaml -o pairs.npz --bomb-x=-2:2:1 -q",
    "train pairs.npz -o net.npz --iterations 1 -q",
    "solve SCENES/single.yaml --frame 45 -o problem.npz -q",
    "render a.npz -o expected --size 64x64 --frames 40:42 --jobs 1 -q",
    "render b.npz -o actual --size 64x64 --frames 41:43 --jobs 1 -q",
    "render a.npz -o equal --size 64x64 --frames 40:42 --jobs 1 -q",
    "render a.npz -o half --size 64x64 --frames 40:41 --jobs 1 -q",
    "compare expected actual --report report -q",
    f"{SHARDED} -o sharded --shard 1/2 -q",
    f"{SHARDED} -o sharded --shard 2/2 -q",
]


class Case:
    """inputs: what is copied from the prepared folder, also as NEW=OLD; journals: what a failed run may leave behind,
    because the next run continues with it; killed: the call at which a first run is killed, which this one continues;
    sample: only one in so many faults, for commands that take many seconds; says_how: the output tells how the files were
    made, which a fault may change."""

    def __init__(self, name, arguments, inputs="", journals="", killed=None, sample=1, says_how=False):
        self.name, self.arguments, self.killed, self.sample, self.says_how = name, arguments, killed, sample, says_how
        self.inputs, self.journals = inputs.split(), journals.split()


TINY = "SCENES/single.yaml --frames 4"
SMALL = "--size 64x64 --jobs 1"
PAGE = "--dpi 50 --width 60"

# A few hundredths of a second each: every call fails in turn.
SHORT = [
    Case("new", "new wall.yaml --like wall"),
    Case("new-output", "new - --like wall"),
    Case("simulate-output", f"simulate {TINY} -o -"),
    Case("methods", "methods"),
    Case("simulate", f"simulate {TINY} -o run.npz --hash run.hash --verdict run.json --json",
         "run.npz=b.npz run.hash=a.csv run.json=a.csv"),
    Case("simulate-csv", f"simulate {TINY} -o run.csv -m momentum:k=5", "run.csv=a.csv"),
    Case("simulate-net", f"simulate {TINY} -m pair-net -o run.npz", "run.npz=b.npz"),
    Case("export-csv", "export a.npz -o out.csv", "a.npz out.csv=a.csv"),
    Case("export-json", "export a.npz -o out.json", "a.npz out.json=a.csv"),
    Case("import", "import a.csv -o out.npz", "a.csv out.npz=b.npz"),
    Case("compare-runs", "compare a.npz b.npz --csv out.csv", "a.npz b.npz out.csv=a.csv"),
    Case("compare-equal", "compare expected equal", "expected equal"),
    Case("compare-json", "compare expected actual --json --antialias", "expected actual"),
    Case("approve", "approve report --remove", "report expected actual"),
    Case("page", "page a.npz b.npz -o out.html --frames 40:50", "a.npz b.npz out.html=a.csv"),
    Case("compare-runs-json", "compare a.npz b.npz --json", "a.npz b.npz"),
    Case("solve-step", "solve SCENES/single.yaml --frame 45 -o out.npz -m engine:k=3", "out.npz=problem.npz"),
    Case("solve", "solve problem.npz -m engine:k=3 -m momentum:k=3 --json", "problem.npz"),
]

# Take longer: the first call from each place fails.
LONG = [
    Case("compare-report", "compare expected actual --report report", "expected actual report"),
    Case("dataset", "dataset SCENES/single.yaml -o out.npz --bomb-x=0:4:1 --context", "out.npz=pairs.npz"),
    Case("train-pair-net", "train pairs.npz -o out.npz --iterations 2", "pairs.npz"),
    Case("train-from", "train pairs.npz -o net.npz --from net.npz --iterations 2", "pairs.npz net.npz"),
    Case("train-lm", "train pairs.npz -o out.npz --iterations 2 --layers 10-8-8-6 --optimizer lm", "pairs.npz"),
    Case("train-bfgs", "train pairs.npz -o out.npz --iterations 2 --optimizer bfgs", "pairs.npz"),
    Case("train-scene-net", "train --kind scene-net SCENES/stack.yaml -o out.npz --launches 10 --rounds 1 --iterations 1"
         " --width 16"),
    Case("train-sain", "train --kind sain SCENES/single.yaml -o out.npz --launches 2 --rounds 1 --steps 3", "",
         "out.npz.part"),
    Case("train-hybrid", "train --kind hybrid SCENES/single.yaml -o out.npz --launches 2 --steps 3", "",
         "out.npz.part"),
    Case("train-gns", "train --kind gns -o out.npz --scenes SCENES/single.yaml --launches 1 --steps 2 --rounds 1", "",
         "out.npz.part"),
    Case("train-subspace", "train --kind subspace SCENES/single.yaml -o out.npz --launches 2 --epochs 1 --width 16", "",
         "out.npz.part"),
    Case("check", "check SCENES/single.yaml -o out.png", "out.png=expected/frame_000040.png"),
    Case("figure-pdf", f"figure strip a.npz b.npz -o out.pdf --at 0.7 {PAGE}", "a.npz b.npz out.pdf=a.csv"),
    Case("figure-svg", f"figure annotated a.npz -o out.svg --at 0.75 {PAGE} --outlines", "a.npz out.svg=a.csv"),
    Case("figure-png", f"figure strobe a.npz -o out.png --at 0.5,0.7 {PAGE} --caption-text out.tex",
         "a.npz out.png=a.csv out.tex=a.csv"),
    Case("figure-plot", f"figure divergence a.npz b.npz -o out.pdf {PAGE}", "a.npz b.npz out.pdf=a.csv"),
    Case("render", f"render a.npz b.npz -o out --frames 40:42 {SMALL}", "a.npz b.npz", "out/manifest.json.part"),
    Case("render-resume", f"render a.npz -o half --frames 40:42 {SMALL} --resume", "a.npz half",
         "half/manifest.json.part", says_how=True),
    Case("render-jobs", "render a.npz -o out --size 64x64 --frames 0:9 --jobs 3", "a.npz", "out/manifest.json.part"),
    Case("render-video", f"render a.npz -o out --frames 40:42 {SMALL} --video out.mp4 --video out.gif",
         "a.npz out.mp4=a.csv out.gif=a.csv", "out/manifest.json.part"),
    Case("render-output", f"render a.npz -o out --frames 40:42 {SMALL} --video -", "a.npz", "out/manifest.json.part"),
    Case("chart", "chart SCENES/single.yaml -o out --quick --methods engine:k=10 --launches 2", "", "out/parts-*"),
    Case("chart-pages", "chart SCENES/single.yaml -o out --quick --methods engine:k=10 --launches 2 --pages", "",
         "out/parts-*"),
    Case("stability", "stability --scenes SCENES --study heavy_on_one --methods engine:k=4 -o out", "",
         "out/parts-*"),
    Case("shard", f"{SHARDED} -o out --shard 1/2", "", "out/shards/*"),
    Case("merge", "merge sharded", "sharded"),
    Case("stability-pages", "stability --scenes SCENES --quick --study speed_thickness --methods engine -o out --pages", "",
         "out/parts-*"),
    Case("paper", "paper -o out --quick --scenes SCENES", "", "out/parts-*", "rename:60", 100),
]
