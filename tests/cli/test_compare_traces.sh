#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Traces of other programs: the printers of the page write files that are compared; one is compared with many.
. "$(dirname "$0")/checks.sh"

# Each printer of the page prints the same trace of a falling body, decimals and hexadecimal alike.
page=$sources/golden/traces.md
[ -e "$page" ] || fail "no page"
/usr/bin/python3 - "$page" <<'PYTHON' || fail "the printers of the page"
import pathlib, re, sys
for name, text in re.findall(r"```\w+ file=(\S+)\n(.*?)```", pathlib.Path(sys.argv[1]).read_text(), re.S):
    pathlib.Path(name).write_text(text)
PYTHON
${CC:-cc} -ffp-contract=off -o printer_c printer.c -lm || fail "printer.c"
./printer_c >c.csv
others=c.csv
if command -v "${CXX:-c++}" >/dev/null; then
    "${CXX:-c++}" -ffp-contract=off -o printer_cpp printer.cpp || fail "printer.cpp"
    ./printer_cpp >cpp.csv
    others+=" cpp.csv"
fi
if command -v rustc >/dev/null; then
    rustc -o printer_rust printer.rs 2>/dev/null || fail "printer.rs"
    ./printer_rust >rust.csv
    others+=" rust.csv"
fi
if command -v node >/dev/null; then
    node printer.mjs >js.csv || fail "printer.mjs"
    others+=" js.csv"
fi
cp c.csv again.csv
run 0 compare c.csv again.csv $others
says "$(($(echo "$others" | wc -w) + 1)) of $(($(echo "$others" | wc -w) + 1)) equal"

# Engines print themselves with the same five lines: twice the same, and another number of iterations parts in some frame.
if [ -e /usr/include/box2d/box2d.h ] && command -v c++ >/dev/null; then
    sed -n '1,/^}/p' printer.cpp | cat - <(cat <<'CPP'
#include <box2d/box2d.h>
#include <cstdlib>

int main(int, char **arguments) {
    b2World world(b2Vec2(0, -10));
    b2BodyDef place;
    b2PolygonShape box;
    b2Body *bodies[5];
    for (int i = 0; i < 5; i++) {
        place.type = i == 0 ? b2_staticBody : b2_dynamicBody;
        place.position.Set(0.1f * i, i == 0 ? -1 : 1.1f * i);
        box.SetAsBox(i == 0 ? 50 : 0.5f, i == 0 ? 1 : 0.5f);
        (bodies[i] = world.CreateBody(&place))->CreateFixture(&box, 1);
    }
    for (int frame = 0; frame < 60; frame++, world.Step(1 / 60.f, std::atoi(arguments[1]), 3))
        for (int i = 0; i < 5; i++)
            trace(stdout, frame, i, bodies[i]->GetPosition().x, bodies[i]->GetPosition().y, bodies[i]->GetAngle());
}
CPP
    ) >box2d.cpp
    c++ -o box2d box2d.cpp -lbox2d || fail "box2d.cpp"
    ./box2d 8 >box2d.csv
    ./box2d 8 >box2d_again.csv
    ./box2d 9 >box2d_9.csv
    run 1 compare box2d.csv box2d_again.csv box2d_9.csv
    says "1 of 2 equal; box2d_9.csv parts in frame "
else
    echo "skipped: Box2D 2.4 is not installed"
fi
if [ -d "$scenes/engines/node_modules/@dimforge/rapier2d-compat" ] && command -v node >/dev/null; then
    ln -s "$scenes/engines/node_modules" .
    sed -n '1,/^}/p' printer.mjs | cat - <(cat <<'JS'
import rapier from '@dimforge/rapier2d-compat'

await rapier.init()
const world = new rapier.World({ x: 0, y: -10 })
world.numSolverIterations = +process.argv[2]
const bodies = [0, 1, 2, 3, 4].map((i) => {
  const place = i === 0 ? rapier.RigidBodyDesc.fixed() : rapier.RigidBodyDesc.dynamic()
  const body = world.createRigidBody(place.setTranslation(0.1 * i, i === 0 ? -1 : 1.1 * i))
  world.createCollider(rapier.ColliderDesc.cuboid(i === 0 ? 50 : 0.5, i === 0 ? 1 : 0.5), body)
  return body
})
for (let frame = 0; frame < 60; frame++, world.step())
  bodies.forEach((body, i) => trace(frame, i, body.translation().x, body.translation().y, body.rotation()))
JS
    ) >rapier.mjs
    node rapier.mjs 4 >rapier.csv || fail "rapier.mjs"
    node rapier.mjs 4 >rapier_again.csv
    node rapier.mjs 5 >rapier_5.csv
    run 1 compare rapier.csv rapier_again.csv rapier_5.csv
    says "1 of 2 equal; rapier_5.csv parts in frame "
else
    echo "skipped: Rapier needs node and scenes/engines/setup"
fi

# Many inputs: a line, a table, JSON, a report. What is missing in a folder fails.
sed 's/^137,0,[^,]*,/137,0,9,/' c.csv >other.csv
run 1 compare c.csv again.csv other.csv --report report
says "1 of 2 equal; other.csv parts in frame 137 at body 0 (motion)"
says "other.csv  physics changed   frame 137, body 0: motion: more than roundings, in 1 body"
equal "files" "$(ls report | tr '\n' ' ')" "junit.xml report.html results.json run.html "
grep -q 'tests="2" failures="1"' report/junit.xml || fail "junit.xml"
grep -q 'run.html#t=2.28' report/report.html || fail "no link to the first difference"
run 1 compare c.csv again.csv other.csv --json
/usr/bin/python3 -c 'import json; j = json.load(open("out")); assert j["passed"] == 1 and j["runs"][1]["frame"] == 137, j' ||
    fail "JSON"
mkdir expected arm wasm
cp c.csv expected/one.csv
cp c.csv expected/two.csv
cp expected/* arm
cp other.csv wasm/one.csv
cp c.csv wasm/three.csv
run 1 compare expected arm wasm
says "1 of 2 equal; wasm/one.csv parts in frame 137 at body 0 (motion)"
says "wasm/two.csv    missing"
says "wasm/three.csv  extra"
run 2 compare c.csv again.csv nothing.csv
complains "nothing.csv: error: cannot open: No such file or directory"
says "1 of 2 equal; nothing.csv: "

# From standard input, and in two folders.
"$twinbox" compare c.csv - <other.csv >out && fail "standard input is not read"
says "first difference: frame 137, body 0"
run 1 compare expected wasm
says "only in expected: 1 trajectory: two.csv"
finish
