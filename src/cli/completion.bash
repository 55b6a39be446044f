# SPDX-License-Identifier: GPL-3.0-or-later
# bash completion for twinbox: its commands and their options, as their help lists them.
# shellcheck shell=bash
_twinbox() {
    local words=""
    if ((COMP_CWORD == 1)) || [[ ${COMP_WORDS[1]} == help ]]; then
        words="help $("$1" --help | sed -n 's/^  \([a-z]*\)  .*/\1/p')"
    elif [[ $2 == -* ]]; then
        words=$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null | sed -n 's/^ \{1,6\}\(-[^ ], \|    \)\(--[a-z-]*\).*/\2/p')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$2")
}
complete -o default -F _twinbox twinbox
