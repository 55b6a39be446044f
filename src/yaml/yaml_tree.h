/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A YAML file as a small tree: plain arrays, built from libyaml's events within fixed limits. It allows no aliases, anchors,
   tags or second documents. */
#pragma once
#include "yaml/source.h"

#include <stdbool.h>

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

/* Sets an input error at the place of a node. Returns false. */
bool yaml_error(const YamlTree *tree, int node, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);
