#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# `cmake --install` into an empty prefix, which then moves: the installed program finds its scenes and their networks.
. "$(dirname "$0")/checks.sh"

build=$(dirname "$twinbox")
built=$twinbox
"$built" simulate "$scenes/stack.yaml" --method pair-net --hash built.hash >/dev/null
run 2 simulate scenes/stack.yaml
complains "scenes/stack.yaml: error:"
run 2 paper -o none --quick
complains "scenes/single.yaml: error:"

cmake --install "$build" --prefix "$folder/first" >installed || fail "cmake --install"

# A build of the program alone, such as the demo's, has no manual pages.
if grep -q man/man1 "$build/cmake_install.cmake"; then
    sed "s|$build/man/|$folder/no_manuals/|" "$build/cmake_install.cmake" >alone.cmake
    cmake -DCMAKE_INSTALL_PREFIX="$folder/alone" -P alone.cmake >installed || fail "an installation without manual pages"
    grep -q "No manual pages, as they are not built" installed || fail "missing pages are not told: $(tail -3 installed)"
    [ -x alone/bin/twinbox ] || fail "no program without manual pages"
fi
mv first second
twinbox=$folder/second/bin/twinbox
mkdir elsewhere
cd elsewhere || exit 1

# A scene by its name, wherever it is.
for name in stack scenes/stack.yaml; do
    run 0 simulate $name --method pair-net --hash run.hash
    cmp -s run.hash ../built.hash || fail "'$name' is another scene"
done
run 0 simulate arch --frames 1
says "arch by engine: 1 steps"
# A network by its path in the repository; one that is nowhere is named.
run 0 simulate stack --method pair-net:network=scenes/networks/pair-net.npz --hash run.hash
cmp -s run.hash ../built.hash || fail "scenes/networks/pair-net.npz is another network"
# What is stored has the name as it was typed: another prefix gives the same bytes.
own=pair-net:network=scenes/networks/pair-net.npz
run 0 simulate stack --method $own --frames 20 -o own.npz
run 0 page own.npz -o own.html
run 0 page --live stack --method $own -o live.html
(cd "$sources" && "$built" simulate stack --method $own --frames 20 -o "$folder/own.npz" && "$built" page "$folder/own.npz" \
    -o "$folder/own.html" && "$built" page --live stack --method $own -o "$folder/live.html") >/dev/null
for file in own.npz own.html live.html; do
    cmp -s $file ../$file || fail "$file depends on where twinbox is installed"
done
run 2 simulate stack --method pair-net:network=scenes/networks/none.npz
complains "scenes/networks/none.npz: error: cannot open"
run 2 simulate no_such_scene
complains "no_such_scene: error: cannot open"
(cd "$sources" && "$built" simulate stack --method pair-net --hash "$folder/named.hash" >/dev/null)
cmp -s ../named.hash ../built.hash || fail "'stack' is not scenes/stack.yaml of the working directory"
run 0 render scenes/single.yaml --frames 0:1 -o pictures
run 0 chart scenes/single.yaml --quick --launches scenes/launches/far.csv --methods engine -o chart
run 0 stability --study bomb_speed --methods engine:k=4 -o stability
says "borders -> stability/stability.csv"
# Refused for its folder, not for its scenes.
run 3 paper -o /proc/none --quick
[ -e scenes ] && fail "there are scenes in the working directory"

# What is here comes first.
mkdir scenes
echo "boxes" >scenes/stack.yaml
run 2 simulate scenes/stack.yaml
complains "scenes/stack.yaml:1:"
run 2 simulate scenes/none.yaml
complains "scenes/none.yaml: error:"

cd ..
pages=second/share/doc/twinbox
for file in README.md LICENSE OFL.txt; do [ -s $pages/$file ] || fail "no $file"; done
pictures=$(grep -oE '[("][^()":]*\.(png|gif)[)"]' $pages/README.md | tr -d '()"')
equal "a page has pictures" "$([ -n "$pictures" ] && echo yes)" yes
for picture in $pictures; do [ -s "$pages/$picture" ] || fail "README.md shows $picture, which is not installed"; done
for scene in "$sources"/scenes/*.yaml "$sources"/scenes/stability/*.yaml "$sources"/scenes/large/*.yaml; do
    cmp -s "$scene" "second/share/twinbox/${scene#"$sources"/}" || fail "$scene is not installed"
done

DESTDIR=$folder/stage cmake --install "$build" --prefix /usr >installed || fail "cmake --install with DESTDIR"
equal "what is staged" "$(cd stage && echo *)" usr
run 0 --version
equal "the staged program" "$(stage/usr/bin/twinbox --version)" "$(cat out)"
finish
