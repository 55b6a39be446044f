# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys as Input.dispatchKeyEvent wants them, of a keyboard with the English (US) layout."""
MODIFIERS = {"Alt": 1, "Control": 2, "Meta": 4, "Shift": 8}
# Name: code, Windows' number of the key, the text it writes.
NAMED = {"Space": ("Space", 32, " "), "Enter": ("Enter", 13, "\r"), "Escape": ("Escape", 27, ""), "Tab": ("Tab", 9, ""),
         "Backspace": ("Backspace", 8, ""), "Delete": ("Delete", 46, ""), "Home": ("Home", 36, ""),
         "End": ("End", 35, ""),
         "PageUp": ("PageUp", 33, ""), "PageDown": ("PageDown", 34, ""), "ArrowLeft": ("ArrowLeft", 37, ""),
         "ArrowUp": ("ArrowUp", 38, ""), "ArrowRight": ("ArrowRight", 39, ""), "ArrowDown": ("ArrowDown", 40, "")}
SIGNS = {"-": ("Minus", 189), "=": ("Equal", 187), "[": ("BracketLeft", 219), "]": ("BracketRight", 221),
         ",": ("Comma", 188), ".": ("Period", 190), "/": ("Slash", 191), ";": ("Semicolon", 186), "'": ("Quote", 222),
         "\\": ("Backslash", 220), "`": ("Backquote", 192)}
SHIFTED = dict(zip('_+{}<>?:"|~)!@#$%^&*(', "-=[],./;'\\`0123456789"))
SHIFTED["<"], SHIFTED[">"] = ",", "."


def key_of(name):
    """key, code, number, text and whether it needs Shift."""
    if name in NAMED:
        code, number, text = NAMED[name]
        return (" " if name == "Space" else name), code, number, text, False
    if len(name) != 1:
        raise ValueError(f"no key {name}")
    plain = SHIFTED.get(name, name.lower())
    shift = name in SHIFTED or name.isupper()
    if plain in SIGNS:
        code, number = SIGNS[plain]
    else:
        code, number = ("Digit" if plain.isdigit() else "Key") + plain.upper(), ord(plain.upper())
    return name, code, number, name, shift


def events(name):
    """Down and up. "Shift+Tab", "Control+c", "?" (which holds Shift by itself)."""
    held = 0
    while "+" in name[:-1]:
        modifier, _, name = name.partition("+")
        held |= MODIFIERS[modifier]
    key, code, number, text, shift = key_of(name)
    held |= MODIFIERS["Shift"] if shift else 0
    event = {"key": key, "code": code, "windowsVirtualKeyCode": number, "modifiers": held}
    writes = text and not held & ~MODIFIERS["Shift"]
    return [{"type": "keyDown" if writes else "rawKeyDown", **event, **({"text": text} if writes else {})},
            {"type": "keyUp", **event}]
