#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# render and page of a scene with --method show the runs that simulate stores; names after -o that cannot be meant.
. "$(dirname "$0")/checks.sh"
scene=$scenes/single.yaml

for method in engine momentum:k=20; do run 0 simulate "$scene" --set friction=0.5 -m $method -o "${method/:k=/_k=}.npz"; done
run 0 render "$scene" --set friction=0.5 --method engine -m momentum:k=20 -o frames --size 64x64 --frames 0
for method in engine momentum_k=20; do run 0 compare $method.npz frames/single-$method.npz; done
equal "runs" "$(ls frames/*.npz | wc -l)" 2
run 0 page "$scene" --set friction=0.5 -m engine -m momentum:k=20 -o by_scene.html
says "2 runs of "
run 0 page engine.npz momentum_k=20.npz -o by_runs.html
# The pages differ in the names of files alone, which runs of a scene have not.
for page in by_scene by_runs; do sed 's/"file":[^,}]*//g' $page.html >$page.plain; done
grep -q 'momentum:k=20' by_scene.html || fail "no method in the page"
equal "sizes of the pages are alike" "$(($(wc -c <by_scene.plain) - $(wc -c <by_runs.plain) < 200))" 1
for command in "render -o refused" "page -o refused.html"; do
    run 2 $command engine.npz --method engine
    complains "--method: error: needs a scene; a run (.npz) is shown as it was simulated"
    run 2 $command "$scene" --method enigne
    complains "did you mean 'engine'?"
done
# Beside a run, only the scene is simulated.
run 0 render engine.npz "$scene" -m momentum:k=20 -o both --size 64x64 --frames 0
equal "runs beside a run" "$(ls both/*.npz | wc -l)" 2

# A folder with the name of a file is a mistake.
mkdir out.d
for name in film.mp4 out.d/film.webm film.gif; do
    run 2 render engine.npz -o $name
    complains "$name: error: -o names the folder of the frames; for a film: -o ${name%.*} --video $name"
done
for words in "render engine.npz -o a.png" "chart $scene -o a.pdf" "stability -o a.csv" "paper -o a.html" "compare frames both --report a.json"; do
    run 2 $words
    complains "${words##* }: error: is the name of a file; expected that of a folder, such as a"
done
run 0 render engine.npz -o film.mp4/ --size 64x64 --frames 0
equal "files" "$(ls -A | xargs)" "both by_runs.html by_runs.plain by_scene.html by_scene.plain engine.npz err film.mp4 frames momentum_k=20.npz out out.d"
finish
