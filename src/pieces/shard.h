/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which share of a study a process does. */
#pragma once
#include "common/error.h"

#include <stdint.h>

enum { SHARDS_MAX = 1000000, PIECES_MAX = 1 << 30 };

typedef struct Shard {
    int number, count; /* 1 <= number <= count; 1 of 1 is the whole study */
} Shard;

/* "3/16". */
bool shard_parse(Shard *shard, const char *text, Error *error);

/* The shard, from 1, that does piece `piece` of `pieces`. Shards have equally many pieces, or one more; neighbouring pieces,
   which are often equally long, go to different shards. */
int shard_of(int64_t piece, int64_t pieces, int shards);

/* The tasks of a job array, as Slurm numbers them: first, first + step, ... */
typedef struct JobArray {
    int first, step, id; /* step 0: not of a job array; id: of this process */
} JobArray;

/* What a process was asked to do. Zero: the whole study. */
typedef struct ShardRequest {
    Shard shard;
    JobArray array;
    char source[160]; /* the variables that it was detected by: "SLURM_ARRAY_TASK_ID=3 of 1-16"; "": none */
} ShardRequest;

/* The request of --shard (NULL: not given), or else of the environment: a Slurm job array, PMI, OpenMPI, or Slurm tasks,
   in this order. ERROR_INPUT for what is no share, and for a job array whose tasks have several ranks each: nothing says
   which of the two is meant. */
bool shard_request(ShardRequest *request, const char *option, Error *error);
