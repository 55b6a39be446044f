#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Help of the program and of every command it lists; usage errors.
. "$(dirname "$0")/checks.sh"

run 0 --help
[ "$(wc -l <out)" -le 30 ] || fail "--help does not fit a screen of 30 lines"
[ "$(awk '{ if (length > n) n = length } END { print n }' out)" -le 80 ] || fail "--help is wider than 80 columns"
names=$(awk '/^  [a-z]/ { print $1 }' out)
# Groups of commands: those of the table in README.md, with the same commands in the same order.
sed -n 's/:$//; /^[A-Z][a-z ]*$/p; s/^  \([a-z]*\)  .*/\1/p' out >groups
sed -n '/^## Commands/,/^## /s/^| \(\*\*\(.*\)\*\* \)\?| \[\?`twinbox \([a-z]*\).*/\2\n\3/p' "$sources/README.md" | sed '/^$/d' >groups_of_readme
diff groups groups_of_readme >difference || fail "README.md has other groups of commands: $(<difference)"
equal "groups" "$(grep -c '^[A-Z]' groups)" 6
equal "commands" "$(wc -w <<<"$names")" "$(ls "$sources"/src/cli/*.c | xargs grep -h "^bool command_" | wc -l)"

for name in $names; do
    run 0 "$name" --help
    says "Usage: twinbox $name"
    says "Example: twinbox "
    run 2 "$name" --no-such-option
    complains "--no-such-option"
done
run 0 dataset --help
for word in relative raw-unturned contact neighbours pair net impulse points; do says "$word"; done
for name in $names; do
    [ $name = methods ] && continue
    run 2 "$name"
    complains "needed"
done

# Help that nobody can read is no success.
for words in --help --version "help compare" "compare --help" "compare --usage" methods; do
    checks=$((checks + 1))
    "$twinbox" $words >/dev/full 2>err
    equal "status of $words into a full file" $? 3
    complains "standard output: error: cannot write"
    "$twinbox" $words >&- 2>err
    equal "status of $words without standard output" $? 3
    complains "standard output: error: cannot write"
done
"$twinbox" simulate "$scenes/single.yaml" --frames 2 -o closed.npz >&- 2>err
equal "status of a run without standard output" $? 3
run 0 compare closed.npz closed.npz

run 2
complains "Usage: twinbox COMMAND"
for version in --version -V "simulate --version" "chart -V"; do
    run 0 $version
    says "twinbox "
    equal "lines of $version" "$(wc -l <out)" 1
done
for verbose in "--version -v" "-V --verbose"; do
    run 0 $verbose
    equal "lines of $verbose" "$(wc -l <out)" 3
    for kind in osmesa egl; do says "$kind: "; done
    equal "contexts by default" "$(grep -c '^[a-z]*: OpenGL .* Mesa .*, llvmpipe .*; used by default$' out)" 1
done
for general in help --help -h "help --help"; do
    run 0 $general
    says "Usage: twinbox COMMAND"
done
run 0 help simulate
cp out by_help
run 0 simulate --help
cmp -s by_help out || fail "help simulate differs from simulate --help"

run 0 methods
says "engine"
says "pair-net"
says "contact-net"
says "k:"
says "network:"
says "Without its learned part: scene-net:net=off, with the same settings otherwise."
finish
