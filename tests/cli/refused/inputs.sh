# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by test_refused.sh: inputs of the tables that no command makes.
trainings=(pairs.npz "--kind scene-net $scenes/stack.yaml" "--kind sain $scenes/stack.yaml" "--kind hybrid $scenes/stack.yaml" "--kind gns")
studies=("chart $scenes/single.yaml --quick" "stability --scenes $scenes" "paper --scenes $scenes")
hostile=$'\e[31mred\n::error::x\xc2\x9b' visible='\x1b[31mred\n::error::x\u009b'
long=$(head -c 100000 /dev/zero | tr '\0' x) short=xxxxxxxx
png() { /usr/bin/python3 "$sources/tests/cli/png.py" "$@"; }

# Folders of pictures: two that differ, one with links, one without pictures.
mkdir a b empty folder.npz folder.png folder.gif
png a/x.png 20 10 "9 9 9 255"
png a/y.png 20 10 "9 9 9 255"
cp a/y.png b
png b/x.png 20 10 "9 9 9 255" 3 4 "9 12 9 255"
png high.png 20 11 "0 0 0 255"
ln -s a link
cp -r a linked && ln -s "$PWD/b/x.png" linked/far.png
cp -r a upward && ln -s .. upward/up
mkdir -p deep/sub texts
cp a/x.png deep/sub
echo text >texts/notes.txt

# Pictures that are none, also where the file beside it is equal. claim.png has 19,000 x 19,000 pixels in 60 kB.
for kind in cut nothing pointer page; do cp -r a $kind; done
head -c 60 a/x.png >cut/x.png
: >nothing/x.png
printf 'version https://git-lfs.github.com/spec/v1\noid sha256:%064d\nsize 12345\n' 1 >pointer/x.png
echo "404 Not Found" >page/x.png
for kind in cut nothing pointer page; do cp -r $kind $kind.too; done
cp pointer/x.png pointer.npz
/usr/bin/python3 - <<'PYTHON'
import struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
packer = zlib.compressobj(9)
rows = b"".join(packer.compress(bytes(1 << 20)) for _ in range(19000 * (19000 // 8 + 1) // (1 << 20) + 1)) + packer.flush()
with open("claim.png", "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 19000, 19000, 1, 0, 0, 0, 0)))
    file.write(chunk(b"IDAT", rows) + chunk(b"IEND", b""))
PYTHON
echo 'rules: [{files: "*", tolerance: 3}, {files: "z*.png", antialias: on}]' >name.yaml
echo 'rules: [{files: "*", antialais: on}]' >key.yaml
echo 'rules: [{files: "*", tolerance: 255}]' >all.yaml

# Runs.
for file in engine impact pairs net; do head -c 900 $file.npz >cut-$file.npz; done
/usr/bin/python3 - <<'PYTHON'
import numpy
run = dict(numpy.load("engine.npz", allow_pickle=False))
none = {key: value[:0] for key, value in run.items() if key.startswith("contact_") and key != "contact_start"}
numpy.savez("bare.npz", **{**run, **none, "contact_start": run["contact_start"] * 0})
numpy.savez("wild.npz", **{**run, "contact_impulse": run["contact_impulse"] * numpy.float32("nan")})
numpy.savez("nihon.npz", **{**run, "scene": numpy.array("日本")})
numpy.savez("sorcery.npz", **{**run, "method": numpy.array("sorcery")})
run["contact_start"][5] = 1 << 60
numpy.savez("starts.npz", **run)
data = dict(numpy.load("pairs.npz", allow_pickle=False))
data["inputs"][:] = data["inputs"][:, 5:6]  # ten inputs that are the same: too steep for the rate of gd
numpy.savez("steep.npz", **data)
problem = dict(numpy.load("impact.npz", allow_pickle=False))
def change(name, **arrays):
    numpy.savez(f"problem-{name}.npz", **{key: array for key, array in (problem | arrays).items() if array is not None})
change("size", size=problem["size"][:5])
change("velocity", velocity=problem["velocity"].astype(numpy.float64))
change("contact_warm", contact_warm=None)
change("contact_bodies", contact_bodies=problem["contact_bodies"].reshape(-1))
change("contact_feature", contact_feature=problem["contact_feature"][1:])
change("version", version=numpy.int32(2))
pairs = problem["contact_bodies"].copy()
pairs[0, 1] = 1 << 30
change("bodies", contact_bodies=pairs)
PYTHON
/usr/bin/python3 -B "$sources/tests/pictures/hostile_runs.py" plain many_letters other_letters backwards control nan_velocity infinite other_dt
: >positions.npy
: >problem.hdf5
echo text >notes.npz
{ sed -n 's/^# size: \([^,]*,[^,]*,[^,]*\),.*/\1/p' poses.csv | tail -n +2 | sed '1ibody,width,height'; } >sizes.csv
sed 's/^3,1,1/3,1,0/' sizes.csv >flat.csv
printf '{}' >run.json

# Rows of a run that lack, repeat or break something.
truncate -s 2G huge.csv
head -c 100000 /dev/urandom >noise.csv
sed 's/^50,3,.*$//' poses.csv >line.csv
sed '/^50,3,/d' poses.csv >body.csv
sed '/^50,/d' poses.csv >frame.csv
{ cat poses.csv; grep '^50,3,' poses.csv; } >twice.csv
sed 's/^\(50,3\),[^,]*/\1,nan/' poses.csv >nan.csv
sed 's/^50,3,/4000000000,3,/' poses.csv >far.csv
at=$(grep -n '^50,3,' poses.csv | cut -d: -f1)
next=$(grep -n '^51,3,' poses.csv | cut -d: -f1)
first=$(grep -n '^50,1,' poses.csv | cut -d: -f1)
printf 'contact,normal,tangent\n19,1,0\n' >impulses-far.csv
printf 'contact,normal,tangent\n3,1,0\n3,1,0\n' >impulses-twice.csv
printf 'contact,normal,tangent\n3,nan,0\n' >impulses-nan.csv
printf 'mass\n1\n2\n3\n4\n5\n' >masses.csv
printf 'x\n-2\n-1\n0\n1\n2\n' >places.csv
printf 'x,colour\n1,red\n' >colour.csv
printf 'method,us\nengine,3\n' >other.csv

# Scenes: beside.yaml is never struck; in wall.yaml some launches put the bomb inside, and so does a lower wall the bricks.
{
    printf '%s\n' 'gravity: [0, -10]' 'dt: 1/60' 'iterations: 10' 'frames: 40' 'bodies:' \
        '  - {static: true, size: [100, 20], position: [0, -10]}'
    for x in -3.2 -1.6 0; do
        echo "  - {pattern: stack, count: 5, spacing: [0, \$high], mass: 6, size: [1.6, 0.8], position: [$x, 0.4]}"
    done
    echo 'bomb: {x: {from: -6, to: 6, value: 5}, y: 2, size: [1, 1], mass: 60, frame: 10, velocity: {times_position: -1.5}}'
    echo 'parameters: {high: {value: 0.8, from: 0.5, to: 1}}'
} >wall.yaml
sed 's/{from: -6, to: 6, value: 5}/{from: 40, to: 46, value: 45}/' wall.yaml >beside.yaml
sed '/^bomb:/d' wall.yaml >quiet.yaml
sed 's/{from: -6, to: 6, value: 5}/4/' wall.yaml >alone.yaml
cp "$scenes/single.yaml" "日本.yaml"
sed -i "s|networks/|$scenes/networks/|" "日本.yaml"
echo "gravity: [0]" >gravity.yaml
ln -s nothing.yaml nowhere-link.yaml
cat >gaps.yaml <<'YAML'
parameters:
  gap: {value: 2, from: 0.5, to: 3, unit: m}
  rows: {value: 2, from: 1, to: 4, unit: "m;", whole: on}
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 60
bodies:
  - {static: true, size: [100, 20], position: [0, -10]}
  - {mass: 1, size: [1, 1], position: [0, 0.5]}
  - {pattern: stack, count: $rows, spacing: [0, 1], mass: 1, size: [1, 1], position: [$gap, 0.5]}
YAML
