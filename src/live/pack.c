/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the bundle of a page: the tree of a scene, and networks (live/bundle.h). */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "base/yaml.h"
#include "live/bundle.h"
#include "live/live.h"
#include "methods/methods.h"
#include "scenes/scenes.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

LiveModule live_module(bool networks) {
    return networks ? (LiveModule){live_networks_wasm, live_networks_wasm_size}
                    : (LiveModule){live_plain_wasm, live_plain_wasm_size};
}

bool live_has_method(const MethodDescription *description) {
#define LIVE(entry) entry,
#define LIVE_NETWORK(entry) entry,
#define NOT_LIVE(entry)
#define SOLVER_LISTED(name, where) where(&solver_##name.description)
#define STEPPING_LISTED(name, where) where(&stepping_##name.description)
    const MethodDescription *const methods[] = {METHODS(SOLVER_LISTED, STEPPING_LISTED)};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        if (methods[i] == description) return true;
    return false;
}

/* A bundle that grows; `failed`: memory was short, and nothing is added any more. */
typedef struct Writer {
    char *bytes;
    size_t size, capacity;
    bool failed;
} Writer;

static char *put(Writer *writer, const void *data, size_t size) {
    void *bytes = writer->bytes;
    writer->failed = writer->failed || size > UINT32_MAX - writer->size ||
                     !array_reserve(&bytes, &writer->capacity, writer->size + size + 1, 1);
    if (writer->failed) return NULL;
    writer->bytes = bytes;
    char *place = writer->bytes + writer->size;
    if (data != NULL && size > 0) memcpy(place, data, size);
    writer->size += size;
    return place;
}

static void put_word(Writer *writer, uint32_t word) {
    const unsigned char bytes[] = {(unsigned char)word, (unsigned char)(word >> 8), (unsigned char)(word >> 16),
                                   (unsigned char)(word >> 24)};
    put(writer, bytes, sizeof bytes);
}

/* Room for the data of a piece, or the data itself. */
static char *put_piece(Writer *writer, const char *name, const void *data, size_t size) {
    put_word(writer, (uint32_t)strlen(name) + 1);
    put_word(writer, (uint32_t)size);
    put(writer, name, strlen(name) + 1);
    return put(writer, data, size);
}

static void put_tree(Writer *writer, const YamlTree *tree) {
    Writer scene = {0}, nodes = {0};
    for (int i = 0; i < tree->node_count; i++) {
        const YamlNode *node = &tree->nodes[i];
        const int words[BUNDLE_NODE_WORDS] = {(int)node->kind, node->end,        node->count,
                                              node->text,      node->place.line, node->place.column};
        for (int k = 0; k < BUNDLE_NODE_WORDS; k++) put_word(&nodes, (uint32_t)words[k]);
    }
    int last = tree->node_count - 1; /* the texts of scalars lie in the order of the nodes */
    while (last > 0 && tree->nodes[last].kind != YAML_SCALAR) last--;
    put_piece(&scene, "path", tree->source.path, strlen(tree->source.path) + 1);
    put_piece(&scene, "text", tree->source.text, tree->source.size + 1);
    put_piece(&scene, "nodes", nodes.bytes, nodes.size);
    put_piece(&scene, "texts", tree->texts, (size_t)tree->nodes[last].text + strlen(yaml_text(tree, last)) + 1);
    writer->failed = writer->failed || nodes.failed || scene.failed;
    put_piece(writer, "scene", scene.bytes, scene.size);
    free(scene.bytes);
    free(nodes.bytes);
}

/* A network that twinbox reads has been opened before, so its arrays are within their budget. */
static bool put_network(Writer *writer, const char *name, const char *path, Error *error) {
    uint64_t size;
    Writer members = {0};
    NpzFile *checked = npz_open(path, error);
    NpzArchive *archive = checked != NULL ? npz_archive_open(path, &size, error) : NULL;
    bool ok = archive != NULL;
    for (int64_t i = 0; ok && i < npz_archive_count(archive); i++) {
        /* The name of a member is overwritten when the next one is asked for. */
        const char *member = npz_archive_name(archive, i, error);
        ok = member != NULL && npz_archive_check(archive, i, member, &size, error);
        char *data = ok && size <= UINT32_MAX ? put_piece(&members, member, NULL, (size_t)size) : NULL;
        if (ok && data == NULL) ok = error_memory(error, path);
        ok = ok && npz_archive_read(archive, i, member, 0, data, size, error);
    }
    if (ok) put_piece(writer, name, members.bytes, members.size);
    npz_archive_close(archive);
    npz_close(checked);
    free(members.bytes);
    return ok;
}

/* The scene as the program reads it, and as the module does: without a folder. */
typedef struct Views {
    Scene *here, *there;
} Views;

/* Networks that methods need, each once. A setting names a file from where the program was started, a scene one that is
   relative to its own. */
static bool put_network_of(Writer *writer, const Views *views, const char *text, Error *error) {
    Method method;
    if (!method_parse(&method, text, error)) return false;
    const MethodDescription *description = method.kind->description;
    if (!live_has_method(description))
        return error_input(error, text, "a page cannot run this method; it can show recorded runs of it");
    if (!description->needs_network) return true;
    const char *path = method_network(&method.settings, views->here, description->name, error);
    if (path == NULL) return false;
    const bool set = settings_get(&method.settings, "network") != NULL;
    const char *there = set ? path : scene_network(views->there, description->name);
    const Bundle packed = {(const unsigned char *)writer->bytes, writer->size};
    Bundle found;
    return there != NULL && (bundle_find(packed, there, &found) || put_network(writer, there, path, error));
}

bool live_pack(const char *scene, const char *const *methods, int count, void **bundle, size_t *size, Error *error) {
    Writer writer = {0};
    YamlTree tree;
    if (!yaml_read(&tree, scene, error)) return false;
    Views views = {.here = scene_of_tree(&tree, NULL, 0, error)};
    tree.source.path = path_is_standard(scene) ? scene : scene + file_folder_length(scene);
    views.there = views.here != NULL ? scene_of_tree(&tree, NULL, 0, error) : NULL;
    bool ok = views.there != NULL;
    if (ok) put_tree(&writer, &tree);
    for (int i = 0; ok && i < count; i++) ok = put_network_of(&writer, &views, methods[i], error);
    ok = ok && (!writer.failed || error_memory(error, scene));
    scene_destroy(views.here);
    scene_destroy(views.there);
    yaml_tree_free(&tree);
    if (!ok) {
        free(writer.bytes);
        return false;
    }
    *bundle = writer.bytes;
    *size = writer.size;
    return true;
}
