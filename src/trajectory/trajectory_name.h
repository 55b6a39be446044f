/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of runs from files, and the file names of runs that are stored beside the pictures of them. */
#pragma once
#include "trajectory/trajectory.h"

enum { TRAJECTORY_FILE_NAME_SIZE = 2 * TRAJECTORY_NAME_SIZE + 24 };

/* The file name of run `index` of these: SCENE-METHOD.npz, with '_' for what does not belong in a file name. A second run
   of that name gets SCENE-METHOD-2.npz, and so on. */
void trajectory_file_name(const Trajectory *const *runs, int index, char name[TRAJECTORY_FILE_NAME_SIZE]);

/* What scene and method are called in a run that does not state it: the file's name without folder and ending. Bytes that
   a name must not have become '_'. */
void trajectory_name_from_path(const char *path, char name[TRAJECTORY_NAME_SIZE]);
