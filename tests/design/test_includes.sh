#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every #include in src/ keeps to the direction of dependencies in src/layers.txt, and no room includes another one's internal
# headers.
set -u
source_dir=$2

declare -A neighbours
while IFS=: read -r room names; do neighbours[$room]=$names; done < <(grep '^[a-z]' "$source_dir/src/layers.txt")

# All rooms that $1 may include from.
reach() {
    local room
    echo "$1" base
    for room in ${neighbours[$1]}; do reach "$room"; done
}

status=0
for path in "$source_dir"/src/*; do
    room=$(basename "$path")
    [ -d "$path" ] || [ "$room" = main.c ] || continue
    if [ -z "${neighbours[$room]+known}" ]; then
        echo "src/$room is missing in src/layers.txt"
        status=1
        continue
    fi
    allowed=" $(reach "$room" | tr '\n' ' ') "
    while IFS=: read -r file line include; do
        target=$(sed -E 's/.*"([^"]*)".*/\1/' <<<"$include")
        # A header without a folder lies beside the file or is made by the build.
        [[ $target == */* ]] || continue
        if [[ $allowed != *" ${target%%/*} "* ]]; then
            echo "${file#"$source_dir"/}:$line: may not include $target"
            status=1
        fi
        if [[ $target == */internal.h || $target == *_internal.h ]] && [ "${target%%/*}" != "$room" ]; then
            echo "${file#"$source_dir"/}:$line: $target is for its own room"
            status=1
        fi
    done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$path" --include='*.[ch]' /dev/null)
done
exit $status
