# SPDX-License-Identifier: GPL-3.0-or-later
"""wheel.py PYPROJECT FOLDER: writes the wheel of a package with one module and one entry point, with the same bytes each time
(https://packaging.python.org/specifications/binary-distribution-format)."""
import base64
import hashlib
import pathlib
import re
import sys
import zipfile

project, folder = map(pathlib.Path, sys.argv[1:])
text = project.read_text()
values = dict(re.findall(r'^([\w-]+) = \[?"([^"]*)"', text, re.MULTILINE))
group = re.search(r"entry-points\.(\w+)", text)[1]
module, distribution = values["py-modules"], values["name"].replace("-", "_")
info = f"{distribution}-{values['version']}.dist-info"
files = {
    f"{module}.py": (project.parent / f"{module}.py").read_text(),
    f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {values['name']}\nVersion: {values['version']}\nSummary: {values['description']}\n"
                        f"Requires-Python: {values['requires-python']}\nRequires-Dist: {values['dependencies']}\n",
    f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: twinbox\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    f"{info}/entry_points.txt": f"[{group}]\ntwinbox = {module}\n"}
record = [(name, base64.urlsafe_b64encode(hashlib.sha256(text.encode()).digest()).decode().rstrip("="), len(text.encode()))
          for name, text in files.items()]
files[f"{info}/RECORD"] = "".join(f"{name},sha256={digest},{size}\n" for name, digest, size in record) + f"{info}/RECORD,,\n"
with zipfile.ZipFile(folder / f"{distribution}-{values['version']}-py3-none-any.whl", "w", zipfile.ZIP_DEFLATED) as wheel:
    for name, text in files.items():
        wheel.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), text, zipfile.ZIP_DEFLATED)
