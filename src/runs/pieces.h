/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies in pieces: the plan, shards, files of pieces, run.json, the merge. */
#pragma once
#include "base/base.h"
#include "base/machine.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The file of a finished piece: some lines of text that say what it is, an empty line, then its results. */

enum { PIECE_NAME_SIZE = 128, PIECE_MAX_SIZE = 1 << 28 };

typedef struct PieceHead {
    uint64_t key;   /* of the study */
    int64_t number; /* of the piece, from 0 */
    char name[PIECE_NAME_SIZE];
    char cpu[CPU_NAME_SIZE]; /* that times were measured on; "": nothing was timed */
} PieceHead;

/* Writes the file atomically, and waits until it is on the disk. */
bool piece_file_write(const char *path, const PieceHead *head, const void *results, size_t size, Error *error);

/* Returns the results, to be freed, with a NUL behind them that *size does not count. NULL with error set: ERROR_INPUT
   if the file is damaged, cut off, or of another study or piece than the head says. The head's cpu is taken from the
   file. */
char *piece_file_read(const char *path, PieceHead *head, size_t *size, Error *error);

/* Which share of a study a process does. */

enum { SHARDS_MAX = 1000000, PIECES_MAX = 1 << 30 };

typedef struct Shard {
    int number, count; /* 1 <= number <= count; 1 of 1 is the whole study */
} Shard;

/* "3/16". */
bool shard_parse(Shard *shard, const char *text, Error *error);

/* The shard, from 1, that does piece `piece` of `pieces`. Shards have equally many pieces, or one more; neighbouring
   pieces, which are often equally long, go to different shards. */
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

/* The request of --shard (NULL: not given), or else of the environment: a Slurm job array, PMI, OpenMPI, or Slurm
   tasks, in this order. ERROR_INPUT for what is no share, and for a job array whose tasks have several ranks each:
   nothing says which of the two is meant. */
bool shard_request(ShardRequest *request, const char *option, Error *error);

/* A hash of everything that determines a study's result: pieces of an interrupted study, and of other processes, are
   used only if the key is the same. Beside it, what it was made of, to say what differs. */

typedef struct StudyInput {
    char *path;
    uint64_t hash;
} StudyInput;

/* study_key_free(), also after a failure. */
typedef struct StudyKey {
    uint64_t value, program; /* program: hash of this program's file */
    StudyInput *inputs;      /* [count] the files, in the order in which they were added */
    size_t count, capacity;
} StudyKey;

/* Starts with the hash of this program's file, so that another build does not use the pieces. False with error set if
   the file cannot be read. */
bool study_key_begin(StudyKey *key, Error *error);
void study_key_free(StudyKey *key);

void study_key_add(StudyKey *key, const void *data, size_t size);

/* Adds an input of which the hash is known already. */
bool study_key_add_input(StudyKey *key, const char *path, uint64_t hash, Error *error);

/* Adds the contents of a file. False with error set if it cannot be read. */
bool study_key_add_file(StudyKey *key, const char *path, Error *error);

/* A study in pieces, whose results are files. The plan of a study, its list of pieces, follows from its inputs alone,
   so that processes on many machines have the same plan without talking to each other.

   The whole study is done by one process; its pieces are in DIR/parts-KEY until it has ended, so that an interrupted
   study continues. A shard does its share only, and leaves it in DIR/shards. A merge does no piece: it finds all of
   them in DIR/shards. What follows from the pieces, tables and figures, is made by the same code for the whole and for
   a merge:

     pieces_open(); pieces_do(); if (pieces.mode == PIECES_SHARD) return; ... pieces_read() ...; pieces_end();

   No file is locked and none is trusted: a piece is written whole (write, fsync, rename), and read with its key and
   hash. Two processes that do the same piece write the same file. */

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
    /* *there: whether the files that the piece wrote beside its results, such as frames, are there and are as the
       results say. If they are not, the piece counts as not done. False with error set if the system cannot tell. NULL:
       it wrote no files. */
    bool (*whole)(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error);
    void *context;
} PiecePlan;

/* Up to so many shards, what pieces share is worth more than that all shards have equally much to do. */
enum { PIECES_NEAR_SHARDS = 8 };

/* A piece of the plan, with what its describe() leaves as it is. */
PieceInfo piece_describe(const PiecePlan *plan, int64_t piece);

/* The shard that does a piece of so many. */
int piece_shard(const PieceInfo *info, int64_t pieces, int shards);

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
bool pieces_find_mode(PiecesMode *mode, const char *output, const PiecesRun *run, Error *error);

/* output: the folder that the study writes. A whole study is refused where shards are, a shard where another
   study's are; a merge where the study's inputs have changed. */
bool pieces_open(Pieces *pieces, const char *output, const StudyKey *key, const PiecesRun *run, Error *error);

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

/* run.json of the shards of an output. */
bool pieces_record_path(char path[PIECES_PATH_SIZE], const char *output, Error *error);

/* run.json: what the shards of a study have in common. The first process of the study writes it, all others compare. */

#define STUDY_RECORD_FORMAT "twinbox shards 1"

/* Bytes of the file at most. */
enum { STUDY_RECORD_SIZE = 60000 };

/* The command line that runs the study, the folder in which its paths are, and its output. */
typedef struct StudyCommand {
    int argc;
    char **argv; /* [argc] "twinbox chart", then the arguments */
    char *folder, *output;
} StudyCommand;

/* study_record_free(), also after a failure. */
typedef struct StudyRecord {
    char *version;
    StudyKey key;
    int shards;
    JobArray array; /* of the first start; step 0: it was no job array */
    StudyCommand command;
    uint64_t hash; /* of all of these, as the file states it */
} StudyRecord;

/* ERROR_INPUT with path:line:column if the file is missing, damaged, or no record. */
bool study_record_read(StudyRecord *record, const char *path, Error *error);
void study_record_free(StudyRecord *record);

/* What a process that starts would write. */
typedef struct StudyStart {
    const StudyKey *key;
    const ShardRequest *request;
    const char *output;
    int argc;
    char **argv;
} StudyStart;

/* Makes the file unless it is there. True with *record read in either case; the first writer wins. */
bool study_record_meet(StudyRecord *record, const char *path, const StudyStart *start, Error *error);

/* ERROR_INPUT unless this program, with this key and these arguments (argv NULL: not compared), does the recorded
   study, and the record is as it was written: says what differs. */
bool study_record_check(const StudyRecord *record, const char *path, const StudyKey *key, int argc, char **argv,
                        Error *error);

/* The shard of the request in the recorded study: a retried job array has other bounds. ERROR_INPUT if N differs. */
bool study_record_shard(const StudyRecord *record, const char *path, const ShardRequest *request, Shard *shard,
                        Error *error);

/* What a study takes on many cores, from some of its pieces. */

typedef struct PiecesEstimate {
    int64_t pieces;
    int measured;          /* of them */
    double seconds, bytes; /* of a piece on one core, on average */
    double longest;        /* seconds of the longest piece, by the measured ones and the weights of the others */
    double together;       /* seconds of the pieces that few shards do not divide */
    double total;          /* seconds of all pieces on one core */
} PiecesEstimate;

enum { PIECES_MEASURED = 32 };

/* Does up to PIECES_MEASURED pieces, spread over the plan, without storing them; begins no more after half a minute.
   Pieces that are done alone are not measured. Processor time, so that other programs do not count. ERROR_INTERRUPTED
   if progress requests a stop. */
bool pieces_estimate(PiecesEstimate *estimate, const PiecePlan *plan, const Progress *progress, Error *error);

/* What takes longest when `cores` cores do a study. */
typedef enum PiecesLimit { LIMIT_COMPUTING, LIMIT_LONGEST, LIMIT_FILES, LIMIT_MERGE, PIECES_LIMITS } PiecesLimit;

extern const char *const pieces_limit_names[PIECES_LIMITS];

/* Seconds of each, in the order of PiecesLimit. The first three happen at the same time, the merge afterwards. files:
   that the shared file system makes or opens in a second. Returns which is the largest. */
PiecesLimit pieces_times(const PiecesEstimate *estimate, int64_t cores, double files, double seconds[PIECES_LIMITS]);
