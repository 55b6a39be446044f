# SPDX-License-Identifier: GPL-3.0-or-later
# Takes sections of a Markdown page for a manual page: variable `sections` has their headings, separated by "|". What stands
# before the first heading is taken if `intro` is 1, without the title. Links become their text, pictures go.
BEGIN {
    count = split(sections, names, "|")
    for (i = 1; i <= count; i++) wanted[names[i]] = 1
    taken = intro
}
/^ *```/ { fenced = !fenced }
!fenced && /^# / { next }
!fenced && /^###? / && ($0 ~ /^## / || !taken || taken == "###" || substr($0, 5) in wanted) {
    name = $0
    sub(/^#+ /, "", name)
    taken = name in wanted ? $1 : 0
    # Without an introduction, the first section is the description.
    if (taken && (found++ || intro)) print "# " toupper(name)
    next
}
!taken { next }
fenced || /^ *```/ { print; next }
/^### / { print substr($0, 2); next }
/^!\[/ { next }
{
    while (match($0, /\[[^][]*\]\([^()]*\)/)) {
        link = substr($0, RSTART, RLENGTH)
        split(link, parts, /\]\(/)
        text = substr(parts[1], 2)
        target = substr(parts[2], 1, length(parts[2]) - 1)
        if (target ~ /^http/) text = text " (" target ")"
        $0 = substr($0, 1, RSTART - 1) text substr($0, RSTART + RLENGTH)
    }
    print
}
END { if (found != count) { print "page.awk: not all of these sections are there: " sections >"/dev/stderr"; exit 1 } }
