/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads bundles. */
#include "live/bundle.h"

#include "base/base.h"
#include "base/yaml.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static uint32_t word_at(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

bool bundle_next(Bundle *bundle, BundlePiece *piece) {
    enum { HEAD = 8 };
    if (bundle->left < HEAD) return false;
    const size_t name = word_at(bundle->at), data = word_at(bundle->at + 4), left = bundle->left - HEAD;
    if (name == 0 || name > left || data > left - name || bundle->at[HEAD + name - 1] != '\0') return false;
    piece->name = (const char *)bundle->at + HEAD;
    piece->data = (Bundle){bundle->at + HEAD + name, data};
    *bundle = (Bundle){bundle->at + HEAD + name + data, left - name - data};
    return true;
}

bool bundle_is_whole(Bundle bundle) {
    BundlePiece piece;
    while (bundle_next(&bundle, &piece)) continue;
    return bundle.left == 0;
}

bool bundle_find(Bundle bundle, const char *name, Bundle *data) {
    BundlePiece piece;
    while (bundle_next(&bundle, &piece)) {
        if (strcmp(piece.name, name) != 0) continue;
        *data = piece.data;
        return true;
    }
    return false;
}

/* The parts of a packed tree. */
typedef struct Parts {
    Bundle path, text, nodes, texts;
} Parts;

static bool find_parts(Bundle scene, Parts *parts) {
    const struct {
        const char *name;
        Bundle *data;
        bool ends; /* by a NUL */
    } table[] = {{"path", &parts->path, true},
                 {"text", &parts->text, true},
                 {"nodes", &parts->nodes, false},
                 {"texts", &parts->texts, true}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const Bundle *data = table[i].data;
        if (!bundle_find(scene, table[i].name, table[i].data)) return false;
        if (table[i].ends && (data->left == 0 || data->at[data->left - 1] != '\0')) return false;
    }
    return parts->text.left <= SOURCE_MAX_SIZE + 1 && parts->texts.left <= INT32_MAX;
}

/* A list or mapping that is open while nodes are checked. */
typedef struct Open {
    const YamlNode *node;
    int children;
} Open;

static bool close_is_sound(const Open *open) {
    const int per_item = open->node->kind == YAML_MAPPING ? 2 : 1;
    return open->children % per_item == 0 && open->children / per_item == open->node->count;
}

/* Whether a reader can walk the tree. */
static bool nodes_are_sound(const YamlTree *tree, const Parts *parts) {
    const int size = (int)parts->text.left;
    Open open[YAML_MAX_DEPTH + 1];
    int depth = 0;
    for (int i = 0; i < tree->node_count; i++) {
        const YamlNode *node = &tree->nodes[i];
        while (depth > 0 && open[depth - 1].node->end == i)
            if (!close_is_sound(&open[--depth])) return false;
        if (depth == 0 && i > 0) return false;
        const int limit = depth > 0 ? open[depth - 1].node->end : tree->node_count; /* of what it is in */
        const Place *place = &node->place;
        if (place->line < 0 || place->line > size || place->column < 0 || place->column > size || node->end <= i ||
            node->end > limit)
            return false;
        if (depth > 0) open[depth - 1].children++;
        if (node->kind == YAML_SCALAR) {
            if (node->end != i + 1 || node->text < 0 || (size_t)node->text >= parts->texts.left) return false;
            continue;
        }
        if ((node->kind != YAML_SEQUENCE && node->kind != YAML_MAPPING) || depth == YAML_MAX_DEPTH) return false;
        open[depth++] = (Open){node, 0};
    }
    while (depth > 0)
        if (!close_is_sound(&open[--depth])) return false;
    return tree->nodes[0].end == tree->node_count;
}

static void *copy(Bundle data) {
    void *bytes = malloc(data.left);
    if (bytes != NULL) memcpy(bytes, data.at, data.left);
    return bytes;
}

bool bundle_tree(YamlTree *tree, Bundle scene, Error *error) {
    Parts parts;
    *tree = (YamlTree){.node_count = 0};
    if (!find_parts(scene, &parts)) return error_input(error, "bundle", "its scene is damaged");
    const size_t count = parts.nodes.left / (4 * BUNDLE_NODE_WORDS);
    if (count < 1 || count > YAML_MAX_NODES || parts.nodes.left % (4 * BUNDLE_NODE_WORDS) != 0)
        return error_input(error, "bundle", "its scene is damaged");

    /* Copies, because the tree of a file owns its parts. */
    tree->node_count = (int)count;
    tree->source = (Source){(const char *)parts.path.at, copy(parts.text), parts.text.left - 1};
    tree->texts = copy(parts.texts);
    tree->nodes = malloc(count * sizeof *tree->nodes);
    bool ok =
        (tree->source.text != NULL && tree->texts != NULL && tree->nodes != NULL) || error_memory(error, "bundle");
    for (size_t i = 0; ok && i < count; i++) {
        int32_t words[BUNDLE_NODE_WORDS];
        for (size_t k = 0; k < BUNDLE_NODE_WORDS; k++) {
            const uint32_t word = word_at(parts.nodes.at + 4 * (i * BUNDLE_NODE_WORDS + k));
            memcpy(&words[k], &word, sizeof word);
        }
        tree->nodes[i] = (YamlNode){(YamlKind)words[0], words[1], words[2], words[3], {words[4], words[5]}};
    }
    ok = ok && (nodes_are_sound(tree, &parts) || error_input(error, "bundle", "the tree of its scene is damaged"));
    if (!ok) yaml_tree_free(tree);
    return ok;
}
