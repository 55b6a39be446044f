/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies in pieces, so that one that is interrupted continues, and several processes share one:

     pieces_open(&pieces, folder, &key, shard, error) && pieces_do(&pieces, &plan, progress, error);
     if (pieces.shard.count > 0) return;
     ... pieces_read() ... the tables are written ...
     pieces_end(&pieces, error);

   The list of pieces follows from the study's inputs alone. A finished piece is a file in folder/parts-KEY: it is
   written whole (write, fsync, rename), and read with its key and hash. So no file is locked and none is trusted; two
   processes that do the same piece write the same file, and folders of pieces may be copied together. */
#pragma once
#include "base/base.h"
#include "base/machine.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A hash of everything that determines a study's result: pieces of an interrupted study, and of other processes, are
   used only if the key is the same. */
typedef struct StudyKey {
    uint64_t value;
} StudyKey;

/* Starts with the hash of this program's file, so that another build does not use the pieces. False with error set if
   the file cannot be read. */
bool study_key_begin(StudyKey *key, Error *error);

void study_key_add(StudyKey *key, const void *data, size_t size);

/* Adds the contents of a file. False with error set if it cannot be read. */
bool study_key_add_file(StudyKey *key, const char *path, Error *error);

enum { PIECE_NAME_SIZE = 128, PIECES_PATH_SIZE = 4096, PIECES_MAX = 1 << 30, SHARDS_MAX = 1000000 };

typedef struct PieceInfo {
    char name[PIECE_NAME_SIZE]; /* for messages; no two pieces have the same */
    double weight;              /* about its seconds on one core */
    bool alone;                 /* done after all others, one at a time: it uses all cores, or builds on others */
    bool timed;                 /* its results have times: no shard does it */
} PieceInfo;

typedef struct PiecePlan {
    int64_t count;
    /* Fills in the name and the weight; the rest is false already. */
    void (*describe)(void *context, int64_t piece, PieceInfo *info);
    /* Does a piece and writes its results. Called from several threads at once, except for those done alone; may use
       parallel_for(). ERROR_INTERRUPTED if progress requests a stop. */
    bool (*work)(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error);
    /* Whether what a piece builds on is there; NULL: always. */
    bool (*ready)(void *context, int64_t piece);
    /* *there: whether the files that the piece wrote beside its results, such as networks, are there and are as the
       results say. If they are not, the piece counts as not done. False with error set if the system cannot tell. NULL:
       it wrote no files. */
    bool (*whole)(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error);
    void *context;
} PiecePlan;

/* What a process does of a study: every count-th piece, from number 1 .. count on; zero: all that is missing. */
typedef struct Shard {
    int number, count;
} Shard;

typedef struct Pieces {
    Shard shard;
    uint64_t key;
    char folder[PIECES_PATH_SIZE]; /* of the pieces' files */
    const PiecePlan *plan;         /* of pieces_do() */
    int64_t own, kept, left;       /* of this process: all, done before, left to a process without a shard */
} Pieces;

/* output: the folder that the study writes. A process without a shard has it to itself (folder_reserve()). */
bool pieces_open(Pieces *pieces, const char *output, const StudyKey *key, const Shard *shard, Error *error);

/* Does the process's pieces that are not done yet. A shard leaves those that are timed, so that all times are of one
   machine that does nothing else, and those that are not ready. The results do not depend on the number of threads.
   ERROR_INTERRUPTED if progress requests a stop: finished pieces stay. The plan must outlive pieces. */
bool pieces_do(Pieces *pieces, const PiecePlan *plan, const Progress *progress, Error *error);

/* Whether a piece is done, by whatever process. ERROR_INPUT if its file is damaged or of another study. */
bool pieces_find(const Pieces *pieces, int64_t piece, bool *done, Error *error);

/* The results of a piece, to be freed, with a NUL behind them that *size does not count; cpu, or NULL: the processor
   that did it, of a timed piece. */
char *pieces_read(const Pieces *pieces, int64_t piece, size_t *size, char cpu[CPU_NAME_SIZE], Error *error);

/* The study is written: removes its pieces. */
bool pieces_end(const Pieces *pieces, Error *error);

/* The file of a piece, for messages. ERROR_INPUT if the path is too long. */
bool pieces_path(const Pieces *pieces, int64_t piece, char path[PIECES_PATH_SIZE], Error *error);
