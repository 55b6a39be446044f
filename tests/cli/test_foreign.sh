#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Commands with runs of other programs, which have position, angle, size and dt only: each works with them or refuses them
# with the reason. A new command that reads runs gets a line in the table.
. "$(dirname "$0")/checks.sh"

# theirs.npz: the poses of ours.npz. other.npz: one body moved in one frame.
run 0 simulate "$scenes/stack.yaml" --frames 60 -o ours.npz
/usr/bin/python3 - <<'PYTHON' || fail "no python3-numpy"
import numpy as np
ours = np.load("ours.npz")
theirs = {name: ours[name] for name in ("position", "angle", "size", "dt")}
np.savez("theirs.npz", **theirs)
theirs["position"][50, 3] += 0.5
np.savez("other.npz", **theirs)
turned = dict(theirs, position=ours["position"], angle=ours["angle"].copy())
turned["angle"][20:, 3] += np.float32(2 * np.pi)
np.savez("turned.npz", **turned)
PYTHON

# STATUS | what is printed | arguments
table() {
    cat <<'END'
0 | equal: 61 frames of 12 bodies, every bit of float32 poses | compare ours.npz theirs.npz
1 | first difference: frame 50, body 3: 0.707 m apart | compare theirs.npz other.npz
1 | largest distance: frame 50, body 3 | compare ours.npz other.npz
1 | first difference: frame 20, body 3: 0 m apart, 6.28 rad | compare theirs.npz turned.npz
1 | largest distance: none, every position is the same | compare theirs.npz turned.npz
1 | cause: unknown, as a run has no impulses | compare theirs.npz other.npz
1 | run 1: theirs by theirs, 61 frames of 12 bodies (theirs.npz) | compare theirs.npz other.npz --csv d.csv
2 | that run does not state its scene_hash | compare theirs.npz other.npz --scene scenes/stack.yaml
0 | frame_000041.png | render ours.npz theirs.npz --size 320x180 --frames 40:41 -o pair
0 | one/frame_000050.png | render theirs.npz --size 320x180 --frames 50 --compare split --show trails -o one
0 | two/frame_000050.png | render theirs.npz other.npz --size 320x180 --frames 50 --compare difference --show timeline -o two
0 | --slow: no run has a contact of the bomb with a box; nothing is slowed down | render theirs.npz --size 320x180 --frames 40 --slow 2 -o slow
2 | 'velocities' cannot be shown: run 2 (theirs) has no velocities | render ours.npz theirs.npz --show velocities -o x
2 | 'contacts' cannot be shown: run 1 (theirs) has no contacts | render theirs.npz --show contacts -o x
2 | 'impulses' cannot be shown: run 1 (theirs) has no contacts | render theirs.npz --show impulses -o x
2 | the camera cannot follow the bomb: the first run has none | render theirs.npz --camera bomb -o x
0 | strip | figure strip ours.npz theirs.npz --moments 3 --dpi 60 -o strip.png
0 | strobe | figure strobe theirs.npz --moments 4 --dpi 60 -o strobe.png
0 | 2 runs of 61 frames | page ours.npz theirs.npz -o pair.html
0 | 1 run of 61 frames | page theirs.npz -o one.html
0 | divergence | figure divergence ours.npz other.npz -o divergence.svg
0 | annotated | figure annotated theirs.npz -o annotated.svg
2 | theirs.npz: error: | solve theirs.npz --method engine
END
}
ln -s "$scenes" scenes
while IFS='|' read -r status text arguments; do
    text=${text# }
    read -ra words <<<"$arguments"
    run "$status" "${words[@]}"
    cat out err >both
    grep -qF -- "${text% }" both || fail "twinbox $arguments: no '$text' in: $(head -c 600 both)"
done < <(table)
[ ! -e x ] && [ ! -e x.png ] || fail "a refused command wrote something"

# As JSON, what is unknown is null.
run 1 compare theirs.npz other.npz --tolerance 0.1 --json
/usr/bin/python3 - <<'PYTHON' || fail "JSON of runs without velocities and contacts"
import json
result = json.load(open("out"))
assert result["poses_only"] and result["cause"] == "unknown" and result["beyond"]["speed"] is None
assert result["first"]["speed"] is None and result["first"]["distance"] > 0.7
assert result["first"]["spin"] is None and result["contacts"] is None and result["contacts_found_again"]
contact = result["beyond_contacts"]["contact"]
assert contact is None or contact["normal_impulse"] == [None, None]
PYTHON

# What is refused in theirs works in ours.
run 0 render ours.npz --size 320x180 --frames 40 --show velocities,contacts,impulses --camera bomb -o full

# Pictures with their runs beside them: compare and approve read these, and names what moved.
run 0 render theirs.npz --size 640x360 --frames 50 -o accepted
run 0 render other.npz --size 640x360 --frames 50 -o changed
for side in accepted:theirs changed:other; do cp "${side#*:}.npz" "${side%:*}/run.npz"; done
run 1 compare accepted changed --report report
says "body 3"
cp -r accepted kept
run 0 approve report
run 0 compare accepted changed
finish
