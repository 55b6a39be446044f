#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The examples for CI systems in golden/README.md and the action of golden/action: their shell commands, run as the systems run
# them, with a build that is already there.
. "$(dirname "$0")/checks.sh"
png() { /usr/bin/python3 "$sources/tests/cli/png.py" "$@"; }

# A repository with twinbox as a submodule, and a cmake that only notes how it is called.
mkdir -p project/twinbox/build project/twinbox/tests bin temporary
ln -s "$scenes" project/twinbox/scenes
ln -s "$twinbox" project/twinbox/build/twinbox
printf '#!/bin/sh\necho setup >>"%s/calls"\n' "$folder" >project/twinbox/tests/setup
for stub in cmake apt-get sudo; do
    printf '#!/bin/sh\necho %s "$@" >>"%s/calls"\n[ %s != sudo ] || "$@"\n' $stub "$folder" $stub >bin/$stub
done
chmod +x project/twinbox/tests/setup bin/*
[ -x "$sources/tests/setup" ] || fail "the examples run tests/setup, which is not there"
grep -q '"name": "release"' "$sources/CMakePresets.json" || fail "the examples use a preset that is not there"

/usr/bin/python3 - "$sources/golden" <<'PYTHON' || fail "there are no such examples"
# Writes each step of GitHub and of the action to github.N and action.N, and GitLab's lists, which are one shell session, to gitlab.1.
import re, sys
def steps(name, text, count):
    lines, found = text.split("\n"), []
    for number, line in enumerate(lines):
        run = re.match(r"( *)(?:- )?run: (.*)", line)
        if run:
            below = [line[len(run[1]) + 2:] for line in lines[number + 1:] if line.strip()]
            indented = [line.startswith(run[1] + "  ") for line in lines[number + 1:] if line.strip()] + [False]
            found.append("\n".join(below[:indented.index(False)]) if run[2] == "|" else run[2])
    assert len(found) == count, found
    for number, step in enumerate(found, 1):
        open(f"{name}.{number}", "w").write(step + "\n")
blocks = re.findall(r"^```yaml\n(.*?)^```$", open(f"{sys.argv[1]}/README.md").read(), re.MULTILINE | re.DOTALL)
github = next(block for block in blocks if block.startswith("# .github/workflows/"))
gitlab = next(block for block in blocks if block.startswith("# .gitlab-ci.yml"))
steps("github", github, 3)
steps("action", open(f"{sys.argv[1]}/action/action.yml").read(), 2)
script = [re.search(rf"^  {key}:\n((?:    - .*\n)+)", gitlab, re.MULTILINE)[1].replace("    - ", "") for key in ("before_script", "script")]
open("gitlab.1", "w").write("".join(script))
assert re.search(r"path: report$", github, re.MULTILINE) and "junit: report/junit.xml" in gitlab
PYTHON
grep -q 'uses: ./twinbox/golden/action$' "$sources/golden/action/README.md" || fail "the page of the action uses another folder"

# session NAME COUNT FOLDER: each step is a shell of its own; lines of GITHUB_PATH come to the front of the path. Ends as they do.
session() {
    local status=0 step
    rm -rf "$3"/*report
    : >github.path
    : >summary.md
    : >calls
    : >out
    for ((step = 1; step <= $2 && status == 0; step++)); do
        (cd "$3" && GITHUB_STEP_SUMMARY=$folder/summary.md GITHUB_ACTION_PATH=$sources/golden/action RUNNER_TEMP=$folder/temporary \
            GITHUB_PATH=$folder/github.path PATH="$(tac "$folder/github.path" | tr '\n' ':')$folder/bin:$PATH" \
            bash -e -o pipefail "$folder/$1.$step") >>out 2>err
        status=$?
    done
    return $status
}

# system STATUS NAME COUNT: exit status and report.
system() {
    rm -rf project/actual
    session "$2" "$3" project
    equal "exit status of $2" $? "$1"
    for file in report.html junit.xml; do [ -s project/report/$file ] || fail "$2: no $file: $(cat err)"; done
    equal "the build of $2" "$(grep -v -e apt-get -e sudo calls)" "setup
cmake -S twinbox --preset release
cmake --build twinbox/build"
}
run 0 render "$scenes/stack.yaml" -o project/expected --frames 0:5 --size 320x180
system 0 github 3
system 0 gitlab 1
cp project/expected/frame_000000.png project/expected/frame_000003.png
system 1 github 3
says "first difference: frame_000003.png: "
system 1 gitlab 1
grep -qF '[[ATTACHMENT|actual/frame_000003.png]]' project/report/junit.xml || fail "no picture in junit.xml"

# action STATUS OPTIONS
mkdir -p mine/expected mine/actual
action() {
    EXPECTED=expected ACTUAL=actual OPTIONS=$2 session action 2 mine
    equal "exit status of the action with '$2'" $? "$1"
}
ln -s "$twinbox" bin/twinbox
png mine/expected/home.png 20 20 50
png mine/actual/home.png 20 20 50
action 0 ""
png mine/actual/home.png 20 20 51
action 1 ""
says "::error title=twinbox compare::"
grep -q '^    differs: home.png: 400 pixels differ' summary.md || fail "the summary: $(cat summary.md)"
[ -s mine/twinbox-report/report.html ] || fail "no report"
action 0 "--tolerance 1"
mkdir -p mine/twinbox-report
touch mine/twinbox-report/results.json # of an earlier run
action 2 "--help"
says "these options compare nothing: --help"
# Options are split at spaces, unless quoted; no pattern becomes the names of files.
png "mine/the mask.png" 20 20 0 3 4 255
action 0 '--tolerance 1 --mask "the mask.png"'
action 2 '--mask the*mask.png'
action 1 '--mask "the mask.png'
grep -q "unmatched double quote" err || fail "an open quote: $(cat err)"
# Without twinbox, what is built is on the path of the next step.
mkdir -p temporary/twinbox
mv bin/twinbox temporary/twinbox
action 0 "--tolerance 1"
grep -q "^cmake -S $sources/golden/action/../.. .*-DTWINBOX_PARTS=compare$" calls || fail "the build: $(cat calls)"
for package in $(grep -o 'lib[a-z]*-dev' "$sources/golden/action/action.yml"); do
    "$sources/tests/setup" --list | grep -qw -- "$package" || fail "$package is not one of tests/setup"
done
finish
