/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of networks: .npz with version, kind, and the fields of the kind in the order of its list. Each kind names its
   fields once, for writing and for reading. */
#pragma once
#include "base/base.h"
#include "base/npz.h"

#include <stdbool.h>
#include <stdint.h>

/* The range of float32 numbers, which must be finite. */
typedef struct FloatBounds {
    float least, most;
    const char *words; /* "it must be ..." */
} FloatBounds;

extern const FloatBounds float_any, float_positive, float_not_negative, float_momentum;

typedef struct NetField {
    char name[24];
    NpzType type;
    int rank;
    int64_t shape[2]; /* of a text: the bytes of its array */
    void *data;       /* the network's array, at least of the shape's size; before it is created, its shape suffices */
    const FloatBounds *range; /* of float32; float64 must be finite */
    bool known;               /* only written: its reader is read_sizes */
    bool shown;               /* a text without control characters, as it is displayed */
} NetField;

enum { NET_FIELDS_MAX = 40 };

typedef struct NetFileKind {
    const char *name;
    int32_t version;
    int (*list)(void *net, NetField fields[NET_FIELDS_MAX]); /* returns their number */
    /* Reads what the shapes follow from, before memory is taken: a file can claim any shape. NULL: shapes are
       constant. */
    bool (*read_sizes)(void *net, NpzFile *file, Error *error);
    bool (*create)(void *net, Error *error);                  /* its arrays, once the file has all; NULL: they exist */
    bool (*check)(void *net, const char *path, Error *error); /* what is read; NULL: the ranges suffice */
} NetFileKind;

bool net_file_write(const NetFileKind *kind, const void *net, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another kind or version, or has a field of another shape or
   range. */
bool net_file_read(const NetFileKind *kind, void *net, const char *path, Error *error);

/* The field in the file. */
NpzArray net_field_array(const NetField *field);

/* Reads fields, after a look at all their shapes; an error names the file, the field and the number. */
bool net_fields_read(NpzFile *file, const NetField *fields, int count, Error *error);

/* For read_sizes: a vector of least to most int32 numbers, of which it returns the number, or 0 with error set; a
   scalar. */
int net_file_integers(NpzFile *file, const char *name, int least, int most, int32_t *numbers, Error *error);
bool net_file_integer(NpzFile *file, const char *name, int *number, Error *error);
