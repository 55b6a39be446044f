# SPDX-License-Identifier: GPL-3.0-or-later
# bash completion for twinbox. The program answers what a word may become (src/cli/command_completion.c).
# shellcheck shell=bash

# Adds the files and folders that begin with $2 and, if endings follow, have one of them, behind $1.
_twinbox_files() {
    local begin=$1 typed=$2 path ending
    shift 2
    while IFS= read -r path; do
        if [[ -d $path ]]; then
            COMPREPLY+=("$begin$path")
            continue
        fi
        [[ $# -eq 0 ]] && COMPREPLY+=("$begin$path")
        for ending; do
            [[ $path == *."$ending" ]] && COMPREPLY+=("$begin$path")
        done
    done < <(compgen -f -- "$typed")
    compopt -o filenames 2>/dev/null
}

_twinbox() {
    # Bash splits words at = and :, which are part of twinbox's words: what no blank separates is one word.
    local words=() word rest=${COMP_LINE:0:COMP_POINT} i
    for ((i = 0; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if ((i == 0)) || [[ $rest == [[:blank:]]* ]]; then
            rest=${rest#"${rest%%[![:blank:]]*}"}
            words+=("")
        fi
        [[ $rest == "$word"* ]] || word=$rest
        words[${#words[@]}-1]+=$word
        rest=${rest#"$word"}
    done
    local typed=${words[${#words[@]}-1]} line begin had=""
    # Up to here, bash keeps what was typed.
    [[ $COMP_WORDBREAKS == *:* && $typed == *:* ]] && had=${typed%"${typed##*:}"}
    [[ $COMP_WORDBREAKS == *=* && ${typed#"$had"} == *=* ]] && had=${typed%"${typed##*=}"}
    COMPREPLY=()
    while IFS= read -r line; do
        case $line in
        "<files>"*)
            begin=${line#"<files>"}
            begin=${begin%%$'\t'*}
            # shellcheck disable=SC2086 # several endings
            _twinbox_files "${begin#"$had"}" "${typed#"$begin"}" ${line#*$'\t'}
            ;;
        "<folders>"*)
            begin=${line#"<folders>"}
            while IFS= read -r word; do COMPREPLY+=("${begin#"$had"}$word"); done < <(compgen -d -- "${typed#"$begin"}")
            compopt -o filenames 2>/dev/null
            ;;
        "<group>"*) compopt -o nosort 2>/dev/null ;;
        *)
            word=${line%%$'\t'*}
            [[ $word == *[=:] ]] && compopt -o nospace 2>/dev/null
            COMPREPLY+=("${word#"$had"}")
            ;;
        esac
    done < <("${COMP_WORDS[0]/#\~/$HOME}" completion words -- "${words[@]:1}" 2>/dev/null)
}
complete -F _twinbox twinbox
