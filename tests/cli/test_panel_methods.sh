#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# render and page of a scene with --method show the runs that simulate stores.
. "$(dirname "$0")/checks.sh"
scene=$scenes/single.yaml

for method in engine momentum:k=20; do run 0 simulate "$scene" --set friction=0.5 -m $method -o "${method/:k=/_k=}.npz"; done
run 0 render "$scene" --set friction=0.5 --method engine -m momentum:k=20 -o frames --size 64x64 --frames 0
for method in engine momentum_k=20; do run 0 compare $method.npz frames/single-$method.npz; done
equal "runs" "$(ls frames/*.npz | wc -l)" 2
run 0 page "$scene" --set friction=0.5 -m engine -m momentum:k=20 -o by_scene.html
says "2 runs of "
run 0 page engine.npz momentum_k=20.npz -o by_runs.html
# The pages differ in the names of files, which runs of a scene have not, and in what they are made of.
PYTHONPATH=$sources/tests/browser /usr/bin/python3 -B - <<'PYTHON' || fail "pages differ"
import player_page
pages = [player_page.data(f"{name}.html") for name in ("by_scene", "by_runs")]
files = [[run.pop("file") for run in page["runs"]] for page in pages]
assert files == [[None, None], ["engine.npz", "momentum_k=20.npz"]], files
for page in pages:
    del page["set"], page["runs"][0]["made_of"], page["runs"][1]["made_of"]
assert pages[0] == pages[1] and pages[0]["runs"][1]["method"] == "momentum:k=20", pages
PYTHON
# Beside a run, only the scene is simulated.
run 0 render engine.npz "$scene" -m momentum:k=20 -o both --size 64x64 --frames 0
equal "runs beside a run" "$(ls both/*.npz | wc -l)" 2

# A folder may have the name of a film, if its path ends with /.
run 0 render engine.npz -o film.mp4/ --size 64x64 --frames 0
equal "files" "$(ls -A | xargs)" "both by_runs.html by_scene.html engine.npz err film.mp4 frames momentum_k=20.npz out"
finish
