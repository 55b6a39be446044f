# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of texts, for scenes/article/make and golden/findings/write. A file defines each in a line:

    NAME = STUDY/TABLE COLUMN WHERE... [/ STUDY/TABLE COLUMN WHERE...] [as FORMAT]

WHERE is COLUMN=TEXT, and one row must match all of them; a value with spaces is in quotes. The column "rows" counts those that
match. With a slash the number is a quotient. FORMAT: "digits N" (significant ones, default 2), "percent", "text", as it is, or "range":
median, least and most of all rows that match."""
import csv
import shlex
import statistics


class Refusal(Exception):
    """What the reader of the message must mend."""


def read_table(path, where=""):
    """The rows of a CSV file."""
    try:
        with open(path, encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        raise Refusal(f"{where}{path}: {error.strerror}") from None


def read_value(text, studies, where, many=False):
    table, column, *conditions = shlex.split(text)
    rows = read_table(studies / table, f"{where}: ")
    wanted = dict(condition.split("=", 1) for condition in conditions)
    unknown = [key for key in [column, *wanted] if rows and key not in rows[0] and key != "rows"]
    if unknown:
        raise Refusal(f"{where}: {table} has no column {unknown[0]}")
    found = [row for row in rows if all(row[key] == value for key, value in wanted.items())]
    if column == "rows":
        return str(len(found)), table.split("/")[0]
    if many and found and all(row[column] for row in found):
        return [float(row[column]) for row in found], table.split("/")[0]
    if len(found) != 1 or found[0][column] == "":
        raise Refusal(f"{where}: {len(found)} rows of {table} match{' and the value is empty' if len(found) == 1 else ''}")
    return found[0][column], table.split("/")[0]


def show(number, digits):
    """0.0213 as 0.021, 21.1 as 21, 1500 as 1,500."""
    text = f"{number:.{digits}g}"
    return f"{float(text):,.0f}" if abs(number) >= 10 ** (digits - 1) else format(float(text), "g")


def read_number(line, studies, place):
    """(name, its text, the study that has it) of a line."""
    name, rest = (part.strip() for part in line.split("=", 1))
    rest, _, form = rest.partition(" as ")
    values = [read_value(part, studies, f"{place}: {name}", form == "range") for part in rest.split(" / ")]
    if form == "range":
        median, least, most = (show(find(values[0][0]), 2) for find in (statistics.median, min, max))
        return name, f"{median} ({least} to {most})", values[0][1]
    if form == "text":
        return name, values[0][0], values[0][1]
    number = float(values[0][0]) / (float(values[1][0]) if len(values) == 2 else 1)
    if form == "percent":
        return name, f"{100 * number:.0f}%", values[0][1]
    return name, show(number, int(form.split()[1]) if form else 2), values[0][1]


def read_numbers(path, studies):
    """{name: (text, study)} of a file."""
    lines = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
    read = [read_number(line, studies, path.name) for line in lines if line and line[0] != "#"]
    return {name: (text, study) for name, text, study in read}
