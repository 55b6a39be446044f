/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of network that `twinbox train` trains. To add a kind, write one file that defines train_NAME, and add one
   line KIND(NAME) here. */
#pragma once
#include "common/error.h"

#include <stdbool.h>
#include <stddef.h>

/* The first is the default of --kind. */
#define TRAIN_KINDS(KIND)   \
    KIND(pair_net)          \
    KIND(momentum_schedule) \
    KIND(scene_net)

typedef struct TrainOption {
    const char *name;     /* without dashes */
    const char *value;    /* what the help calls its value: "N"; NULL: a flag, whose value is "" */
    const char *standard; /* the value if it is not given; NULL: none */
    const char *help;
} TrainOption;

enum { TRAIN_OPTIONS_MAX = 32 };

/* What to train, as on the command line. */
typedef struct TrainRequest {
    const struct TrainKind *kind;
    const char *input, *output;
    const char *values[TRAIN_OPTIONS_MAX]; /* of the kind's options; NULL: neither given nor a standard */
} TrainRequest;

typedef struct TrainKind {
    const char *name, *input, *summary; /* input: what the help calls the file to train on */
    const TrainOption *options;         /* at most TRAIN_OPTIONS_MAX, ended by a NULL name; in the order of a command */
    bool (*train)(const TrainRequest *request, Error *error);
} TrainKind;

#define TRAIN_KIND_DECLARED(name) extern const TrainKind train_##name;
TRAIN_KINDS(TRAIN_KIND_DECLARED)
#undef TRAIN_KIND_DECLARED

/* All kinds, ended by NULL. */
extern const TrainKind *const train_kinds[];

/* The kind's option of that name, or -1. */
int train_find_option(const TrainKind *kind, const char *name);

/* The value of one of the kind's options; NULL if it has none. */
const char *train_value(const TrainRequest *request, const char *option);

/* Sets it; NULL: as if it were not given. */
void train_set(TrainRequest *request, const char *option, const char *value);

/* The command line that trains the same network again, to be stored in it. */
void train_describe(const TrainRequest *request, char *command, size_t size);
