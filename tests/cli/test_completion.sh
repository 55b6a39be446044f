#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Completion in bash, zsh and fish as installed: what each makes of the same keys. Everything comes from the option tables.
. "$(dirname "$0")/checks.sh"
tests=$sources/tests/cli

cmake --install "$(dirname "$twinbox")" --prefix "$folder/prefix" >installed || fail "cmake --install"
twinbox=$folder/prefix/bin/twinbox
export PATH=$folder/prefix/bin:$PATH
bash_script=$folder/prefix/share/bash-completion/completions/twinbox
zsh_script=$(echo "$folder"/prefix/share/zsh/*/_twinbox)
fish_script=$folder/prefix/share/fish/vendor_completions.d/twinbox.fish
for shell in bash zsh fish; do
    run 0 completion $shell
    script=${shell}_script
    cmp -s out "${!script}" || fail "the installed script of $shell is another than that of twinbox completion"
    command -v $shell >/dev/null && { $shell -n "${!script}" || fail "$shell does not understand its script"; }
done
run 0 help completion
says "Usage: twinbox completion"

# Every option that a command's help lists is offered, and nothing else.
for name in $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'); do
    ARGP_HELP_FMT=rmargin=4000 "$twinbox" "$name" --help | sed -n '/^Example/q; s/^ \{1,6\}\(-[^ ], \|    \)\(--[a-z-]*\).*/\2/p' |
        grep -vx -e --usage | sort -u >listed
    "$twinbox" completion words -- "$name" -- 2>&1 | cut -f1 | grep -vx -e --version | sort -u >offered
    equal "options of $name" "$(<offered)" "$(<listed)"
    checks=$((checks + $(wc -l <listed)))
done
# So is every method, and every setting of each.
"$twinbox" methods | sed -n 's/^\([a-z][a-z-]*\)  .*/\1/p' | sort >listed
"$twinbox" completion words -- simulate --method "" | cut -f1 | sort >offered
equal "methods" "$(<offered)" "$(<listed)"
while read -r method; do
    "$twinbox" methods | awk -v method="$method" '/^[a-z]/ { found = $1 == method } found && /^    [a-z]+:/ { sub(":", "", $1); print $1 }' >settings
    while read -r setting; do
        equal "setting $setting of $method" "$("$twinbox" completion words -- solve p.npz -m "$method:$setting" | cut -f1 |
            grep -cx "$method:$setting=")" 1
    done <settings
done <listed

# What is no command line has no completion, but no error either.
for words in "" "nothing " "simulate --no-such-option=" "simulate a.yaml b" "help simulate x" "methods x" "train --kind=x"; do
    IFS=' ' read -ra split <<<"$words"
    run 0 completion words -- "${split[@]}" ""
    equal "errors of completing '$words'" "$(<err)" ""
done
run 0 completion words -- simulate --method="$(head -c 5000 /dev/zero | tr '\0' x)"
run 0 completion words -- completion ""

mkdir work && cd work || exit 1
mkdir drawn
touch engine.npz "two words.npz" notes.txt our_wall.yaml figure.svg
cp "$scenes/stability/stack_height.yaml" height.yaml

# A line for each: the keys, then the command line that they make. All shells.
cat >alike <<'END'
twinbox simu<TAB>|twinbox simulate 
twinbox help stab<TAB>|twinbox help stability 
twinbox simulate --meth<TAB>|twinbox simulate --method 
twinbox simulate --verb<TAB>|twinbox simulate --verbose 
twinbox simulate --method mom<TAB>|twinbox simulate --method momentum 
twinbox simulate -m pair-net:netw<TAB>|twinbox simulate -m pair-net:network=
twinbox simulate -m pair-net:network=eng<TAB>|twinbox simulate -m pair-net:network=engine.npz 
twinbox simulate --method=engine:acc<TAB>|twinbox simulate --method=engine:accumulate=
twinbox solve p.npz -m engine:warm=on,acc<TAB>|twinbox solve p.npz -m engine:warm=on,accumulate=
twinbox chart --methods engine:k=5,soft-<TAB>|twinbox chart --methods engine:k=5,soft-step 
twinbox render --theme d<TAB>|twinbox render --theme dark 
twinbox render --camera=div<TAB>|twinbox render --camera=divergence 
twinbox render --show ghosts,tr<TAB>|twinbox render --show ghosts,trails 
twinbox render --context os<TAB>|twinbox render --context osmesa 
twinbox render two<TAB>|twinbox render two\ words.npz 
twinbox render -o d<TAB>|twinbox render -o drawn/
twinbox simulate our<TAB>|twinbox simulate our_wall.yaml 
twinbox simulate scenes/pyramid_s<TAB>|twinbox simulate scenes/pyramid_settled.yaml 
twinbox simulate pyramid_se<TAB>|twinbox simulate pyramid_settled 
twinbox simulate height.yaml --set hei<TAB>|twinbox simulate height.yaml --set height=
twinbox simulate stack_height --set hei<TAB>|twinbox simulate stack_height --set height=
twinbox figure ann<TAB>|twinbox figure annotated 
twinbox figure strip engine.npz -o fig<TAB>|twinbox figure strip engine.npz -o figure.svg 
twinbox train --kind sce<TAB>|twinbox train --kind scene-net 
twinbox dataset --inputs nei<TAB>|twinbox dataset --inputs neighbours 
twinbox stability --study time_s<TAB>|twinbox stability --study time_step 
twinbox stability height.yaml --vary hei<TAB>|twinbox stability height.yaml --vary height 
~/../prefix/bin/twinbox completion fi<TAB>|~/../prefix/bin/twinbox completion fish 
END
cut -d'|' -f1 alike >keys
cut -d'|' -f2 alike >lines

# in_terminal SHELL COMMAND: types the keys and compares.
in_terminal() {
    if ! command -v "$1" >/dev/null; then
        echo "$1 is not installed: not tested"
        return
    fi
    /usr/bin/python3 "$tests/terminal.py" "$1" "$2" <keys >typed || fail "the terminal of $1"
    diff lines typed >difference || fail "$1 completes otherwise: $(<difference)"
    checks=$((checks + $(wc -l <lines)))
}
in_terminal bash "source '$bash_script'"
in_terminal zsh "fpath=('${zsh_script%/*}' \$fpath); compinit -u -D"
in_terminal zsh 'source <(twinbox completion zsh)'
# With bash-completion's breaks of words, and without any of = and :.
in_terminal bash "COMP_WORDBREAKS=' '; source <(twinbox completion bash)"

# All that bash offers, in its order. Commands keep the order of their groups.
sed "s/COMMANDS/$(echo $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'))/" >alike <<'END'
twinbox help <ALL>|twinbox help COMMANDS 
twinbox export <ALL>|twinbox export drawn engine.npz two\ words.npz 
twinbox figure s<ALL>|twinbox figure strip strobe 
twinbox render --png <ALL>|twinbox render --png fast small 
twinbox solve --<ALL>|twinbox solve --bomb-x --frame --help --impulses --json --method --output --quiet --run-by --set --verbose --version 
twinbox simulate our_wall.yaml <ALL>|twinbox simulate our_wall.yaml 
END
cut -d'|' -f1 alike >keys
cut -d'|' -f2 alike >lines
in_terminal bash "source '$bash_script'"

# fish completes the word before the cursor; it adds the blank itself.
if command -v fish >/dev/null; then
    equal "commands in fish" "$(HOME=$PWD fish -N -c "source '$fish_script'; complete -C 'twinbox help '" | cut -f1 | xargs)" \
        "$(echo $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'))"
    while IFS='|' read -r keys line; do
        equal "fish: $keys" "$(HOME=$PWD fish -N -c "source '$fish_script'; complete -C '${keys%<TAB>}'" | cut -f1 | head -1)" "$line"
    done <<'END'
twinbox simu<TAB>|simulate
twinbox simulate -m pair-net:network=eng<TAB>|pair-net:network=engine.npz
twinbox simulate --method=engine:acc<TAB>|--method=engine:accumulate=
twinbox render two<TAB>|two words.npz
twinbox render -o d<TAB>|drawn/
twinbox simulate height.yaml --set hei<TAB>|height=
~/../prefix/bin/twinbox completion fi<TAB>|fish
END
fi
finish
