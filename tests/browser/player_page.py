# SPDX-License-Identifier: GPL-3.0-or-later
"""What a page that plays runs carries (src/pictures/player_internal.h)."""
import json
import re
import zlib


def unpacked(page, element):
    """The bytes of a deflated element of a page, a text."""
    text, = re.findall(f'<script type="text/plain" id="{element}">([#-;=-~]*)</script>', page)
    digits = [ord(character) - 36 if character != "#" else 24 for character in text]
    groups = [f"{low + 91 * high:013b}" for low, high in zip(digits[::2], digits[1::2])]
    groups += [f"{digits[-1]:06b}"] * (len(digits) % 2)
    bits = "".join(group[::-1] for group in groups)
    packed = bytes(int(bits[at:at + 8][::-1], 2) for at in range(0, len(bits) - 7, 8))
    return zlib.decompress(packed, -15)


def data(path):
    """The data of a page in a file."""
    with open(path, encoding="utf-8") as file:
        return json.loads(unpacked(file.read(), "data"))
