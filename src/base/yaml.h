/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YAML files: their text with places for messages, their tree, and mappings that are read by tables of keys. */
#pragma once
#include "base/base.h"

/* The text of a YAML file, and messages that show a place in it, as a compiler does. */

enum { SOURCE_MAX_SIZE = 3 << 19 }; /* bytes: 157 for each of 10,000 bodies, one per line; patterns make more */

/* Line and column from 0, the column in characters, as libyaml counts them. */
typedef struct Place {
    int line, column;
} Place;

typedef struct Source {
    const char *path; /* as given by the user; not owned */
    char *text;       /* [size] and a NUL */
    size_t size;
} Source;

/* Sets an input error "path:line:column: error: text", the line, a caret; the message counts line and column from 1.
   Returns false. */
bool source_error(const Source *source, Place place, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* The byte at a place; beyond the end of a line, its end. */
size_t source_offset(const Source *source, Place place);

/* Copies UTF-8 text for a message: non-printable characters become '?', text that does not fit ends with "...". */
void source_printable(char *out, size_t room, const char *text);

/* A YAML file as a small tree: plain arrays, built from libyaml's events within fixed limits. It allows no aliases,
   anchors, tags or second documents. */

enum {
    YAML_MAX_DEPTH = 8,      /* nested lists and mappings */
    YAML_MAX_KEYS = 64,      /* of one mapping */
    YAML_MAX_NODES = 220000, /* 10,000 bodies with every key take 210,000 */
    YAML_SHOWN_SIZE = 48     /* room for a scalar in a message */
};

typedef enum YamlKind { YAML_SCALAR, YAML_SEQUENCE, YAML_MAPPING } YamlKind;

/* Nodes are in the order of the file: the first child of node n is n + 1, its next sibling is nodes[n].end. A mapping
   holds key, value, key, value. */
typedef struct YamlNode {
    YamlKind kind;
    int end;   /* the node after this one and all its descendants */
    int count; /* items of a sequence, pairs of a mapping */
    int text;  /* of a scalar: offset of its text in texts */
    Place place;
} YamlNode;

typedef struct YamlTree {
    Source source;
    int node_count;  /* >= 1; node 0 is the root */
    YamlNode *nodes; /* [node_count] */
    char *texts;     /* the scalars, each with a NUL */
    void *context;   /* for those who read values (FieldParser); NULL at first; not owned */
} YamlTree;

/* Reads the file. An error shows the place (source_error). On failure there is nothing to free. */
bool yaml_read(YamlTree *tree, const char *path, Error *error);
void yaml_tree_free(YamlTree *tree);

/* The text of a scalar. */
const char *yaml_text(const YamlTree *tree, int node);

/* A node for a message: the text of a scalar or "nothing", "a list", "a mapping". */
typedef struct YamlShown {
    char text[YAML_SHOWN_SIZE];
} YamlShown;
YamlShown yaml_show(const YamlTree *tree, int node);

/* Sets an input error at the place of a node, or at a byte of its text. Returns false. */
bool yaml_error(const YamlTree *tree, int node, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);
bool yaml_error_at(const YamlTree *tree, int node, size_t byte, Error *error, const char *format, ...)
    PRINTF_LIKE(5, 6);

/* Reads mappings of a YAML file by tables: each key with the parser of its value and the member that it fills. */

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
