#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Which folder of src/ may include from which: the direction of the dependencies. A folder may also include from what
# its neighbours may, and from common.
set -u
source_dir=$2

declare -A neighbours=(
    [common]="" [collision]="" [network]="" [image]="" [trajectory]=""
    [dynamics]="collision" [solvers]="dynamics network" [scene]="dynamics"
    [simulate]="scene solvers trajectory" [dataset]="simulate" [training]="dataset network"
    [render]="trajectory image" [study]="training simulate" [figure]="study render"
    [report]="study figure image trajectory"
    [cli]="common collision network image trajectory dynamics solvers scene simulate dataset training study render figure report"
    [main.c]="cli"
)

# All folders that $1 may include from.
reach() {
    local folder
    echo "$1" common
    for folder in ${neighbours[$1]}; do reach "$folder"; done
}

status=0
for path in "$source_dir"/src/*; do
    folder=$(basename "$path")
    if [ -z "${neighbours[$folder]+known}" ]; then
        echo "src/$folder has no place in the table"
        status=1
        continue
    fi
    allowed=" $(reach "$folder" | tr '\n' ' ') "
    while IFS=: read -r file line include; do
        target=$(sed -E 's/.*"([^"]*)".*/\1/' <<<"$include")
        # A header without a folder lies beside the file or is made by the build.
        [[ $target == */* ]] || continue
        if [[ $allowed != *" ${target%%/*} "* ]]; then
            echo "${file#"$source_dir"/}:$line: may not include $target"
            status=1
        fi
    done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$path" --include='*.[ch]' /dev/null)
done
exit $status
