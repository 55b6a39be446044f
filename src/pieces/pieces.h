/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study in pieces, whose results are files. The plan of a study, its list of pieces, follows from its inputs alone, so
   that processes on many machines have the same plan without talking to each other.

   The whole study is done by one process; its pieces are in DIR/parts-KEY until it has ended, so that an interrupted
   study continues. A shard does its share only, and leaves it in DIR/shards. A merge does no piece: it finds all of
   them in DIR/shards. What follows from the pieces, tables and figures, is made by the same code for the whole and for
   a merge:

     pieces_open(); pieces_do(); if (pieces.mode == PIECES_SHARD) return; ... pieces_read() ...; pieces_end();

   No file is locked and none is trusted: a piece is written whole (write, fsync, rename), and read with its key and
   hash. Two processes that do the same piece write the same file. */
#pragma once
#include "common/progress.h"
#include "pieces/piece_file.h"
#include "pieces/shard.h"
#include "pieces/study_key.h"

#include <stdio.h>

enum { PIECES_PATH_SIZE = 4096 };

typedef enum PiecesMode { PIECES_WHOLE, PIECES_SHARD, PIECES_MERGE } PiecesMode;

/* How a command runs. NULL: the whole study. */
typedef struct PiecesRun {
    ShardRequest request;
    bool merge, times_first; /* times_first: see pieces_keep_times() */
    int argc;
    char **argv;   /* of the command, to be run again by the merge */
    char **shards; /* NULL, or where a merge that misses pieces puts the list of their shards: "3,17-20"; to be freed */
} PiecesRun;

typedef struct PieceInfo {
    char name[PIECE_NAME_SIZE]; /* for messages; no two pieces have the same */
    double weight;              /* about its seconds on one core */
    bool alone;                 /* done after all others, one at a time: it takes times, or builds on others */
    bool timed;                 /* its results have times */
    int64_t with;               /* done by the shard of this piece; its own number, unless changed */
    int64_t near;               /* shares work with this piece: the same, while shards are few; -1: with none */
} PieceInfo;

typedef struct PiecePlan {
    int64_t count;
    /* Fills in the name and the weight; the rest is set already. */
    void (*describe)(void *context, int64_t piece, PieceInfo *info);
    /* Does a piece and writes its results. Called from several threads at once, except for those done alone; may use
       parallel_for(). ERROR_INTERRUPTED if progress requests a stop. */
    bool (*work)(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error);
    /* Whether what a piece builds on is there; NULL: always. */
    bool (*ready)(void *context, int64_t piece);
    /* *there: whether the files that the piece wrote beside its results, such as frames, are there and are as the results
       say. If they are not, the piece counts as not done. False with error set if the system cannot tell. NULL: it wrote no
       files. */
    bool (*whole)(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error);
    void *context;
} PiecePlan;

/* Up to so many shards, what pieces share is worth more than that all shards have equally much to do. */
enum { PIECES_NEAR_SHARDS = 8 };

/* A piece of the plan, with what its describe() leaves as it is. */
PieceInfo piece_describe(const PiecePlan *plan, int64_t piece);

/* The shard that does a piece of so many. */
int piece_shard(const PieceInfo *info, int64_t pieces, int shards);

/* pieces_close() after pieces_open(), also after its failure. */
typedef struct Pieces {
    PiecesMode mode;
    Shard shard;
    JobArray array;       /* of the study's first start */
    const PiecesRun *run; /* or NULL */
    uint64_t key;
    char folder[PIECES_PATH_SIZE]; /* of the pieces' files */
    const PiecePlan *plan;         /* of pieces_do() */
    int64_t own, kept, waiting;    /* of this process: all, done before, not ready yet */
    char cpu[CPU_NAME_SIZE];       /* of the first timed piece; "": nothing was timed */
    bool cpus_differ;
} Pieces;

/* How a command will run, as pieces_open() decides it. */
bool pieces_find_mode(PiecesMode *mode, const char *output, bool output_is_file, const PiecesRun *run, Error *error);

/* output: the folder or the file that the study writes. A whole study is refused where shards are, a shard where another
   study's are; a merge where the study's inputs have changed. */
bool pieces_open(Pieces *pieces, const char *output, bool output_is_file, const StudyKey *key, const PiecesRun *run,
                 Error *error);
void pieces_close(Pieces *pieces);

/* Does the process's pieces that are not done yet: those of the whole, or of the shard. The results do not depend on
   the number of threads. ERROR_INTERRUPTED if progress requests a stop: finished pieces stay. A merge checks all
   pieces: ERROR_INCOMPLETE names those that are missing, and the option --array of Slurm that does them. The plan must
   outlive pieces. */
bool pieces_do(Pieces *pieces, const PiecePlan *plan, const Progress *progress, Error *error);

/* Whether a piece is done, by whatever process; cpu as for pieces_read(), "" if it is not. ERROR_INPUT if its file is
   damaged or of another study. */
bool pieces_find(const Pieces *pieces, int64_t piece, bool *done, char cpu[CPU_NAME_SIZE], Error *error);

/* The results of a piece, to be freed, with a NUL behind them that *size does not count. cpu may be NULL. */
char *pieces_read(const Pieces *pieces, int64_t piece, size_t *size, char cpu[CPU_NAME_SIZE], Error *error);

/* Whether times of a piece measured on this processor count: `merge --times first` leaves out those of others than the
   first timed piece. */
bool pieces_keep_times(const Pieces *pieces, const char *cpu);

/* The study is written: removes the pieces of a whole study; those of shards stay. */
bool pieces_end(const Pieces *pieces, Error *error);

/* The head that the file of a piece must have, and its path. ERROR_INPUT if the path is too long. */
void pieces_head(const Pieces *pieces, int64_t piece, PieceHead *head);
bool pieces_path(const Pieces *pieces, int64_t piece, char path[PIECES_PATH_SIZE], Error *error);

/* Where the shards of an output are: "DIR/shards" or "FILE.shards". */
bool pieces_shards_folder(char path[PIECES_PATH_SIZE], const char *output, bool output_is_file, Error *error);
