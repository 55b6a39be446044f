# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as arrays, and how much they differ."""
import base64
import struct
import subprocess

import numpy

DRAW = """(async () => {
  const stage = document.getElementById("stage");
  stage.style.cssText = `position: fixed; left: 0; top: 0; width: ${$0}px; height: ${$1}px`;
  await player.load($2);
  player.change({frame: $2, body: -1});
  player.draw();
  return stage.toDataURL().split(",")[1];
})()"""


def decode(data):
    """A PNG file: height, width, RGB."""
    width, height = struct.unpack(">II", data[16:24])
    command = "ffmpeg", "-v", "error", "-f", "png_pipe", "-i", "-", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"
    pixels = subprocess.run(command, input=data, stdout=subprocess.PIPE, check=True).stdout
    return numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 3).astype(float)


def read(path):
    with open(path, "rb") as file:
        return decode(file.read())


def draw(page, width, height, frame):
    """What the page draws on its canvas in this size. As a PNG file it comes through the browser's pipe in a hundredth of the
    time that its pixels take."""
    return decode(base64.b64decode(page.run(DRAW, width, height, frame)))


def difference(golden, drawn, left, top, right, bottom):
    """The mean of a part of two pictures, of the channel that differs most."""
    return numpy.abs(golden[top:bottom, left:right] - drawn[top:bottom, left:right]).mean(axis=(0, 1)).max()
