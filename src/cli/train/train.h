/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of network that `twinbox train` trains. To add a kind, write one file that defines train_NAME, and add one
   line KIND(NAME) here. */
#pragma once
#include "cli/options.h"
#include "pieces/pieces.h"

/* The first is the default of --kind. */
#define TRAIN_KINDS(KIND) \
    KIND(pair_net)        \
    KIND(scene_net)       \
    KIND(sain)            \
    KIND(hybrid)          \
    KIND(gns)             \
    KIND(subspace)

/* What to train, as on the command line. */
typedef struct TrainRequest {
    const struct TrainKind *kind;
    const char *input, *output;
    const char *values[OPTIONS_MAX]; /* texts of the kind's options; NULL: neither given nor a standard; "": a flag */
    PiecesRun run;                   /* of kinds with TRAIN_SHARD; of others zero */
} TrainRequest;

typedef struct TrainKind {
    const char *name, *input, *summary; /* input: what the help calls the file to train on; NULL: none */
    const char *file_kind;              /* of the file that is written (npz_check_kind) */
    const Option *options;              /* in the order of a command; those not given have the value `standard` */
    bool (*train)(const TrainRequest *request, Error *error);
} TrainKind;

/* The row of the option of kinds that use train_pieces(). No kind reads its value, and no network stores it. */
#define TRAIN_SHARD                                                                                            \
    "--shard", 0, "I/N",                                                                                       \
        "Only record share I of N of the first round's launches and the held-out ones, which do not need the " \
        "network; "                                                                                            \
        "'twinbox merge' reads them and trains (default: as Slurm or MPI says, or all)",                       \
        .read = NULL

#define TRAIN_KIND_DECLARED(name) extern const TrainKind train_##name;
TRAIN_KINDS(TRAIN_KIND_DECLARED)
#undef TRAIN_KIND_DECLARED

/* All kinds, ended by NULL. */
extern const TrainKind *const train_kinds[];

/* The kind's option of that name ("--seed"), or -1. */
int train_find_option(const TrainKind *kind, const char *name);

/* Reads the values into the Options of the kind. */
bool train_read(const TrainRequest *request, void *options, Error *error);

/* Sets the text of an option; NULL: as if it were not given. */
void train_set(TrainRequest *request, const char *option, const char *value);

/* Takes the value of --shard, or the environment's, if the kind has the option. */
bool train_take_shard(TrainRequest *request, int argc, char **argv, Error *error);
bool train_is_shard(const TrainRequest *request);

/* What a training records before it has a network, in pieces: opens them, and does those of a shard, or checks those of a merge.
   The whole training does no piece: pieces->mode tells. */
bool train_pieces(const TrainRequest *request, const PiecePlan *plan, Pieces *pieces, Error *error);

/* Of a text for train_describe(). */
enum { TRAIN_COMMAND_SIZE = 2048 };

/* The command line that trains the same network again, to be stored in it. */
void train_describe(const TrainRequest *request, char *command, size_t size);
