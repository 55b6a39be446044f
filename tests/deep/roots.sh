# SPDX-License-Identifier: GPL-3.0-or-later
# Bare roots of Debian by debootstrap, and commands in them. Sourced by the deep checks with $sources set. Roots and
# downloaded packages are kept in $TWINBOX_ROOTS (default: build/roots) for the next time.
roots=${TWINBOX_ROOTS:-$sources/build/roots}
mkdir -p "$roots"
work=$(mktemp -d "$roots/work.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT

# Exit status 77: not checked, for this reason.
skip() {
    echo "skipped: $*"
    exit 77
}

fail() {
    echo "FAILED: $*"
    exit 1
}

need_roots() {
    [ "$(id -u)" -eq 0 ] || skip "roots of Debian need the rights of root"
    command -v debootstrap >/dev/null || skip "debootstrap is not installed"
    unshare --mount --pid --fork true 2>/dev/null || skip "there are no mount namespaces here"
}

# keep_root NAME ARGUMENT...: makes the root NAME, once. Half a root is no root.
keep_root() {
    local root=$roots/$1
    shift
    [ ! -e "$root" ] || return 0
    rm -rf "$root.new"
    echo "debootstrap $*"
    debootstrap --variant=minbase "$@" "$root.new" >"$root.log" 2>&1 || fail "debootstrap: $(tail -3 "$root.log")"
    mv "$root.new" "$root"
}

# inside ROOT COMMAND...: mounts end with the command.
inside() {
    local root=$1 packages=$roots/packages
    shift
    mkdir -p "$packages"
    unshare --mount --pid --fork --kill-child bash -ec '
        root=$1 packages=$2
        shift 2
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        mount --bind "$packages" "$root/var/cache/apt/archives"
        [ ! -e /etc/resolv.conf ] || cp /etc/resolv.conf "$root/etc/resolv.conf"
        exec chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/root \
            DEBIAN_FRONTEND=noninteractive SOURCE_DATE_EPOCH="${SOURCE_DATE_EPOCH-}" "$@"' \
        inside "$root" "$packages" "$@"
}

# as_user ROOT COMMAND...: in the home of a user without rights.
as_user() {
    local root=$1
    shift
    inside "$root" setpriv --reuid=1000 --regid=1000 --clear-groups env HOME=/home/user sh -c 'cd && exec "$@"' user "$@"
}

# copy_sources FOLDER: what git has or would add.
copy_sources() {
    mkdir -p "$1"
    (cd "$sources" && git ls-files -z --cached --others --exclude-standard --deduplicate |
        xargs -0 sh -c 'for file; do [ ! -e "$file" ] || printf "%s\0" "$file"; done' all |
        tar -c --null -T - -f -) | tar -x -C "$1"
}
