#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The runs of golden/trajectories, of engine and network, again: equal bit by bit, and every frame of them pixel by pixel.
. "$(dirname "$0")/checks.sh"

runs=0
for golden in "$sources"/golden/trajectories/*.npz; do
    name=$(basename "$golden" .npz)
    scene=${name%%-*}
    method=${name#*-}
    steps=$(sed -n "s/^ *renew $scene \([0-9]*\)$/\1/p" "$sources/golden/renew")
    run 0 simulate "$scenes/$scene.yaml" --frames "$steps" --method "$method" -o "$name.npz"
    run 0 compare "$golden" "$name.npz"
    cat out
    runs=$((runs + 1))
done
equal "runs compared" $runs 8

"$sources/golden/pixel_hashes" "$folder" "$twinbox" >pixel_hash.csv
equal "frames with other pixels" "$(diff "$sources/golden/pixel_hash.csv" pixel_hash.csv | grep '^>')" ""
equal "frames drawn" "$(wc -l <pixel_hash.csv)" 415
finish
