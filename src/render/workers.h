/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distributes pictures over worker processes and reads their reports. Workers are forked before any OpenGL context is
   created: a context does not survive a fork. */
#pragma once
#include "common/progress.h"
#include "render/worker.h"

/* Draws or keeps the pictures of the job, by as many processes as its options say, and adds them to its manifest. Then the
   files are safely on the disk. *kept: how many were kept; may be NULL. ERROR_INTERRUPTED if progress requests a stop. */
bool workers_draw(const WorkerJob *job, int *kept, const Progress *progress, Error *error);
