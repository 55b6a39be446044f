#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The examples for CI systems in golden/README.md: their shell commands, run as the systems run them, with a build that is
# already there.
. "$(dirname "$0")/checks.sh"

# A repository with twinbox as a submodule, and a cmake that only notes how it is called.
mkdir -p project/twinbox/build project/twinbox/tests bin
ln -s "$scenes" project/twinbox/scenes
ln -s "$twinbox" project/twinbox/build/twinbox
printf '#!/bin/sh\necho setup >>"%s/calls"\n' "$folder" >project/twinbox/tests/setup
for stub in cmake apt-get; do printf '#!/bin/sh\necho %s "$@" >>"%s/calls"\n' $stub "$folder" >bin/$stub; done
chmod +x project/twinbox/tests/setup bin/*
[ -x "$sources/tests/setup" ] || fail "the examples run tests/setup, which is not there"
grep -q '"name": "release"' "$sources/CMakePresets.json" || fail "the examples use a preset that is not there"

/usr/bin/python3 - "$sources/golden/README.md" <<'PYTHON' || fail "golden/README.md has no such examples"
# Writes each step of GitHub (run: |) to github.N, and GitLab's lists, which are one shell session, to gitlab.1.
import re, sys
blocks = re.findall(r"^```yaml\n(.*?)^```$", open(sys.argv[1]).read(), re.MULTILINE | re.DOTALL)
github = next(block for block in blocks if block.startswith("# .github/workflows/"))
gitlab = next(block for block in blocks if block.startswith("# .gitlab-ci.yml"))
steps, lines = [], github.split("\n")
for number, line in enumerate(lines):
    run = re.match(r"( *)(?:- )?run: (.*)", line)
    if run and run[2] != "|":
        steps.append(run[2])
    elif run:
        body = []
        for below in lines[number + 1:]:
            if below.strip() and not below.startswith(run[1] + "  "):
                break
            body.append(below.strip())
        steps.append("\n".join(body))
assert len(steps) == 3, steps
for number, step in enumerate(steps, 1):
    open(f"github.{number}", "w").write(step + "\n")
script = []
for key in "before_script", "script":
    script += re.search(rf"^  {key}:\n((?:    - .*\n)+)", gitlab, re.MULTILINE)[1].replace("    - ", "").split("\n")
open("gitlab.1", "w").write("\n".join(script))
assert re.search(r"path: report$", github, re.MULTILINE) and "junit: report/junit.xml" in gitlab
PYTHON

# Each step is a shell of its own, in the repository; lines of GITHUB_PATH come to the front of the path.
github() {
    : >github.path
    : >summary.md
    for step in 1 2 3; do
        (cd project && GITHUB_PATH=$folder/github.path GITHUB_STEP_SUMMARY=$folder/summary.md \
            PATH="$(tac "$folder/github.path" | tr '\n' ':')$folder/bin:$PATH" sh -e "$folder/github.$step") >>out 2>err || return
    done
}
gitlab() { (cd project && PATH="$folder/bin:$PATH" sh -e "$folder/gitlab.1") >out 2>err; }
built="setup
cmake -S twinbox --preset release
cmake --build twinbox/build"

# system STATUS NAME: exit status and report.
system() {
    rm -rf project/report project/actual
    : >calls
    : >out
    $2
    equal "exit status of $2" $? "$1"
    for file in report.html junit.xml; do [ -s project/report/$file ] || fail "$2: no $file: $(cat err)"; done
    equal "the build of $2" "$(grep -v apt-get calls)" "$built"
}
run 0 render "$scenes/stack.yaml" -o project/expected --frames 0:5 --size 320x180
system 0 github
system 0 gitlab
cp project/expected/frame_000000.png project/expected/frame_000003.png
system 1 github
says "::error file=expected/frame_000003.png,title="
grep -q '^- frame 3' summary.md || fail "no cause in the summary: $(cat summary.md)"
grep -q '^| ` frame_000003.png ` ' summary.md || fail "no row in the summary: $(cat summary.md)"
system 1 gitlab
grep -qF '[[ATTACHMENT|actual/frame_000003.png]]' project/report/junit.xml || fail "no picture in junit.xml"
finish
