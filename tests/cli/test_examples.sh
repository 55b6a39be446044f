#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The examples in the help of each command can be pasted one after another, in a folder with the scenes. Those that take long are
# stopped once they are at work, so that all their options and files are right.
. "$(dirname "$0")/checks.sh"

# paste LINE: runs it, as a shell would. Sets status; 130 if it was at work for a second, and was stopped.
paste() {
    local words running
    eval "words=(${1#twinbox })" # quoted as for a shell
    rm -f "$folder/errors"
    nice "$twinbox" "${words[@]}" >"$folder/said" 2>"$folder/errors" </dev/null &
    running=$!
    until ! kill -0 $running 2>/dev/null || { long "$1" && grep -qs '%' "$folder/errors"; }; do sleep 0.02; done
    ! long "$1" || kill -TERM $running 2>/dev/null
    wait $running
    status=$?
}

long() {
    [[ $1 =~ ^twinbox\ (paper|dataset|stability|train|chart|render) ]] || return
    ! [[ $1 =~ ^twinbox\ chart.*--quick|--bomb-x|--frames ]]
}

# What a pasted line ends with.
expected() {
    case $1 in
    "twinbox compare"*) echo 1 ;; # the examples differ
    *) if long "$1"; then echo "0 130"; else echo 0; fi ;;
    esac
}

for name in $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'); do
    mkdir "$name"
    cd "$name" || exit 1
    ln -s "$scenes" scenes
    ARGP_HELP_FMT=rmargin=400 "$twinbox" "$name" --help | sed -n '/^Example: /,/^[^ ]/ s/^\(Example:\|        \) \(twinbox .*\)/\2/p' >examples
    "$twinbox" "$name" --help | sed -n '/^Example: /,/^[^ ]/ s/^\(Example:\|        \) \(twinbox .*\)/\2/p' >narrow
    cmp -s examples narrow || fail "the help of $name breaks examples at 80 columns, so that they cannot be pasted: $(comm -3 examples narrow)"
    [ -s examples ] || fail "the help of $name has no example"
    grep -q "^twinbox $name\b\|^twinbox simulate" examples || fail "the examples of $name are of other commands: $(<examples)"
    while read -r line; do
        checks=$((checks + 1))
        paste "$line"
        grep -q "this build has no module for live pages" "$folder/errors" && continue
        [[ " $(expected "$line") " == *" $status "* ]] || fail "$name: $line: exit status $status: $(head -c 300 "$folder/errors")"
    done <examples
    cd ..
    rm -r "${folder:?}/$name"
done
[ $checks -ge 40 ] || fail "only $checks examples"
finish
