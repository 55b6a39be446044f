// SPDX-License-Identifier: GPL-3.0-or-later
// compare_server.js FOLDER: odiff's own client (odiff-bin) asks odiff and, through the npm wrapper in the folder, twinbox about
// the pictures of compare_server.py. The answers are equal.
"use strict";
const assert = require("assert");
const fs = require("fs");
const { ODiffServer } = require("odiff-bin");
const { compare, server } = require(require("path").resolve(process.argv[2]));

const asked = [
  {}, { threshold: 0 }, { threshold: 0.05, captureDiffLines: true, captureDiffCols: true }, { failOnLayoutDiff: true },
  { threshold: 0.3, outputDiffMask: true }, { diffOverlay: true, diffColor: "#cd2cc9" },
  { ignoreRegions: [{ x1: 3, y1: 4, x2: 50, y2: 40 }] }];

async function main() {
  const odiff = new ODiffServer(), twinbox = new ODiffServer(server);
  let count = 0;
  for (const options of asked)
    for (const other of ["a.png", "b.png", "wide.png"]) {
      if (other === "wide.png" && options.ignoreRegions) continue; // odiff compares ignored pixels that one picture lacks
      const wanted = await odiff.compare("a.png", other, "odiff.png", options);
      const { requestId, ...found } = await twinbox.compare("a.png", other, "twinbox.png", options);
      delete wanted.requestId;
      assert.deepStrictEqual(found, wanted, `${other} ${JSON.stringify(options)}`);
      assert.ok(wanted.match !== false || wanted.reason !== "pixel-diff" || fs.existsSync("twinbox.png"));
      count++;
    }
  const [a, b] = ["a.png", "b.png"].map((file) => fs.readFileSync(file));
  const files = [a, "png", b, "png", "buffers.png"];
  const [wanted, found] = [await odiff.compareBuffers(...files), await twinbox.compareBuffers(...files)];
  assert.deepStrictEqual({ ...found, requestId: 0 }, { ...wanted, requestId: 0 });
  await assert.rejects(twinbox.compare("a.png", "none.png", "none.png"), /none\.png: error: /);
  await Promise.all([...Array(50).keys()].map(() => twinbox.compare("a.png", "b.png", "all.png")));
  odiff.stop();
  twinbox.stop();
  const result = await compare("a.png", "b.png", ["--tolerance", "1"]);
  assert.strictEqual(result.passed, false);
  assert.ok((await compare("a.png", "a.png")).passed);
  await assert.rejects(compare("a.png", "none.png"), /none\.png/);
  console.log(`${count} requests with equal answers`);
}
main().catch((error) => { console.error(error); process.exit(1); });
