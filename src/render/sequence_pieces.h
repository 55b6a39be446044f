/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sequence in pieces (pieces/pieces.h): ranges of consecutive pictures, whose frames are files in the folder. The results
   of a piece are lines "INDEX PIXELS FILE": the hashes of its pictures. */
#pragma once
#include "render/worker.h"

/* Draws the pieces of a shard; checks those of a merge, and takes their hashes into the job's manifest. Of a whole sequence,
   checks only that no shards are in the folder. */
bool sequence_pieces_do(const WorkerJob *job, RenderStudy *study, const Progress *progress, Error *error);
