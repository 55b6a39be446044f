/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs for other programs. CSV: csv_run.h. */
#pragma once
#include "trajectory/trajectory.h"

/* One object, without what is unknown: README.md lists its keys. */
bool json_run_write(const Trajectory *run, const char *path, Error *error);

/* A Python script that builds the run in Blender: a box per body, with a key for each frame. It has the same object as text,
   without contacts. */
bool blender_run_write(const Trajectory *run, const char *path, Error *error);

/* Prints the object. */
void json_run_print(FILE *out, const Trajectory *run, bool contacts);
