/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which arrays a run has, and what others may have called them. Only trajectory_read.c includes this. */
#pragma once
#include "npz/npz.h"

/* False with error set if the file is one of another kind, lacks a needed array, has a part of those that only come
   together, or has an unknown array that looks like one that it lacks: then the error suggests that name. Other unknown arrays are
   ignored. */
bool run_arrays_check(NpzFile *file, Error *error);
