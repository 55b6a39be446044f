#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# figure --caption-text: the same bytes anywhere.
. "$(dirname "$0")/checks.sh"
run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --method momentum:k=20 -o momentum.npz
mkdir other
cp ./*.npz other
for place in . other; do
    cd $place || exit 1
    run 0 figure strip engine.npz momentum.npz --at 0.2,0.5 -o strip.svg --caption-text strip.tex
    says "caption -> strip.tex"
    cd "$folder" || exit 1
done
checks=$((checks + 1))
cmp strip.tex other/strip.tex || fail "another place, another caption"
equal "the caption" "$(cat strip.tex)" "\\caption{The scene \\texttt{stack} at 0.2 and 0.5~s, a column each. \
Rows from top to bottom: \\texttt{engine} (physics engine, sequential impulses, \\texttt{k=10}) and \\texttt{momentum:k=20} (sequential \
impulses with momentum). Drawn with twinbox~$("$twinbox" --version | sed 's/.* //').}"

# With a band.
run 0 figure divergence engine.npz momentum.npz --scene "$scenes/stack.yaml" -o band.svg --caption-text band.tex
grep -qF 'each with one of 5 bodies shifted by 1~$\mu$m. ' band.tex || fail "$(cat band.tex)"

# No name, however odd, ends the caption or becomes a command: all braces pair.
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('engine.npz', allow_pickle=False))
run['scene'], run['method'] = numpy.array('}\\\\input{x}%~^#\$&_'), numpy.array('a}b{c%')
numpy.savez('odd.npz', **run)"
run 0 figure strip odd.npz -o odd.svg --caption-text odd.tex
equal "lines" "$(wc -l <odd.tex)" 1
equal "a name of special characters" "$(sed 's/ at .*//' odd.tex)" \
    '\caption{The scene \texttt{\}\textbackslash{}input\{x\}\%\textasciitilde{}\textasciicircum{}\#\$\&\_}'

# Runs of different launches in one figure are noted.
run 0 simulate "$scenes/stack.yaml" --frames 60 --bomb-x 1 -o launched.npz
run 0 figure strip engine.npz momentum.npz -o same.svg
grep -q note err && fail "$(cat err)"
run 0 figure strip engine.npz launched.npz -o launched.svg
complains "twinbox: note: the runs of stack by engine and by engine are of different scenes"

run 3 figure strip engine.npz -o x.svg --caption-text /proc/nowhere/x.tex
complains "/proc/nowhere/x.tex"
finish
