/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads mappings of a YAML file by tables: each key with the parser of its value and the member that it fills. */
#pragma once
#include "yaml/yaml_tree.h"

#include <stdbool.h>
#include <stddef.h>

enum { FIELDS_MAX = 16 };

/* The range of a number, ends included. */
typedef struct Range {
    float minimum, maximum;
    const char *unit;
} Range;

typedef struct Field Field;

/* Reads a value node into *member. */
typedef bool FieldParser(const YamlTree *tree, int node, const Field *field, void *member, Error *error);

struct Field {
    const char *key; /* NULL ends a table, which has at most FIELDS_MAX rows */
    FieldParser *parse;
    size_t offset;      /* of the member in the struct that the mapping describes */
    const Range *range; /* of a number; else NULL */
    bool required;
};

/* Reads a mapping into *target and stores the value's node of each field in `nodes`, 0 if the key is missing. Refused:
   a node that is not a mapping, and keys that are unknown (the message suggests the nearest), given twice or
   missing. */
bool fields_read(const YamlTree *tree, int node, const char *what, const Field *fields, void *target,
                 int nodes[FIELDS_MAX], Error *error);

/* The value's node of a key in the `nodes` of fields_read(), 0 if it is missing. */
int fields_node(const Field *fields, const int nodes[FIELDS_MAX], const char *key);

/* bool: true, false, on, off, yes, no. */
FieldParser field_switch;
