/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rules of a comparison in memory. Only rules.c and rules_read.c include this. */
#pragma once
#include "regression/rules.h"
#include "yaml/yaml_tree.h"

typedef struct Rule {
    const char *files; /* a text of the tree */
    int node;          /* of `files` */
    Tolerance tolerance;
    Mask mask;
} Rule;

struct Rules {
    char *path;
    YamlTree tree; /* its context are these rules */
    int pictures;  /* of all masks */
    int count;
    Rule *rules; /* [count] */
};
