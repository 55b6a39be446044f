#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A shard on a disk that is full, of a size that is mounted for this test: it fails with the reason, keeps what it has, and
# continues once there is space. Needs the rights of root.
. "$(dirname "$0")/../cli/checks.sh"
if [ "${3-}" != mounted ]; then
    [ "$(id -u)" -eq 0 ] && unshare --mount true 2>/dev/null || { echo "skipped: a disk cannot be mounted here"; exit 77; }
    unshare --mount bash "$sources/tests/cluster/test_full_disk.sh" "$1" "$2" mounted
    exit
fi
study="stability $scenes/stability/heavy_on_one.yaml --vary ratio --vary iterations --methods engine"
run 0 $study -o whole
mkdir disk
mount -t tmpfs -o size=4k none disk || fail "no disk"

# Sizes at which nothing, the folder, the record and some of the pieces fit. A file takes 4 KiB.
for size in 4k 8k 40k 120k; do
    mount -o remount,size=$size disk
    run 3 $study -o disk/map --shard 1/2
    complains "No space left on device"
    equal "hidden files on a disk of $size" "$(find disk -name '.*')" ""
    [ -e disk/map/shards/run.json ] && run 1 merge disk/map
done
before=$(cd disk/map/shards && find . -type f | sort | xargs md5sum)
[ "$(wc -l <<<"$before")" -gt 2 ] || fail "no piece fitted"
mount -o remount,size=4m disk
run 0 $study -o disk/map --shard 1/2
says "$(($(wc -l <<<"$before") - 1)) of them done before"
equal "pieces from before" "$(cd disk/map/shards && md5sum --check --quiet <<<"$before" 2>&1)" ""
run 0 $study -o disk/map --shard 2/2

# A merge writes nothing half, either.
used=$(du -sk disk | cut -f1)
mount -o remount,size=$((used + 60))k disk
run 3 merge disk/map
complains "No space left on device"
written=$(ls -p disk/map | grep -v /)
[ -n "$written" ] || fail "no file fitted"
for name in $written; do cmp -s "disk/map/$name" "whole/$name" || fail "another $name on a full disk"; done
mount -o remount,size=8m disk
run 0 merge disk/map
rm -r disk/map/shards
diff -r disk/map whole >out || fail "the files differ: $(cat out)"
umount disk
finish
