# SPDX-License-Identifier: GPL-3.0-or-later
"""The command lines that are killed. SCENES stands for the folder of scenes."""
import fnmatch

SCENE_NET = "train --kind scene-net SCENES/stack.yaml -o net.npz --launches 10 --rounds 1 --iterations 1 --width 16"

# Three pieces, of which the first shard has two.
SHARDED = "stability SCENES/stability/bomb_speed.yaml --vary speed --quick --methods engine:k=4,momentum:k=3,nncg"

# What the cases start from, in one folder: how each file or folder is made, by a command of twinbox, which needs those
# that it names, by several (" && "), or of the shell (sh).
PREPARED = {
    "a.npz": "simulate SCENES/single.yaml --frames 8 -o a.npz",
    "b.npz": "simulate SCENES/single.yaml --frames 8 -m momentum -o b.npz",
    "pairs.npz": "dataset SCENES/single.yaml -o pairs.npz --bomb-x=-2:2:1",
    "net.npz": "train pairs.npz -o net.npz --iterations 1",
    "expected": "render a.npz -o expected --size 64x64 --frames 0:5",
    "actual": "render b.npz -o actual --size 64x64 --frames 1:6",
    "older": "render b.npz -o older --size 64x64 --frames 0:8",
    "report": "compare expected actual --report report",
    "film.mp4": "render a.npz -o frames --size 64x64 --video film.mp4",
    "charts": "chart SCENES/single.yaml SCENES/stack.yaml -o charts --quick --methods engine:k=10,momentum:k=20",
    # Short scenes for the paper: 60 frames of each.
    "small": "sh mkdir small && cp -r SCENES/networks small && for name in single stack pyramid; do "
             "sed 's/^frames: .*/frames: 60/' SCENES/$name.yaml >small/$name.yaml; done && "
             "cp small/stack.yaml small/pyramid_settled.yaml",
    "study": "stability --scenes SCENES --study heavy_on_one --methods engine:k=4 -o study",
    "sharded": f"{SHARDED} -o sharded --shard 1/2 && {SHARDED} -o sharded --shard 2/2",
}


class Case:
    """inputs: NEW=OLD copies OLD of the prepared folder to NEW. resume: the command that continues (default: the same).
    most: kills in a run of everything. times: patterns of files with times in them, which differ between runs. status:
    the exit status of a run that is not disturbed. early: the file that a run which SIGTERM stops early stores."""

    def __init__(self, name, command, inputs="", resume=None, most=16, times="", status=0, early=""):
        self.name, self.command, self.inputs, self.resume = name, command, inputs.split(), resume or command
        self.most, self.times, self.status, self.early = most, times.split(), status, early

    def timed(self, path):
        return any(fnmatch.fnmatch(path, pattern) for pattern in self.times)


def render(name, options, inputs, most=16):
    command = f"render a.npz -o out --size 64x64 {options}"
    return Case(name, command, "a.npz " + inputs, command + " --resume", most)


CASES = [
    Case("paper", "paper -o out --quick --scenes small", "small", most=6,
         times="out/closed_loop.csv out/system*.csv out/figures/closed-loop.[ps]* out/report.md"),
    Case("chart-study", "chart SCENES/single.yaml -o out --quick --methods engine:k=10 --launches 2", most=16,
         times="out/*.csv out/*.png out/*.svg out/*.pdf"),
    Case("chart-pages", "chart SCENES/single.yaml -o out --quick --methods engine:k=10 --launches 2 --pages", most=16,
         times="out/*.csv out/*.png out/*.svg out/*.pdf out/chart.html"),
    Case("chart-draw", "chart charts/chart.csv -o out", "charts", most=16),
    Case("stability", "stability --scenes SCENES --study heavy_on_one --methods engine:k=4 -o out", most=16),
    Case("stability-pages", "stability --scenes SCENES --quick --study speed_thickness --methods engine -o out --pages",
         most=12),
    Case("stability-shard", f"{SHARDED} -o out --shard 1/2", most=20),
    Case("merge", "merge sharded", "sharded", most=16),
    Case("stability-renew", "stability --scenes SCENES --study heavy_on_one --methods engine:k=5 -o study", "study",
         most=12),
    render("render", "--jobs 1", ""),
    render("render-jobs", "--jobs 3", ""),
    render("render-over-older", "--jobs 2 --frames 0:5", "out=older"),
    render("video", "--jobs 1 --video film.mp4 --video film.gif", "film.mp4", most=16),
    Case("train-pair-net", "train pairs.npz -o net.npz --iterations 3", "pairs.npz net.npz", most=14,
         early="net.npz"),
    Case("train-scene-net", SCENE_NET, most=12, early="net.npz"),
    Case("train-sain", "train --kind sain SCENES/single.yaml -o net.npz --launches 4 --rounds 2 --steps 120", most=20),
    Case("train-hybrid", "train --kind hybrid SCENES/single.yaml -o net.npz --launches 60 --steps 3", most=20),
    Case("train-gns", "train --kind gns -o net.npz --scenes SCENES/single.yaml --launches 2 --steps 600 --rounds 1",
         most=20),
    Case("train-subspace", "train --kind subspace SCENES/single.yaml -o net.npz --launches 2 --epochs 2 --width 16",
         most=12),
    Case("dataset", "dataset SCENES/single.yaml -o pairs.npz --bomb-x=-2:2:1 --context", "pairs.npz", most=14),
    Case("approve", "approve report --expected expected --remove", "report expected actual", most=20),
    Case("simulate", "simulate SCENES/single.yaml --frames 40 -o a.npz --hash a.csv --verdict a.json", "a.npz",
         most=12),
    Case("page", "page a.npz b.npz -o page.html", "a.npz b.npz page.html=a.npz", most=8),
    Case("compare", "compare expected actual --report report", "expected actual report", status=1,
         times="report/junit.xml", most=12),
]
