# SPDX-License-Identifier: GPL-3.0-or-later
# make_files.py: writes files that are small and would cost much, into the working directory. What is compressed is
# repeated as compressed, so that making them costs little, too.
import json
import os
import struct
import zlib

MiB = 1 << 20
PADDING = 700000  # bytes that a .npz may hold beside its arrays; 256 times as much may be decompressed from it


def deflate_zeros(head, zeros, wrapped=False):
    """A stream of `head` and so many zeros: of zlib if wrapped, else raw."""
    pack = zlib.compressobj(9, zlib.DEFLATED, 15 if wrapped else -15)
    start = pack.compress(head) + pack.flush(zlib.Z_FULL_FLUSH)
    block = pack.compress(bytes(MiB)) + pack.flush(zlib.Z_FULL_FLUSH)
    rest = pack.compress(bytes(zeros % MiB)) + pack.flush(zlib.Z_FULL_FLUSH)
    packed = start + block * (zeros // MiB) + rest + b"\x03\0"
    if not wrapped:
        return packed
    assert head == b""
    return packed + struct.pack(">I", zeros % 65521 << 16 | 1)  # Adler-32 of zeros


def save(path, data):
    with open(path, "wb") as file:
        file.write(data)


# --- .npz ---

SIZES = {"<f4": 4, "<i4": 4, "<u4": 4, "<i8": 8, "|u1": 1, "<f8": 8}


class Array:
    """Of zeros, whose checksum is wrong unless `sound`: a reader that decompresses it finds it damaged. Or of data."""

    def __init__(self, kind, shape, data=None, sound=False):
        count = 1
        for n in shape:
            count *= n
        words = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': ({', '.join(map(str, shape))}{',' * (len(shape) == 1)}), }}"
        words += " " * (-(len(words) + 11) % 64) + "\n"
        head = b"\x93NUMPY\1\0" + struct.pack("<H", len(words)) + words.encode()
        if data is None:
            self.size = len(head) + count * SIZES[kind]
            self.packed = deflate_zeros(head, count * SIZES[kind])
            self.crc = zlib.crc32(head + bytes(count * SIZES[kind])) if sound else 1
        else:
            self.size = len(head) + len(data)
            pack = zlib.compressobj(9, zlib.DEFLATED, -15)
            self.packed = pack.compress(head + data) + pack.flush()
            self.crc = zlib.crc32(head + data)


def text(words):
    return Array(f"<U{len(words)}", (), words.encode("utf-32le"))


def number(kind, value):
    return Array(kind, (), struct.pack(kind[0] + {"f4": "f", "i4": "i"}[kind[1:]], value))


def zip_of(arrays, padding=0, shared=False):
    """shared: all members are the bytes of the first."""
    data, directory, first = b"", b"", None
    for name, array in arrays.items():
        name = name.encode() + b".npy"
        at = len(data)
        fields = struct.pack("<HHHHHIIIHH", 20, 0, 8, 0, 33, array.crc, len(array.packed), array.size, len(name), 0)
        if first is None or not shared:
            data += b"PK\3\4" + fields + name + array.packed
            first = at if first is None else first
        else:
            at = first
        directory += b"PK\1\2" + struct.pack("<H", 20) + fields + struct.pack("<HHHII", 0, 0, 0, 0, at) + name
    data += b"\x55" * padding
    count = len(arrays)
    return data + directory + b"PK\5\6" + struct.pack("<HHHHIIH", 0, 0, count, count, len(directory), len(data), 0)


def run(frames, bodies, **other):
    arrays = {"dt": number("<f4", 1 / 60), "size": Array("<f4", (bodies, 2), struct.pack("<f", 1) * 2 * bodies),
              "position": Array("<f4", (frames, bodies, 2)), "angle": Array("<f4", (frames, bodies)),
              "velocity": Array("<f4", (frames, bodies, 2)), "angular_velocity": Array("<f4", (frames, bodies))}
    return {**arrays, **other}


def head(kind, version):
    return {"version": number("<i4", version), "kind": text(kind), "command": text("")}


def make_npz():
    frames, bodies, rows = 50000, 100, 1000000
    save("bomb.npz", zip_of(run(400000, 100)))
    save("twins.npz", zip_of({f"a{i}": Array("|u1", (16 * MiB,)) for i in range(100)}, shared=True))
    for name, size, fixed in (("flat", 0, 0), ("still", 1, 0), ("still2", 1, 1)):  # within the budget of the smallest file
        arrays = {key: Array("<f4", (6000, 100, 2)[:rank], sound=True) for key, rank in
                  (("position", 3), ("angle", 2), ("velocity", 3), ("angular_velocity", 2))}
        arrays |= {"size": Array("<f4", (100, 2), struct.pack("<f", size) * 200),
                   "fixed": Array("|u1", (100,), bytes([fixed] * 100)),
                   "contact_start": Array("<i8", (6001,), bytes(16) + struct.pack("<q", 50000) * 5999),
                   "contact_bodies": Array("<i4", (50000, 2), struct.pack("<ii", 0, 1) * 50000),
                   "contact_feature": Array("<u4", (50000,), sound=True)}
        arrays |= {f"contact_{key}": Array("<f4", (50000, 2), sound=True) for key in ("point", "normal", "impulse")}
        save(f"{name}.npz", zip_of(run(0, 0, **arrays)))
    save("run.npz", zip_of(run(frames, bodies, angular_velocity=Array("<f4", (frames, bodies - 1))), PADDING))
    contacts = {f"contact_{name}": Array(kind, (rows, 2)) for name, kind in
                (("bodies", "<i4"), ("point", "<f4"), ("normal", "<f4"))}
    contacts |= {"contact_start": Array("<i8", (frames + 1,)), "contact_feature": Array("<u4", (rows,)),
                 "contact_impulse": Array("<f4", (rows - 1, 2))}
    save("contacts.npz", zip_of(run(frames, bodies, **contacts), PADDING))
    save("dataset.npz", zip_of({
        **head("dataset", 3), "view": text("relative"), "target": text("pair"), "labels": text("engine"),
        "scenes": text("stack"), **{f"launch_{name}": Array("<f4", (rows,)) for name in ("x", "rotation", "spin")},
        "launch_scene": Array("<i4", (rows,)), "launch_test": Array("|u1", (rows,)), "inputs": Array("<f4", (rows, 10)),
        "changes": Array("<f4", (rows, 2)), "launch": Array("<i4", (rows,)), "frame": Array("<i4", (rows,)),
        "bodies": Array("<i4", (rows, 3))}, PADDING))
    counts = {"position": 2, "angle": 1, "size": 2, "inv_mass": 1, "inv_inertia": 1, "velocity": 2, "angular_velocity": 1}
    points = {"position": 2, "normal": 2, "arm_a": 2, "arm_b": 2, "separation": 1, "mass": 2, "friction": 1, "bias": 1}
    fields = lambda list, n: {name: Array("<f4", (n, 2) if c == 2 else (n,)) for name, c in list.items()}
    save("problem.npz", zip_of({
        **head("contact problem", 1), "scene": text("stack"), "frame": number("<i4", 1), "dt": number("<f4", 1 / 60),
        "bomb": number("<i4", -1), **fields(counts, 100000),
        **fields({f"contact_{name}": c for name, c in points.items()}, rows), "contact_warm": Array("<f4", (rows - 1, 2)),
        "contact_bodies": Array("<i4", (rows, 2)), "contact_feature": Array("<u4", (rows,))}, PADDING))
    widths = [4096] * 9
    save("network.npz", zip_of({
        **head("network", 3), "inputs": text("a"), "outputs": text("b"), "target": text("pair"),
        "activations": text(" ".join(["relu"] * 8)), "widths": Array("<i4", (9,), struct.pack("<9i", *widths)),
        "weights_0": Array("<f4", (4096, 4096)), "biases_0": Array("<f4", (4096,))}, PADDING))
    slots = 20000
    save("slots.npz", zip_of({
        **head("scene-net", 2), "scene": text("stack"), "body_count": number("<i4", 256), "bomb": number("<i4", 0),
        "sweeps": number("<i4", 0),
        "slot_a": Array("<i4", (slots,), struct.pack("<i", 0) * slots),
        "slot_b": Array("<i4", (slots,), struct.pack("<i", 1) * slots),
        "slot_feature": Array("<u4", (slots,), struct.pack(f"<{slots}I", *range(slots))),
        "state_rows": Array("<f4", (255 * 6, 16)), "present_rows": Array("<f4", (slots, 16)),
        "warm_rows": Array("<f4", (2 * slots, 16)), "last_rows": Array("<f4", (2 * slots, 1024))}, PADDING))


# --- PNG ---

def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, depth=8, color=6, interlace=0, before=b"", pixels=None):
    samples = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    if pixels is None:
        pixels = chunk(b"IDAT", deflate_zeros(b"", height * (1 + (width * samples * depth + 7) // 8), True))
    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, interlace)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + before + pixels + chunk(b"IEND", b"")


def make_png():
    save("small.png", png(8, 8))
    save("grey.png", png(8, 8, color=0))
    save("honest.png", png(3000, 3000, 16))
    save("changed.png", png(3000, 3000, 16, 2))
    save("deep.png", png(10000, 10000, 16))
    save("interlaced.png", png(10000, 10000, 16, interlace=1))
    save("wide.png", png(100000000, 1, 1, 0))
    save("pixels.png", png(40000, 40000, 1, 0))
    save("cut.png", png(10000, 10000)[:-1])
    texts = b"State\0\0" + zlib.compress(bytes(MiB), 9)
    save("texts.png", png(8, 8, before=chunk(b"zTXt", texts) * 1000 + chunk(b"tEXt", b"State\0" + b"1" * 60000) * 100))
    save("empty.png", png(8, 8, pixels=chunk(b"IDAT", b"") * 200000))


# --- text ---

def make_json():
    os.makedirs("copies", exist_ok=True)
    item = {"failed": True, "shown": True, "expected": None, "actual": {"name": "a.png", "xxh3": "0" * 16}}
    start = '{"format": "twinbox compare 1", "expected": "e", "actual": "a", "trajectories": [], "frames": ['
    save("copies/results.json", (start + ",\n".join([json.dumps(item)] * 80000) + "]}").encode())
    for name, value in (("deep", "[" * MiB), ("long", '"' + "a" * MiB + '"'), ("many", "[" + "{}," * MiB),
                        ("members", ",".join('{"%d": 0}' % i for i in range(200000)))):
        os.makedirs(name, exist_ok=True)
        save(f"{name}/results.json", (start + value).encode())
    for folder in ("names", "e", "a"):
        os.makedirs(folder, exist_ok=True)
    items = [json.dumps({**item, "shown": False, "actual": {"name": f"{i}.png", "xxh3": "0" * 16}}) for i in range(60000)]
    save("names/results.json", (start + ",\n".join(items) + "]}").encode())
    for folder in ("expected", "actual"):
        os.makedirs(folder, exist_ok=True)
        save(f"{folder}/x.png", png(8, 8, color=6 if folder == "actual" else 2))
        save(f"{folder}/manifest.json", ("{" + ",".join('"%d": 0' % i for i in range(300000))).encode())


def make_yaml():
    most = 3 << 19
    bodies = "bodies:\n" + "".join(f"  - {{size: [1, 1], mass: 1, position: [{i}, 0]}}\n" for i in range(40000))
    heap = "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 2\noverlaps: allowed\ncamera: {center: [0, 0], size: [9, 9]}\nbodies:\n"
    save("heap.yaml", (heap + "  - {size: [1, 1], mass: 1, position: [0, 0]}\n" * 9900).encode())
    for name, words in (("line", "[" * most), ("keys", "".join(f"k{i}: 1\n" for i in range(99999))),
                        ("folded", "a: >\n" + " x\n\n" * most), ("bodies", bodies),
                        ("aliases", "a: &a [x, x]\nb: &b [*a, *a]\n"), ("large", "#" * (most + 1))):
        save(f"{name}.yaml", words[:most + 1].encode()[:most + (name == "large")])
    save("rules.yaml", ("rules:\n" + "- {files: '*', tolerance: 1}\n" * 40000).encode())


def make_csv():
    save("rows.csv", b"a,b\n" + b"1,2\n" * MiB)
    save("line.csv", b"# size: 0,1,1\nframe,body,x,y,angle\n" + b"0," * MiB)
    save("far.csv", b"# size: 0,1,1\nframe,body,x,y,angle\n0,0,0,0,0\n2000000000,0,0,0,0\n")
    save("run.csv", b"# size: 0,1,1\n# dt: 1\nframe,body,x,y,angle\n" + b"".join(b"%d,0,0,0,0\n" % i for i in range(300000)))
    save("sparse.csv", b"".join(b"# size: %d,1,1\n" % i for i in range(1000)) + b"# dt: 1\nframe,body,x,y,angle\n" +
         b"".join(b"%d,%d,0,0,0\n" % (i, min(i, 999)) for i in range(80000)))
    save("launches.csv", b"x,rotation,spin\n" + b"1,2,3\n" * 3 * MiB)


make_npz()
make_png()
make_json()
make_yaml()
make_csv()
