#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# twinbox new: scenes to start from, in any folder; tests/studies/test_templates.c tests that they stand.
. "$(dirname "$0")/checks.sh"

for file in "$scenes"/templates/*.yaml; do
    kind=$(basename "$file" .yaml)
    run 0 new "my $kind.yaml" --like $kind
    says "$kind -> my $kind.yaml"
    says "next: twinbox check 'my $kind.yaml'"
    cmp -s "my $kind.yaml" "$file" || fail "my $kind.yaml is not the file in scenes/templates"
    [ "$(grep -c '^ *#' "my $kind.yaml")" -ge 12 ] || fail "$kind has few comments"
    run 0 check "my $kind.yaml" -o first.png
    says "    launches: x from "
    [ "$(grep -c '^    parameter ' out)" -ge 1 ] && [ "$(grep -c '^    parameter ' out)" -le 2 ] || fail "$kind: parameters"
    run 0 simulate "my $kind.yaml" -o run.npz
done

# Nothing that exists is overwritten: a file, a link, a link to nothing.
echo mine >mine.yaml
ln -s mine.yaml link.yaml
ln -s nothing.yaml nowhere.yaml
for name in mine link nowhere; do run 2 new $name.yaml --like wall; done
equal "mine.yaml" "$(cat mine.yaml)" mine
[ ! -e nothing.yaml ] || fail "a link was followed"
equal "temporary files" "$(ls -A | grep -c tmp)" 0

run 0 new - --like arch
cmp -s out "$scenes/templates/arch.yaml" || fail "standard output is not the file in scenes/templates"
finish
