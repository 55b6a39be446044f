#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The article: its numbers are those of tables that this test plants; what is missing ends its making; links lead somewhere; commands
# make what they stand under.
. "$(dirname "$0")/checks.sh"
export PYTHONDONTWRITEBYTECODE=1
make=$sources/scenes/article/make
if ! "$twinbox" page --live "$scenes/single.yaml" -o live.html 2>err; then
    echo "skipped: $(cat err)"
    exit 77
fi

# Tables with a value of its own for each number of numbers.txt, and pictures.
/usr/bin/python3 - "$sources/scenes/article" <<'PYTHON' || fail "planting"
import csv
import json
import os
import re
import shlex
import sys

tables, wanted, value = {}, {}, 1.25
for line in open(f"{sys.argv[1]}/numbers.txt"):
    if not line.strip() or line[0] == "#":
        continue
    name, rest = (part.strip() for part in line.split("=", 1))
    for part in rest.partition(" as ")[0].split(" / "):
        table, column, *conditions = shlex.split(part)
        row = dict(condition.split("=", 1) for condition in conditions)
        known = next((other for other in tables.setdefault(table, []) if row.items() <= other.items()), None)
        if known is None:
            tables[table].append(known := row)
        if column != "rows" and column not in known:
            value += 1.37
            known[column] = f"{value:.6g}"
        wanted.setdefault(name, []).append(known.get(column, "rows"))
league = {"study": "stack_height", "method": "exec", "setting": "toy,name=Toy", "holds_at": "3", "fails_at": "4", "verdict": "sinks"}
tables["league/stability.csv"] = [{"verdict": "falls", "fails_at": "", "holds_at": ""} | row
                                  for row in tables["league/stability.csv"] + [league]]
tables["league/engines.csv"] = [{"method": "exec", "setting": "toy,name=Toy", "engine": "Toy", "version": "1.0"}]
for table, rows in tables.items():
    path = f"site.studies/{table}"
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)), restval="")
        writer.writeheader()
        writer.writerows(rows)
article = open(f"{sys.argv[1]}/article.md").read()
for file in re.findall(r"\[\[figure (\S+) \|", article):
    os.makedirs(os.path.dirname(f"site.studies/{file}"), exist_ok=True)
    open(f"site.studies/{file}", "w").write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 174.000 90.5"></svg>')
for study, file in ("league", "stability.html"), ("paper", "study.csv"):
    open(f"site.studies/{study}/{file}", "w").close()
json.dump(wanted, open("wanted.json", "w"))
PYTHON
cp "$sources/scenes/article/article.md" article.md

"$make" site "$twinbox" --text article.md >made 2>err || fail "make: $(cat err)"
says_made() { grep -qF -- "$1" made || fail "no '$1' in: $(cat made)"; }
says_made "site/index.html: "
run 0 simulate "$scenes/stack.yaml" --method engine:k=500 -o run.npz
grep -o 'verdict: .*' out >words
/usr/bin/python3 - "$sources/scenes/article" <<'PYTHON' || fail "the site"
import html.parser
import json
import os
import re
import urllib.parse

page = open("site/index.html", encoding="utf-8").read()
shown = re.findall(r'<a class="number" href="#\w+" title="[^"]+">([^<]+)</a>', page)
for name, values in json.load(open("wanted.json")).items():
    if values == ["rows"]:
        continue
    number = float(values[0]) / (float(values[1]) if len(values) == 2 else 1)
    medians = [text.split()[0].replace(",", "") for text in shown if re.fullmatch(r"[\d.,]+( \(\S+ to \S+\))?", text)]
    close = [median for median in medians if abs(float(median) / number - 1) < 0.06]
    assert close, (name, values, shown)
assert "Toy 1.0" in page and ">3 | 4<br><span class=\"soft\">sinks</span>" in page
# What fell in each live figure, in the words of simulate; where the reader predicts, only how many.
words = open("words").read().strip().removeprefix("verdict: ")
assert f'<span class="verdict">engine:k=500 {words}</span>' in page, words
panels = [line.split("|")[2].split() for line in open("article.md") if line.startswith("[[live") and "predict=" not in line]
assert page.count('<span class="verdict">') == sum(map(len, panels)) > 10, panels
assert re.search(r"(None|One|Two|Three|Four) fall and (none|one|two|three|four) stand\.", page)
assert not re.search(r"\{\w+\}|\[\[|<!--", page), "something is not filled in"


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.targets, self.alts, self.heads, self.words = set(), [], 0, [], 0

    def handle_starttag(self, tag, attributes):
        got = dict(attributes)
        self.ids.add(got.get("id"))
        self.targets += [got[key] for key in ("href", "src") if key in got]
        if tag == "img":
            assert len(got["alt"]) > 20 and int(got["width"]) > 100 and int(got["height"]) > 50, got
        if tag in ("h1", "h2"):
            self.heads.append(tag)

    def handle_data(self, data):
        self.words += len(data.split())


links = Links()
links.feed(page)
assert links.heads[0] == "h1" and links.heads.count("h1") == 1 and links.heads.count("h2") == 10, links.heads
for target in links.targets:
    path, _, fragment = target.partition("#")
    if path.startswith("https://doi.org/"):
        continue
    assert "://" not in path, target
    assert os.path.exists(f"site/{urllib.parse.unquote(path)}") if path else fragment in links.ids, target
text = open("article.md").read()
words = len(re.sub(r"\[\[.*?\]\]", "", text, flags=re.S).split())
assert 1100 <= words <= 2500, words
assert not re.search(r"(src|href)=.?https?:(?!//doi)", page) and "@import" not in page
size = sum(os.path.getsize(f"site/{name}") for name in os.listdir("site"))
assert size < 3e6, size
PYTHON

# The same again is the same; and what cannot be made leaves it as it was.
sums() { (cd site && find . -type f | sort | xargs md5sum); }
before=$(sums)
"$make" site "$twinbox" --text article.md >made 2>err || fail "make again: $(cat err)"
equal "the site made twice" "$(sums)" "$before"
{ cat article.md; echo "[[figure none/none.svg | none]]"; } >broken.md
"$make" site "$twinbox" --text broken.md >made 2>err && fail "a missing figure is accepted"
equal "the site after a failure" "$(sums)" "$before"
equal "folders beside it" "$(ls -d .site* 2>/dev/null)" ""

# What is missing or left over ends it, with its place.
mv site.studies/chart/chart.csv kept.csv
touch site.studies/chart/chart.csv
"$make" other "$twinbox" --text article.md --studies site.studies >made 2>err && fail "an empty table is accepted"
complains "numbers.txt: sweeps_10: 0 rows of chart/chart.csv match"
mv kept.csv site.studies/chart/chart.csv
sed 's/{sweeps_10}/{sweeps_11}/' article.md >unknown.md
"$make" other "$twinbox" --text unknown.md --studies site.studies >made 2>err && fail "an unknown number is accepted"
complains "article.md: no number sweeps_11 in numbers.txt"
sed 's/{sweeps_10}/3/' article.md >typed.md
"$make" other "$twinbox" --text typed.md --studies site.studies >made 2>err && fail "a typed number is accepted"
complains "numbers.txt: sweeps_10: not used in article.md"
mv site.studies/paper/figures/factors.svg kept.svg
"$make" other "$twinbox" --text article.md --studies site.studies >made 2>err && fail "a missing picture is accepted"
complains "paper/figures/factors.svg is missing"
! brief || finish

# The command under each live figure makes its page. Those of the studies make, in a short form, the files that the article takes from
# them; of the paper and the league, which take long in any form, one piece shows that the command is valid.
mkdir -p typed/bin typed/league
ln -s "$twinbox" typed/bin/twinbox
ln -s "$scenes" typed/scenes
touch typed/league/large.csv
printf '#!/bin/sh\nexec twinbox "$@" --shard 1/1000000\n' >typed/bin/piece
chmod +x typed/bin/piece
PYTHONPATH=$sources/tests/cli:$sources/tests/browser /usr/bin/python3 - "$sources/scenes/article" <<'PYTHON' || fail "the commands"
import html
import os
import re
import subprocess
import sys

import player_page

page = open("site/index.html", encoding="utf-8").read()
PATH = f"{os.getcwd()}/typed/bin:{os.environ['PATH']}"


def enter(command, **variables):
    subprocess.run(html.unescape(command), shell=True, cwd="typed", check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                   env={**os.environ, "PATH": PATH, **variables})


figures = [line.split("|")[2].split() for line in open("article.md", encoding="utf-8") if line.startswith("[[live")]
made = re.findall(r'<a href="([\w-]+\.html)#[^"]*">Open on its own page</a>, made by <code>([^<]+)</code>', page)
assert len(made) == page.count('class="live"') == len(figures) > 6, made
for (name, command), methods in zip(made, figures):
    enter(command)
    assert [run["live"] for run in player_page.data(f"typed/{name}")["runs"]] == methods, (command, methods)
    assert open(f"typed/{name}", "rb").read() == open(f"site/{name}", "rb").read(), command

studies = dict(re.findall(r'<li id="(\w+)"><code>([^<]+)</code></li>', page))
taken = re.findall(r"\[\[figure (\w+)/(\S+) \|", open(f"{sys.argv[1]}/article.md", encoding="utf-8").read())
taken += re.findall(r"[=/] (\w+)/(\w+\.csv) ", open(f"{sys.argv[1]}/numbers.txt", encoding="utf-8").read())
assert {study for study, _ in taken} == studies.keys(), (taken, studies)
short = {"chart": " --quick --launches 1", "height": " --quick", "paper": " --quick --shard 1/1000000", "chaos": "", "league": ""}
for study, command in studies.items():
    enter(command + short[study], TWINBOX="piece" if study == "league" else "twinbox")
    pieces = any(name.startswith("parts-") for name in os.listdir(f"typed/{study}"))
    assert pieces == (study in ("paper", "league")), study
    missing = [file for where, file in taken if where == study and not os.path.exists(f"typed/{study}/{file}")]
    assert pieces or not missing, (command, missing)
PYTHON
finish
