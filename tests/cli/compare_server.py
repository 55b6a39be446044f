# SPDX-License-Identifier: GPL-3.0-or-later
# compare_server.py TWINBOX: asks `twinbox compare --server` as a client of odiff does, in an empty folder. Writes a.png, b.png
# and wide.png, which compare_server.js compares, too.
import json
import os
import random
import struct
import subprocess
import sys
import zlib

WIDTH, HEIGHT = 64, 48
failures = checks = 0


def equal(what, found, wanted):
    global failures, checks
    checks += 1
    if found != wanted:
        failures += 1
        print(f"FAILED: {what}: {found}, not {wanted}")


def png(pixels, width):
    """pixels: (red, green, blue, alpha), row by row."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = [b"\0" + b"".join(map(bytes, pixels[i : i + width])) for i in range(0, len(pixels), width)]
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows))) +
            chunk(b"IEND", b""))


def chunks(path):
    """Of a PNG file: type -> data, with all data of a type joined."""
    data, at, found = open(path, "rb").read(), 8, {}
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        found[kind] = found.get(kind, b"") + data[at + 8 : at + 8 + size]
        at += 12 + size
    return found


def delta(a, b):
    """Kotsarenko and Ramos, in YIQ on white."""
    a, b = ([255 + (c - 255) * pixel[3] / 255 for c in pixel[:3]] for pixel in (a, b))
    y, i, q = (sum(k * (p - r) for k, p, r in zip(row, a, b)) for row in (
        (0.29889531, 0.58662247, 0.11448223), (0.59597799, -0.27417610, -0.32180189),
        (0.21147017, -0.52261711, 0.31114694)))
    return 0.5053 * y * y + 0.299 * i * i + 0.1957 * q * q


class Server:
    def __init__(self, twinbox):
        self.process = subprocess.Popen([twinbox, "compare", "--server"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        equal("first line", self.read(), {"ready": True})
        self.id = 0

    def read(self):
        return json.loads(self.process.stdout.readline())

    def say(self, line):
        """The answer to any line."""
        self.process.stdin.write(line)
        self.process.stdin.flush()
        return self.read()

    def ask(self, data=b"", **request):
        self.id += 1
        answer = self.say(json.dumps({"requestId": self.id, **request}).encode() + b"\n" + data)
        equal("the answer's requestId", answer.pop("requestId", None), self.id)
        return answer

    def files(self, base, compare, output=None, **options):
        return self.ask(base=base, compare=compare, output=output, options=options)

    def buffers(self, base, compare, kind="png", **more):
        return self.ask(base + compare, **{"type": "buffer", "baseLength": len(base), "baseFormat": kind,
                                           "compareLength": len(compare), "compareFormat": "png", **more})


numbers = random.Random(1)
a = [(numbers.randrange(256), numbers.randrange(256), numbers.randrange(256), 255) for _ in range(WIDTH * HEIGHT)]
b = [pixel if numbers.random() < 0.5 else tuple(max(0, min(255, c + numbers.randint(-60, 60))) for c in pixel[:3]) +
     (numbers.choice((255, 255, 128)),) for pixel in a]
THRESHOLDS = 0.0, 0.05, 0.1, 0.3
for i, (p, r) in enumerate(zip(a, b)):  # no pixel so near a threshold that rounding decides
    if any(0.98 < delta(p, r) / (35215 * threshold**2) < 1.02 for threshold in THRESHOLDS[1:]):
        b[i] = p
wide = [pixel for y in range(HEIGHT) for pixel in b[WIDTH * y : WIDTH * (y + 1)] + [(0, 0, 0, 255), (0, 0, 0, 0)]]
files = {"a.png": png(a, WIDTH), "b.png": png(b, WIDTH), "wide.png": png(wide, WIDTH + 2)}
files["damaged.png"] = files["a.png"][:-20]
for name, data in files.items():
    open(name, "wb").write(data)

server = Server(sys.argv[1])
equal("equal files", server.files("a.png", "a.png"), {"match": True})
for threshold in THRESHOLDS:
    differs = [delta(p, r) > threshold * threshold * 35215 for p, r in zip(a, b)]
    rows = [y for y in range(HEIGHT) if any(differs[WIDTH * y : WIDTH * (y + 1)])]
    columns = [x for x in range(WIDTH) if any(differs[x::WIDTH])]
    count = sum(differs)
    wanted = {"match": False, "reason": "pixel-diff", "diffCount": count,
              "diffPercentage": round(100 * count / len(a), 2), "diffLines": rows, "diffCols": columns}
    equal(f"threshold {threshold}",
          server.files("a.png", "b.png", threshold=threshold, captureDiffLines=True, captureDiffCols=True), wanted)
standard = server.files("a.png", "b.png")
equal("the standard threshold", standard, {"match": False, "reason": "pixel-diff", "diffCount": sum(
    delta(p, r) > 0.01 * 35215 for p, r in zip(a, b)), "diffPercentage": standard["diffPercentage"]})
equal("threshold 1", server.files("a.png", "b.png", threshold=1), {"match": True})

regions = [{"x1": 0, "y1": 0, "x2": WIDTH - 1, "y2": 9}, {"x1": 10, "y1": 10, "x2": 9999, "y2": 9999}]
below = server.files("a.png", "b.png", threshold=0, ignoreRegions=regions, captureDiffLines=True, captureDiffCols=True)
equal("columns beside the regions", below["diffCols"], list(range(10)))
equal("first row below the region", below["diffLines"][0], 10)
equal("all ignored", server.files("a.png", "b.png", ignoreRegions=[{"x1": 0, "y1": 0, "x2": 63, "y2": 47}]), {"match": True})

equal("another size", server.files("a.png", "wide.png", failOnLayoutDiff=True), {"match": False, "reason": "layout-diff"})
wider = server.files("a.png", "wide.png")
equal("a column more, and a transparent one", wider["diffCount"], standard["diffCount"] + HEIGHT)
equal("the sides exchanged", server.files("wide.png", "a.png"), wider)

# A line of two pixels that moves by half a pixel; then it is gone.
line, moved = ([(v, v, v, 255) for _ in range(HEIGHT) for x in range(WIDTH) for v in (shades.get(x, 255),)]
               for shades in ({30: 0, 31: 0}, {30: 128, 31: 0, 32: 128}))
blank = png([(255,) * 4] * (WIDTH * HEIGHT), WIDTH)
line, moved = png(line, WIDTH), png(moved, WIDTH)
edges = {"antialiasing": True}
equal("a line that moved", server.buffers(line, moved)["match"], False)
equal("the same as an edge", server.buffers(line, moved, options=edges), {"match": True})
equal("a line that is gone", server.buffers(line, blank, options=edges)["diffCount"], 2 * HEIGHT)

# The picture of the difference.
server.files("a.png", "b.png", "out.png", diffColor="#0a0b0c", threshold=0)
painted = chunks("out.png")
equal("its size", struct.unpack(">II", painted[b"IHDR"][:8]), (WIDTH, HEIGHT))
server.files("a.png", "b.png", "mask.png", diffColor="0a0b0c", outputDiffMask=True, threshold=0)
mask = chunks("mask.png")
equal("palette of the mask", (mask[b"PLTE"], mask[b"tRNS"]), (b"\0\0\0\x0a\x0b\x0c", b"\0"))
indices = zlib.decompress(mask[b"IDAT"])
equal("pixels of the mask", sum(indices[y * (WIDTH + 1) + 1 + x] for y in range(HEIGHT) for x in range(WIDTH)),
      sum(p != r for p, r in zip(a, b)))
equal("the painted pixels", server.files("out.png", "a.png", threshold=0)["diffCount"], sum(p != r for p, r in zip(a, b)))
server.files("a.png", "b.png", "pale.png", diffColor="#0a0b0c", diffOverlay=1, threshold=0)
white = png([(255,) * 4 if p == r else (10, 11, 12, 255) for p, r in zip(a, b)], WIDTH)
equal("pale without a share of the picture", server.buffers(open("pale.png", "rb").read(), white, options={"threshold": 0}),
      {"match": True})

# What is wrong gets an answer, and the next request its own.
wrong = [
    (b"\n{}\n", "base is missing"), (b"[1]\n", "base is missing"), (b"{\n", "request:1:"), (b"\xff\0\n", "request:1:"),
    (b'{"base":"a.png","compare":"a.png"}\n', "requestId must be"), (b"x" * 100000 + b"\n", "request:1:"),
    (b'{"requestId":1.5,"base":"a.png","compare":"a.png"}\n', "requestId must be")]
for text, message in wrong:
    answer = server.say(text)
    equal(f"{text[:30]}: {answer}", message in answer.get("error", "") and "requestId" not in answer, True)
for text, number in ((b'{"requestId": 7, "base": }\n', 7), (b'{"base":"a.png" "requestId":-3}\n', -3), (b'{"requestId":5.5,}\n', None),
                     (b'{"base":"\\"requestId\\":4"\n', None), (b'{"requestId":"8",}\n', None)):
    answer = server.say(text)
    equal(f"the requestId of {text}", (answer.get("requestId"), "request:1:" in answer["error"]), (number, True))
many = [{"x1": 0, "y1": 0, "x2": 1000 + i % 9, "y2": 1000} for i in range(4096)]
equal("4,096 regions", server.files("a.png", "b.png", ignoreRegions=many), {"match": True})
answer = server.files("a.png", "b.png", ignoreRegions=many + many[:1])
equal("one more", "ignoreRegions must be an array of at most 4096" in answer.get("error", ""), True)
for request, message in (
        ({"base": "a.png"}, "compare is missing"), ({"base": 1, "compare": "a.png"}, "base must be a text"),
        ({"base": "-", "compare": "a.png"}, "not '-'"), ({"base": "none.png", "compare": "a.png"}, "none.png: error: "),
        ({"base": "a.png", "compare": "damaged.png"}, "damaged.png: error: "),
        ({"base": "damaged.png", "compare": "damaged.png"}, "damaged.png: error: "),
        ({"base": "a.png", "compare": "b.png", "output": "-"}, "not '-'"),
        ({"base": "a.png", "compare": "b.png", "output": "none/out.png"}, "none/out.png: error: ")):
    answer = server.ask(**request)
    equal(f"{request}: {answer}", message in answer.get("error", ""), True)
for options, message in (
        ({"threshold": 2}, "threshold must be a number from 0 to 1"), ({"threshold": "0.1"}, "threshold must be"),
        ({"diffColor": "red"}, "diffColor must be"), ({"antialiasing": 1}, "antialiasing must be true or false"),
        ({"diffOverlay": -1}, "diffOverlay must be"), ({"ignoreRegions": {}}, "ignoreRegions must be an array"),
        ({"ignoreRegions": [{"x1": 0, "y1": 0, "x2": 1}]}, "ignoreRegions[0]: y2 must be"),
        ({"ignoreRegions": [{"x1": -1, "y1": 0, "x2": 1, "y2": 1}]}, "ignoreRegions[0]: x1 must be")):
    answer = server.files("a.png", "b.png", **options)
    equal(f"{options}: {answer}", message in answer.get("error", ""), True)
answer = server.ask(base="a.png", compare="b.png", options=3)
equal("options that are none", "options must be an object" in answer.get("error", ""), True)

# Files after the line: also behind a bad request, what follows them is the next one.
equal("files after the line", server.buffers(files["a.png"], files["b.png"]), standard)
equal("the same file", server.buffers(files["a.png"], files["a.png"]), {"match": True})
for more, message in (({"kind": "jpeg"}, 'baseFormat must be "png"'), ({"options": {"threshold": 9}}, "threshold"),
                      ({"output": 3}, "output must be a text")):
    answer = server.buffers(files["a.png"], files["b.png"], **more)
    equal(f"{more}: {answer}", message in answer.get("error", ""), True)
    equal("the next one", server.files("a.png", "b.png"), standard)
equal("no PNG file", "base: error: " in server.buffers(b"\nhello", files["a.png"]).get("error", ""), True)
answer = server.say(json.dumps({"type": "buffer", "baseLength": 3, "baseFormat": "png", "compareLength": 2,
                                "compareFormat": "png"}).encode() + b"\nabcde")
equal(f"no requestId: {answer}", "error" in answer and "requestId" not in answer, True)
equal("the next one", server.files("a.png", "b.png"), standard)

server.process.stdin.write(b'{"requestId":99,"base":"a.png","compare":"a.png"}')  # without an end
server.process.stdin.close()
equal("the last line", server.read(), {"requestId": 99, "match": True})
equal("exit status", server.process.wait(), 0)
# Where it is not known how many bytes follow, none of them is a request: a picture may have a line that looks like one.
smuggled = json.dumps({"requestId": 5, "base": "a.png", "compare": "b.png", "output": "smuggled.png"}).encode() + b"\n"
def lengths(base, compare):
    return json.dumps({"requestId": 1, "type": "buffer", "baseLength": base, "baseFormat": "png", "compareLength": compare,
                       "compareFormat": "png"}).encode()
for line in (lengths(0, 9), lengths(9, 0), lengths(-1, 9), lengths(1.5, 9), lengths("9", 9), lengths(None, 9), lengths(9, True),
             lengths(9, 9)[:-1], lengths(10**30, 9), b'{"requestId":1,"type":"buffer"}',
             b'{"requestId":1,"a":"' + b"x" * (1 << 19) + b'","type":"buffer"}'):
    done = subprocess.run([sys.argv[1], "compare", "--server"], input=line + b"\n\x89PNG\n" + smuggled, capture_output=True)
    answers = [json.loads(text) for text in done.stdout.splitlines()]
    equal(f"answers to {line[:90]}", (len(answers), answers[-1]["requestId"], "error" in answers[-1]), (2, 1, True))
    equal("its end", (done.returncode, b"the server ends" in done.stderr), (2, True))
equal("no file is written", os.path.exists("smuggled.png"), False)
print(f"{checks} checks, {failures} failures")
sys.exit(failures > 0)
