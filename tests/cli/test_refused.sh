#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Options and inputs that are refused: the tables of refused/. A row is
#     [3] COMMAND ARGUMENT... | WORDS [& WORDS]... [| VALUE...]
# and stands for one command, or for one with each VALUE in the place of @. Such a command ends with exit status 2 (3: the
# system refuses), says on standard error the place and the reason, which are the WORDS, prints nothing else, no control character and no long text (train has
# begun its table, compare counts what it cannot compare), and leaves every file as it was. Words that change when the message is put better are not in the tables.
. "$(dirname "$0")/checks.sh"
tables=$sources/tests/cli/refused

mkdir inputs && cd inputs || exit 1
run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --method momentum:k=20 -o momentum.npz
run 0 simulate "$scenes/single.yaml" --frames 3 -o single.npz
run 0 simulate "$scenes/stack.yaml" --frames 20 --dt 1/120 -o slow.npz
run 0 solve "$scenes/stack.yaml" --frame 41 -o impact.npz
run 0 export engine.npz -o poses.csv
cut -d, -f1-5 poses.csv >light.csv
run 0 import light.csv -o light.npz
run 0 simulate "$scenes/stack.yaml" --frames 2 -o rows.csv
run 0 dataset "$scenes/single.yaml" -o pairs.npz --bomb-x=-2:2:1
run 0 dataset "$scenes/single.yaml" -o context.npz --bomb-x=-2:2:1 --context
run 0 train pairs.npz -o net.npz --iterations 1
run 0 chart "$scenes/single.yaml" --quick --methods engine:k=10 --launches 1 -o charted
printf '[{"pixels": 1}]' >results.json
. "$tables/inputs.sh"
rm -f out err

# Names of all folders; names, sizes and times of all files.
files() { find . \( -type d -printf '%p\n' \) -o -printf '%p %s %T@ %l\n'; }

# refused STATUS COMMAND WORDS: one row, without values.
refused() {
    local words word status printed errors
    eval "words=($2)"
    "$twinbox" "${words[@]}" >../out 2>../err </dev/null
    status=$?
    local LC_ALL=C # bytes
    printed=$(<../out) errors=$(<../err)
    equal "exit status of $2: ${errors:0:300}" $status "$1"
    [[ -z $printed || ${words[0]} = train || $printed = *'not comparable'* ]] || fail "$2 prints: ${printed:0:300}"
    [[ $errors =~ ': error: '|^twinbox\ [a-z]+': ' ]] || fail "the errors of $2 have no place: ${errors:0:300}"
    while read -r word; do
        checks=$((checks + 1))
        [[ $errors = *"$word"* ]] || fail "twinbox $2: no '$word' in: ${errors:0:400}"
    done <<<"${3// & /$'\n'}"
    [[ $printed$errors =~ [$'\x01'-$'\x09\x0b'-$'\x1f\x7f']|$'\xc2'[$'\x80'-$'\x9f']|(^|$'\n'):: ]] &&
        fail "a control character or command in what $2 prints: $(cat -v ../out ../err | head -c 300)"
    [ ${#errors} -lt 1500 ] || fail "$2: ${#errors} bytes of errors"
    files >../after
    cmp -s ../before ../after || fail "twinbox $2 changes files: $(diff ../before ../after | head -5)"
    mv ../after ../before
}

sample=$(brief && echo yes)
files >../before
all=("$tables"/*.txt)
set -f
for table in "${all[@]}"; do
    rows=$checks
    while IFS='|' read -r command text values; do
        case $command in '' | '#'*) continue ;; esac
        status=2
        [[ $command != "3 "* ]] || { status=3 && command=${command#3 }; }
        text=${text# } text=${text% } command=${command%"${command##*[! ]}"}
        eval "text=\"$text\"" # lines of an input
        if [ -z "$values" ]; then
            refused $status "$command" "$text"
        else
            eval "values=($values)"
            [ ! "$sample" ] || values=("${values[0]}")
            for value in "${values[@]}"; do refused $status "${command//@/$value}" "${text//@/$value}"; done
            unset values
        fi
    done <"$table"
    [ $checks -gt $rows ] || fail "$(basename "$table") has no rows"
done
set +f
finish
