#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the installed program: `twinbox-compare EXPECTED ACTUAL [OPTION...]` is `twinbox compare ...`, with its exit status.
//
//     const { compare } = require("twinbox-compare");
//     const { passed, frames } = await compare("expected", "actual", ["--antialias"]); // what --json prints
"use strict";
const { execFile, spawn } = require("child_process");
const { accessSync, constants, statSync } = require("fs");
const path = require("path");

function isProgram(file) {
  try {
    accessSync(file, constants.X_OK);
    return statSync(file).isFile();
  } catch {
    return false;
  }
}

/** The path of the program: that of the environment variable TWINBOX, or the first twinbox in PATH. */
function find() {
  const folders = (process.env.PATH || "").split(path.delimiter).filter(Boolean);
  const found = process.env.TWINBOX || folders.map((folder) => path.join(folder, "twinbox")).find(isProgram);
  if (found && isProgram(found)) return found;
  throw new Error(found ? `${found} is no program` : "twinbox is not installed: it is not in PATH, and TWINBOX is not set");
}

/** Compares two files or folders. Resolves to the object of `twinbox compare --json`; rejects if they cannot be compared. */
function compare(expected, actual, options = []) {
  return new Promise((resolve, reject) => {
    const words = ["compare", ...options, "--json", "--", expected, actual];
    execFile(find(), words, { maxBuffer: 1 << 30 }, (error, output, messages) => {
      if (error && error.code !== 1) return reject(new Error(messages.trim() || error.message));
      try {
        resolve(JSON.parse(output));
      } catch {
        reject(new Error(`these options compare nothing: ${options.join(" ")}`));
      }
    });
  });
}

module.exports = { compare, find };

if (require.main === module) {
  try {
    const child = spawn(find(), ["compare", ...process.argv.slice(2)], { stdio: "inherit" });
    for (const signal of ["SIGINT", "SIGTERM"]) process.on(signal, () => child.kill(signal));
    child.on("error", (error) => console.error(error.message) || process.exit(3));
    child.on("exit", (status) => process.exit(status === null ? 3 : status));
  } catch (error) {
    console.error(error.message);
    process.exitCode = 3;
  }
}
