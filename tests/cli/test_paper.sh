#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The paper's study: tables, figures and report of a quick one, one that is cut off, and one in shards.
. "$(dirname "$0")/checks.sh"

tables="closed_loop constants laws networks rates study system_scores table1 transfer"
# Times differ from run to run.
figures() {
    for table in $tables; do
        case $table in
        closed_loop) cut -d, -f1-8 "$1/$table.csv" ;;
        system_scores) sed 's/,[^,]*,[^,]*$//' "$1/$table.csv" ;;
        *) cat "$1/$table.csv" ;;
        esac
    done
}

# A study that is interrupted keeps what it has done. A sanitizer would take minutes for a study: it sees one begin and be
# interrupted, and every part of a study in tests/paper.
part=7
! brief || part=0
strike INT 130 "ls quick/parts-*/0000/000000$part" paper -o quick --quick --scenes "$scenes"
complains "stopped"
! brief || finish
[ -e quick/report.md ] && fail "an interrupted study has a report"

# It continues from the parts that are done; also when it could not be drawn. A network that is not the one that was trained
# is trained again.
equal "what was done first" "$(sed -n 's/^name //p' quick/parts-*/0000/0000000)" network-baseline-1
before=$(stat -c %i quick/networks/baseline-1.npz)
cp quick/networks/baseline-1.npz quick/networks/inputs-raw-1.npz
run_undrawn quick/figures/laws.png paper -o quick --quick --scenes "$scenes"
run 0 paper -o quick --quick --scenes "$scenes"
equal "a network that was trained" "$(stat -c %i quick/networks/baseline-1.npz)" "$before"
says "quick/report.md"
for name in loop narrow-phase data scenes loss factors rates closed-loop laws transfer; do
    [ -s quick/figures/$name.png ] && [ -s quick/figures/$name.svg ] || fail "no figure $name"
done
# Figures have the same bytes on Debian 12 and 13.
hashes=$sources/golden/paper_figures.sha256
equal "figures with other bytes" "$(cd quick/figures && sha256sum --quiet --strict --check "$hashes" 2>&1)" ""
equal "files hashed" "$(wc -l <"$hashes")" 8
[ -s quick/networks/baseline-1.npz ] || fail "no network"
equal "what was done in parts is gone" "$(ls -d quick/parts-* 2>/dev/null | wc -l)" 0
/usr/bin/python3 - <<'PYTHON' || fail "tables or report are not in order"
import csv, re
rows = {name: list(csv.DictReader(open(f"quick/{name}.csv"))) for name in
        "closed_loop constants laws networks rates system_scores table1 transfer".split()}
for row in rows["rates"]:
    for column in "rate constant engine1 engine4 engine10".split():
        assert row[column] == "" or 0 <= float(row[column]) <= 1, row
    # The engine as it is agrees with itself, whatever is counted but bodies.
    assert row["definition"] == "bodies" or float(row["engine10"]) == 1, row
for row in rows["closed_loop"]:
    assert row["frames_until_apart"] == "" or 1 <= float(row["frames_until_apart"]) <= 600, row
    assert float(row["energy_ratio"]) > 0 and (row["unconverged"] == "1") == (row["frames_until_apart"] == ""), row
    # Equal and opposite impulses make no momentum.
    if row["network"] in ("baseline", "contact-net"): assert float(row["momentum_error"]) == 0, row
    # Networks of other splits have the same cost.
    assert (row["us_step"] == row["us_step_engine"] == "") == (row["seed"] == "2"), row
for row in rows["system_scores"]:
    assert 1 <= float(row["frames_engine"]) <= float(row["frames"]) and float(row["us_step"]) > 0, row
    # The engine never parts from itself, and makes no momentum.
    if row["method"] == "engine":
        assert row["frames_engine"] == row["frames"] and float(row["momentum_error"]) == 0, row
# Every system and rival is scored in every scene.
scored = {}
for row in rows["system_scores"]: scored.setdefault(row["scene"], []).append((row["system"], row["method"]))
assert len(scored) == 4 and all(methods == scored["single"] for methods in scored.values()), scored
for row in rows["networks"]:
    # Trained from somewhere: the weights kept are no worse on their rows than the first. The last ones of the training are in table1.
    of = [r for r in rows["table1"] if (r["network"], r["seed"]) == (row["network"], row["seed"])]
    assert not of or of[0]["iteration"] == "0" and float(row["train_range2"]) < float(of[0]["train_range2"]), row
    assert not of or abs(float(of[0]["constant_range2"]) / float(row["constant_range2"]) - 1) < 1e-4, row
    assert abs(float(row["ratio"]) - float(row["test_range2"]) / float(row["constant_range2"])) < 1e-5 * float(row["ratio"]), row
assert {row["seed"] for row in rows["transfer"]} == {row["seed"] for row in rows["networks"]} == {"1", "2"}
report = open("quick/report.md").read()
assert report.count("](figures/") == 10 and all(f"[{name}.csv]({name}.csv): {len(rows[name])} rows" in report for name in rows), report
PYTHON

# Two shards make the same tables and networks as the study that was interrupted. What takes times, and what rates networks of
# the other shard, is left to the command without them, and so is a network that is lost.
for i in 1 2; do run 0 paper -o shards --quick --scenes "$scenes" --shard $i/2; done
equal "files of shards" "$(cd shards && echo *)" "$(cd shards && echo networks parts-*)"
says "left to the command without --shard"
rm shards/networks/baseline-1.npz
run 0 paper -o shards --quick --scenes "$scenes"
says "report -> shards/report.md"
figures quick >figures.csv
figures shards | cmp - figures.csv || fail "other tables by shards"
diff -r quick/networks shards/networks || fail "other networks by shards"
equal "files" "$(cd shards && find . -type f | sort)" "$(cd quick && find . -type f | sort)"
equal "figures of shards with other bytes" "$(cd shards/figures && sha256sum --quiet --strict --check "$hashes" 2>&1)" ""
finish
