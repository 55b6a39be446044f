#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the arrays of a .npz as an input of the fuzzers (fuzz_archive.h): record.py FILE.npz [LETTER] >INPUT.

LETTER begins the input of the target network. Of a long array only the first bytes are written; they are repeated when the
archive is built, so the shapes stay.
"""
import sys
import zipfile

MOST = 1024  # bytes of an array
TYPES = ["<f4", "<f8", "<i4", "<u4", "<i8", "<u8", "|u1", "|i1", "<i2", "<u2", "|b1"]


def two(number):
    return min(number, 65535).to_bytes(2, "little")


def record(name, member):
    start = 10 if member[6] == 1 else 12
    length = int.from_bytes(member[8:start], "little")
    head = eval(member[start : start + length].decode(), {}, {})  # of our own files
    data = member[start + length :]
    name = bytes([len(name)]) + name.encode()
    if head["descr"].startswith("<U"):
        text = data.decode("utf-32-le").encode("latin-1", "replace")
        return bytes([11]) + name + two(len(text)) + text
    shape = head["shape"]
    item = TYPES.index(head["descr"])
    data = data[:MOST]
    return (
        bytes([item]) + name + bytes([len(shape)]) + b"".join(map(two, shape)) + two(len(data)) + data
    )


with zipfile.ZipFile(sys.argv[1]) as archive:
    out = sys.argv[2].encode() if len(sys.argv) > 2 else b""
    for entry in archive.namelist():
        out += record(entry.removesuffix(".npy"), archive.read(entry))
sys.stdout.buffer.write(out)
