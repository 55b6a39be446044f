/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory files: .npz with version, kind ("hybrid"), scene, command, body_count, bomb, launches, set_hash, set_contacts
   [sets], entry_set [entries], near [entries, TABULATION_NEAR], and as float32, with the shapes of tabulation.h: gate,
   tolerance, centre, rows, keys, metrics, reach, weights [entries, TABULATION_NEAR key_size], and impulses [all
   contacts, 2] entry after entry. */
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/tabulation.h"
#include "nets/nets.h"

#include <stdlib.h>
#include <string.h>

#define KIND "hybrid"

enum { HEAD_ARRAYS = 11, FLOAT_ARRAYS = 9, FIRST_OF_ENTRIES = 4 };

/* What the file holds, before it becomes a memory. */
typedef struct Contents {
    int64_t sets, entries, impulses;
    uint64_t *set_hash;
    int32_t *set_contacts, *entry_set, *near;
    float *keys, *metrics, *reach, *weights, *pushes;
} Contents;

/* One list for writing and reading. */
static void list_floats(const Tabulation *memory, const Contents *contents, FileFloats list[FLOAT_ARRAYS]) {
    const int64_t key = memory->key_size, entries = contents->entries;
    float *gate = (float *)&memory->gate, *tolerance = (float *)&memory->tolerance; /* only the reader writes */
    const FileFloats all[FLOAT_ARRAYS] = {
        {"gate", 0, {0}, gate, &float_not_negative},
        {"tolerance", 0, {0}, tolerance, &float_positive},
        {"centre", 1, {memory->numbers}, memory->centre, &float_any},
        {"rows", 2, {memory->numbers, memory->components}, memory->rows, &float_any},
        {"keys", 2, {entries, key}, contents->keys, &float_any},
        {"metrics", 2, {entries, memory->metric_size}, contents->metrics, &float_any},
        {"reach", 1, {entries}, contents->reach, &float_not_negative},
        {"weights", 2, {entries, TABULATION_NEAR * key}, contents->weights, &float_any},
        {"impulses", 2, {contents->impulses, 2}, contents->pushes, &float_any},
    };
    memcpy(list, all, sizeof all);
}

bool tabulation_write(const Tabulation *memory, const char *path, Error *error) {
    if (memory->entry_count == 0) return error_input(error, path, "the memory is empty: there is nothing to write");
    const int32_t version = TABULATION_VERSION, body_count = memory->body_count, bomb = memory->bomb,
                  launches = memory->launches;
    const Contents contents = {.sets = memory->set_count,
                               .entries = memory->entry_count,
                               .impulses = (int64_t)memory->impulse_count,
                               .keys = memory->keys,
                               .metrics = memory->metrics,
                               .reach = memory->reach,
                               .weights = memory->weights,
                               .pushes = &memory->impulses->normal};
    NpzArray arrays[HEAD_ARRAYS + FLOAT_ARRAYS] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = KIND},
        {.name = "scene", .type = NPZ_TEXT, .data = memory->scene},
        {.name = "command", .type = NPZ_TEXT, .data = memory->command},
        {.name = "body_count", .type = NPZ_INT32, .data = &body_count},
        {.name = "bomb", .type = NPZ_INT32, .data = &bomb},
        {.name = "launches", .type = NPZ_INT32, .data = &launches},
        {.name = "set_hash", .type = NPZ_UINT64, .rank = 1, .shape = {contents.sets}, .data = memory->set_hash},
        {.name = "set_contacts", .type = NPZ_INT32, .rank = 1, .shape = {contents.sets}, .data = memory->set_contacts},
        {.name = "entry_set", .type = NPZ_INT32, .rank = 1, .shape = {contents.entries}, .data = memory->entry_set},
        {.name = "near",
         .type = NPZ_INT32,
         .rank = 2,
         .shape = {contents.entries, TABULATION_NEAR},
         .data = memory->near},
    };
    FileFloats floats[FLOAT_ARRAYS];
    list_floats(memory, &contents, floats);
    for (int i = 0; i < FLOAT_ARRAYS; i++) arrays[HEAD_ARRAYS + i] = file_floats_array(&floats[i]);
    return npz_write(path, arrays, HEAD_ARRAYS + FLOAT_ARRAYS, error);
}

static bool read_int(NpzFile *file, const char *name, int *number, Error *error) {
    int32_t stored;
    if (!npz_read_scalar(file, name, NPZ_INT32, &stored, sizeof stored, error)) return false;
    *number = stored;
    return true;
}

static bool check_count(const NpzFile *file, const char *what, int64_t count, int64_t most, Error *error) {
    return (count >= 1 && count <= most) ||
           error_input(error, npz_path(file), "%lld %s; expected 1 to %lld", (long long)count, what, (long long)most);
}

static Tabulation *read_shape(NpzFile *file, Contents *contents, Error *error) {
    int bodies, bomb;
    int64_t rows[2], pushes[2];
    if (!read_int(file, "body_count", &bodies, error) || !read_int(file, "bomb", &bomb, error) ||
        !npz_shape(file, "rows", NPZ_FLOAT32, 2, rows, error) ||
        !npz_shape(file, "set_hash", NPZ_UINT64, 1, &contents->sets, error) ||
        !npz_shape(file, "entry_set", NPZ_INT32, 1, &contents->entries, error) ||
        !npz_shape(file, "impulses", NPZ_FLOAT32, 2, pushes, error) ||
        !check_count(file, "components", rows[1], TABULATION_COMPONENTS_MAX, error) ||
        !check_count(file, "entries", contents->entries, TABULATION_ENTRIES_MAX, error) ||
        !check_count(file, "sets of contacts", contents->sets, contents->entries, error) ||
        !check_count(file, "impulses", pushes[0], contents->entries * TABULATION_CONTACTS_MAX, error))
        return NULL;
    contents->impulses = pushes[0];
    if (bodies < 2 || bodies > TABULATION_BODIES_MAX || rows[0] != TABULATION_NUMBERS * ((int64_t)bodies - 1)) {
        error_input(error, npz_path(file),
                    "body_count is %d and rows has %lld rows; expected 2 to %d bodies and %d rows "
                    "for each body but the bomb",
                    bodies, (long long)rows[0], TABULATION_BODIES_MAX, TABULATION_NUMBERS);
        return NULL;
    }
    if (bomb < 0 || bomb >= bodies) {
        error_input(error, npz_path(file), "bomb is %d; expected 0 to %d", bomb, bodies - 1);
        return NULL;
    }
    return tabulation_create(bodies, bomb, (int)rows[1], error);
}

static void free_contents(Contents *contents) {
    free(contents->set_hash);
    free(contents->set_contacts);
    free(contents->entry_set);
    free(contents->near);
    free(contents->keys);
    free(contents->metrics);
    free(contents->reach);
    free(contents->weights);
    free(contents->pushes);
}

static bool read_contents(NpzFile *file, Tabulation *memory, Contents *contents, Error *error) {
    const size_t entries = (size_t)contents->entries, key = (size_t)memory->key_size;
    const int64_t near[2] = {contents->entries, TABULATION_NEAR};
    FileFloats floats[FLOAT_ARRAYS];
    list_floats(memory, contents, floats);
    /* Before memory is taken for what only some of the shapes tell. */
    if (!file_floats_expect(file, floats, FLOAT_ARRAYS, error)) return false;
    contents->keys = malloc(entries * key * sizeof(float));
    contents->metrics = malloc(entries * (size_t)memory->metric_size * sizeof(float));
    contents->reach = malloc(entries * sizeof(float));
    contents->weights = malloc(entries * TABULATION_NEAR * key * sizeof(float));
    contents->pushes = malloc((size_t)contents->impulses * 2 * sizeof(float));
    if (contents->keys == NULL || contents->metrics == NULL || contents->reach == NULL || contents->weights == NULL ||
        contents->pushes == NULL)
        return error_memory(error, npz_path(file));
    list_floats(memory, contents, floats);
    contents->set_hash = npz_read(file, "set_hash", NPZ_UINT64, 1, &contents->sets, error);
    return contents->set_hash != NULL &&
           (contents->set_contacts = npz_read(file, "set_contacts", NPZ_INT32, 1, &contents->sets, error)) != NULL &&
           (contents->entry_set = npz_read(file, "entry_set", NPZ_INT32, 1, &contents->entries, error)) != NULL &&
           (contents->near = npz_read(file, "near", NPZ_INT32, 2, near, error)) != NULL &&
           file_floats_read(file, floats, FLOAT_ARRAYS, error) &&
           read_int(file, "launches", &memory->launches, error) &&
           npz_read_name(file, "scene", memory->scene, sizeof memory->scene, error) &&
           npz_read_text(file, "command", memory->command, sizeof memory->command, error);
}

static bool add_sets(const NpzFile *file, Tabulation *memory, const Contents *contents, Error *error) {
    for (int64_t i = 0; i < contents->sets; i++) {
        const int contacts = contents->set_contacts[i];
        if (contacts < 0 || contacts > TABULATION_CONTACTS_MAX)
            return error_input(error, npz_path(file), "set_contacts: number %lld is %d; expected 0 to %d", (long long)i,
                               contacts, TABULATION_CONTACTS_MAX);
        if (tabulation_set(memory, contents->set_hash[i], contacts) >= 0)
            return error_input(error, npz_path(file), "set_hash: number %lld is there twice", (long long)i);
        if (tabulation_add_set(memory, contents->set_hash[i], contacts) < 0) return error_memory(error, npz_path(file));
    }
    return true;
}

/* The entries' neighbours are of their own sets, and the impulses are as many as the contacts. */
static bool check_entries(const NpzFile *file, const Contents *contents, Error *error) {
    int64_t impulses = 0;
    for (int64_t i = 0; i < contents->entries; i++) {
        const int32_t set = contents->entry_set[i];
        if (set < 0 || set >= contents->sets)
            return error_input(error, npz_path(file), "entry_set: number %lld is %d; expected 0 to %lld", (long long)i,
                               (int)set, (long long)contents->sets - 1);
        impulses += contents->set_contacts[set];
    }
    if (impulses != contents->impulses)
        return error_input(error, npz_path(file), "%lld impulses; the entries have %lld contacts",
                           (long long)contents->impulses, (long long)impulses);
    for (int64_t i = 0; i < contents->entries * TABULATION_NEAR; i++) {
        const int32_t near = contents->near[i];
        if (near < -1 || near >= contents->entries ||
            (near >= 0 && contents->entry_set[near] != contents->entry_set[i / TABULATION_NEAR]))
            return error_input(error, npz_path(file), "near: number %lld is %d, which is no entry of the same contacts",
                               (long long)i, (int)near);
    }
    return true;
}

static bool add_entries(Tabulation *memory, const Contents *contents, Error *error) {
    const size_t key = (size_t)memory->key_size;
    const ContactImpulse *pushes = (const ContactImpulse *)contents->pushes;
    for (size_t i = 0; i < (size_t)contents->entries; i++) {
        const int set = contents->entry_set[i];
        const TabulationQuery query = {memory->set_hash[set], memory->set_contacts[set], contents->keys + i * key};
        const TabulationEntry entry = {pushes, contents->near + i * TABULATION_NEAR,
                                       contents->weights + i * TABULATION_NEAR * key,
                                       contents->metrics + i * (size_t)memory->metric_size, contents->reach[i]};
        if (!tabulation_add(memory, &query, &entry, error)) return false;
        pushes += query.contacts;
    }
    return true;
}

static Tabulation *read_memory(NpzFile *file, Error *error) {
    Contents contents = {0};
    if (!npz_check_kind(file, KIND, TABULATION_VERSION, error)) return NULL;
    Tabulation *memory = read_shape(file, &contents, error);
    const bool ok = memory != NULL && read_contents(file, memory, &contents, error) &&
                    add_sets(file, memory, &contents, error) && check_entries(file, &contents, error) &&
                    add_entries(memory, &contents, error);
    free_contents(&contents);
    if (ok) return memory;
    tabulation_destroy(memory);
    return NULL;
}

Tabulation *tabulation_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    Tabulation *memory = read_memory(file, error);
    npz_close(file);
    return memory;
}
