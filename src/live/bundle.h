/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A bundle: named pieces of bytes, one behind the other: size of the name with its NUL, size of the data (32 bits each,
   little-endian), name, data. Pieces may be bundles themselves.

   That of a page has a piece "scene", the tree of its file (its pieces: path, text, nodes, texts), and one for each
   network, named by its path: a bundle of the members of the .npz, not deflated. So the module needs no parser, no zip
   and no inflate. */
#pragma once
#include "base/base.h"
#include "base/yaml.h"

#include <stddef.h>

typedef struct Bundle {
    const unsigned char *at; /* the pieces that are left */
    size_t left;             /* bytes */
} Bundle;

typedef struct BundlePiece {
    const char *name;
    Bundle data;
} BundlePiece;

/* Takes the next piece. False at the end, or where the bundle is damaged: then left > 0. */
bool bundle_next(Bundle *bundle, BundlePiece *piece);

/* Whether it is pieces to its end. */
bool bundle_is_whole(Bundle bundle);

/* Finds the first piece of that name. */
bool bundle_find(Bundle bundle, const char *name, Bundle *data);

/* The words of a node in the piece `nodes`: kind, end, count, text, line, column. */
enum { BUNDLE_NODE_WORDS = 6 };

/* The tree of a scene; its path stays in the bundle. Whatever the bytes are, the tree is one that a reader can walk. On
   failure there is nothing to free. */
bool bundle_tree(YamlTree *tree, Bundle scene, Error *error);

/* Where npz_archive_open() finds networks from now on (module/npz_bundle.c). */
void bundle_use(Bundle bundle);
