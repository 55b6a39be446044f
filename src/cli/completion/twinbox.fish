# SPDX-License-Identifier: GPL-3.0-or-later
# fish completion for twinbox. The program answers what a word may become (src/cli/command_completion.c).

function __twinbox_complete
    set -l words (commandline -opc)
    set -l typed (commandline -ct)
    set -l program (string replace -r '^~' $HOME -- $words[1])
    for line in ($program completion words -- $words[2..-1] "$typed" 2>/dev/null)
        set -l parts (string split -m 1 \t -- $line)
        if string match -q -- '<files>*' $line
            set -l begin (string replace -- '<files>' '' $parts[1])
            set -l endings (string split -n ' ' -- $parts[2])
            set -l start (string sub -s (math (string length -- "$begin") + 1) -- "$typed")
            for path in (__fish_complete_path $start)
                set -l name (string split -m 1 \t -- $path)[1]
                if test -z "$endings"; or string match -q -- '*/' $name
                    printf '%s%s\n' $begin $name
                else if contains -- (string split -r -m 1 . -- $name)[-1] $endings
                    printf '%s%s\n' $begin $name
                end
            end
        else if string match -q -- '<folders>*' $line
            set -l begin (string replace -- '<folders>' '' $parts[1])
            set -l start (string sub -s (math (string length -- "$begin") + 1) -- "$typed")
            for path in (__fish_complete_directories $start)
                printf '%s%s\n' $begin (string split -m 1 \t -- $path)[1]
            end
        else if not string match -q -- '<group>*' $line
            printf '%s\n' $line
        end
    end
end

complete -c twinbox -f -k -a '(__twinbox_complete)'
