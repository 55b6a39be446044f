/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of memories: kind "hybrid". The impulses are those of all contacts, entry after entry. */
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/hybrid_memory.h"
#include "nets/nets.h"

#include <stdlib.h>
#include <string.h>

/* What the file holds, beside or before it becomes a memory. */
typedef struct Contents {
    HybridMemory *memory;
    int64_t sets, entries, impulses;
    uint64_t *set_hash; /* the block of a reader begins here */
    int32_t *set_contacts, *entry_set, *near;
    float *keys, *metrics, *reach, *weights, *pushes;
} Contents;

static int list_fields(void *of, NetField *fields) {
    const Contents *contents = of;
    HybridMemory *memory = contents->memory;
    const int64_t key = memory->key_size, entries = contents->entries;
    const NetField all[] = {
        {"scene", NPZ_TEXT, 0, {sizeof memory->scene}, .data = memory->scene, .shown = true},
        {"command", NPZ_TEXT, 0, {sizeof memory->command}, .data = memory->command},
        {"body_count", NPZ_INT32, 0, {0}, .data = &memory->body_count, .known = true},
        {"bomb", NPZ_INT32, 0, {0}, .data = &memory->bomb, .known = true},
        {"launches", NPZ_INT32, 0, {0}, .data = &memory->launches},
        {"set_hash", NPZ_UINT64, 1, {contents->sets}, .data = contents->set_hash},
        {"set_contacts", NPZ_INT32, 1, {contents->sets}, .data = contents->set_contacts},
        {"entry_set", NPZ_INT32, 1, {entries}, .data = contents->entry_set},
        {"near", NPZ_INT32, 2, {entries, HYBRID_NEAR}, .data = contents->near},
        {"gate", NPZ_FLOAT32, 0, {0}, .data = &memory->gate, .range = &float_not_negative},
        {"tolerance", NPZ_FLOAT32, 0, {0}, .data = &memory->tolerance, .range = &float_positive},
        {"centre", NPZ_FLOAT32, 1, {memory->numbers}, .data = memory->centre, .range = &float_any},
        {"rows", NPZ_FLOAT32, 2, {memory->numbers, memory->components}, .data = memory->rows, .range = &float_any},
        {"keys", NPZ_FLOAT32, 2, {entries, key}, .data = contents->keys, .range = &float_any},
        {"metrics", NPZ_FLOAT32, 2, {entries, memory->metric_size}, .data = contents->metrics, .range = &float_any},
        {"reach", NPZ_FLOAT32, 1, {entries}, .data = contents->reach, .range = &float_not_negative},
        {"weights", NPZ_FLOAT32, 2, {entries, HYBRID_NEAR * key}, .data = contents->weights, .range = &float_any},
        {"impulses", NPZ_FLOAT32, 2, {contents->impulses, 2}, .data = contents->pushes, .range = &float_any}};
    memcpy(fields, all, sizeof all);
    return sizeof all / sizeof *all;
}

static bool check_count(const NpzFile *file, const char *what, int64_t count, int64_t most, Error *error) {
    return (count >= 1 && count <= most) ||
           error_input(error, npz_path(file), "%lld %s; expected 1 to %lld", (long long)count, what, (long long)most);
}

static bool read_sizes(void *of, NpzFile *file, Error *error) {
    Contents *contents = of;
    int bodies, bomb;
    int64_t rows[2], pushes[2];
    if (!net_file_integer(file, "body_count", &bodies, error) || !net_file_integer(file, "bomb", &bomb, error) ||
        !npz_shape(file, "rows", NPZ_FLOAT32, 2, rows, error) ||
        !npz_shape(file, "set_hash", NPZ_UINT64, 1, &contents->sets, error) ||
        !npz_shape(file, "entry_set", NPZ_INT32, 1, &contents->entries, error) ||
        !npz_shape(file, "impulses", NPZ_FLOAT32, 2, pushes, error) ||
        !check_count(file, "components", rows[1], HYBRID_COMPONENTS_MAX, error) ||
        !check_count(file, "entries", contents->entries, HYBRID_ENTRIES_MAX, error) ||
        !check_count(file, "sets of contacts", contents->sets, contents->entries, error) ||
        !check_count(file, "impulses", pushes[0], contents->entries * HYBRID_CONTACTS_MAX, error))
        return false;
    contents->impulses = pushes[0];
    if (bodies < 2 || bodies > HYBRID_BODIES_MAX || rows[0] != HYBRID_NUMBERS * ((int64_t)bodies - 1))
        return error_input(error, npz_path(file),
                           "body_count is %d and rows has %lld rows; expected 2 to %d bodies and %d rows "
                           "for each body but the bomb",
                           bodies, (long long)rows[0], HYBRID_BODIES_MAX, HYBRID_NUMBERS);
    if (bomb < 0 || bomb >= bodies)
        return error_input(error, npz_path(file), "bomb is %d; expected 0 to %d", bomb, bodies - 1);
    contents->memory = hybrid_memory_create(bodies, bomb, (int)rows[1], error);
    return contents->memory != NULL;
}

/* One block: the hashes, then integers, then floats. */
static bool make_block(void *of, Error *error) {
    Contents *contents = of;
    const HybridMemory *memory = contents->memory;
    const size_t sets = (size_t)contents->sets, entries = (size_t)contents->entries, key = (size_t)memory->key_size,
                 metric = (size_t)memory->metric_size, integers = sets + entries * (1 + HYBRID_NEAR),
                 floats = entries * (key + metric + 1 + HYBRID_NEAR * key) + 2 * (size_t)contents->impulses;
    contents->set_hash = malloc(sets * sizeof(uint64_t) + integers * sizeof(int32_t) + floats * sizeof(float));
    if (contents->set_hash == NULL) return error_memory(error, "hybrid");
    contents->set_contacts = (int32_t *)(contents->set_hash + sets);
    contents->entry_set = contents->set_contacts + sets;
    contents->near = contents->entry_set + entries;
    contents->keys = (float *)(contents->near + entries * HYBRID_NEAR);
    contents->metrics = contents->keys + entries * key;
    contents->reach = contents->metrics + entries * metric;
    contents->weights = contents->reach + entries;
    contents->pushes = contents->weights + entries * HYBRID_NEAR * key;
    return true;
}

/* Sets first; then the entries, whose neighbours are of their own sets, and whose contacts are as many as the
   impulses. */
static bool fill_memory(void *of, const char *path, Error *error) {
    const Contents *contents = of;
    HybridMemory *memory = contents->memory;
    const size_t key = (size_t)memory->key_size;
    int64_t impulses = 0;
    if (memory->launches < 0) return error_input(error, path, "launches is %d; expected at least 0", memory->launches);
    for (int64_t i = 0; i < contents->sets; i++) {
        const int contacts = contents->set_contacts[i];
        if (contacts < 0 || contacts > HYBRID_CONTACTS_MAX)
            return error_input(error, path, "set_contacts: number %lld is %d; expected 0 to %d", (long long)i, contacts,
                               HYBRID_CONTACTS_MAX);
        if (hybrid_memory_set(memory, contents->set_hash[i], contacts) >= 0)
            return error_input(error, path, "set_hash: number %lld is there twice", (long long)i);
        if (hybrid_memory_add_set(memory, contents->set_hash[i], contacts) < 0) return error_memory(error, path);
    }
    for (int64_t i = 0; i < contents->entries; i++) {
        const int32_t set = contents->entry_set[i];
        if (set < 0 || set >= contents->sets)
            return error_input(error, path, "entry_set: number %lld is %d; expected 0 to %lld", (long long)i, (int)set,
                               (long long)contents->sets - 1);
        impulses += contents->set_contacts[set];
    }
    if (impulses != contents->impulses)
        return error_input(error, path, "%lld impulses; the entries have %lld contacts", (long long)contents->impulses,
                           (long long)impulses);
    for (int64_t i = 0; i < contents->entries * HYBRID_NEAR; i++) {
        const int32_t near = contents->near[i];
        if (near < -1 || near >= contents->entries ||
            (near >= 0 && contents->entry_set[near] != contents->entry_set[i / HYBRID_NEAR]))
            return error_input(error, path, "near: number %lld is %d, which is no entry of the same contacts",
                               (long long)i, (int)near);
    }
    const ContactImpulse *pushes = (const ContactImpulse *)contents->pushes;
    for (size_t i = 0; i < (size_t)contents->entries; i++) {
        const int set = contents->entry_set[i];
        const HybridQuery query = {memory->set_hash[set], memory->set_contacts[set], contents->keys + i * key};
        const HybridEntry entry = {pushes, contents->near + i * HYBRID_NEAR, contents->weights + i * HYBRID_NEAR * key,
                                   contents->metrics + i * (size_t)memory->metric_size, contents->reach[i]};
        if (!hybrid_memory_add(memory, &query, &entry, error)) return false;
        pushes += query.contacts;
    }
    return true;
}

static const NetFileKind kind = {"hybrid", HYBRID_VERSION, list_fields, read_sizes, make_block, fill_memory};

bool hybrid_memory_write(const HybridMemory *memory, const char *path, Error *error) {
    if (memory->entry_count == 0) return error_input(error, path, "the memory is empty: there is nothing to write");
    const Contents contents = {(HybridMemory *)memory,
                               memory->set_count,
                               memory->entry_count,
                               (int64_t)memory->impulse_count,
                               memory->set_hash,
                               memory->set_contacts,
                               memory->entry_set,
                               memory->near,
                               memory->keys,
                               memory->metrics,
                               memory->reach,
                               memory->weights,
                               &memory->impulses->normal};
    return net_file_write(&kind, &contents, path, error);
}

HybridMemory *hybrid_memory_read(const char *path, Error *error) {
    Contents contents = {.memory = NULL};
    const bool ok = net_file_read(&kind, &contents, path, error);
    free(contents.set_hash);
    if (ok) return contents.memory;
    hybrid_memory_destroy(contents.memory);
    return NULL;
}
