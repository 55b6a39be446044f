/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The memory of hybrid: sets of contacts, their entries, the search among them, and files of kind "hybrid". */
#include "methods/hybrid_memory.h"

#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "nets/nets.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_TABLE = 64 };

/* The set with this hash and number of contacts, or -1. */
static int find_set(const HybridMemory *memory, uint64_t hash, int contacts) {
    if (memory->table_size == 0) return -1;
    size_t at = (size_t)hash & (memory->table_size - 1);
    for (int set; (set = memory->table[at]) >= 0; at = (at + 1) & (memory->table_size - 1))
        if (memory->set_hash[set] == hash && memory->set_contacts[set] == contacts) return set;
    return -1;
}

static void put_into_table(HybridMemory *memory, int set) {
    size_t at = (size_t)memory->set_hash[set] & (memory->table_size - 1);
    while (memory->table[at] >= 0) at = (at + 1) & (memory->table_size - 1);
    memory->table[at] = set;
}

/* Takes in the next set, whose hash and number of contacts are in their arrays. False when memory is short. */
static bool take_set(HybridMemory *memory) {
    /* The table stays at most half full, so that searches are short. */
    if (2 * ((size_t)memory->set_count + 1) > memory->table_size) {
        const size_t size = memory->table_size > 0 ? 2 * memory->table_size : LEAST_TABLE;
        int32_t *table = malloc(size * sizeof *table);
        if (table == NULL) return false;
        free(memory->table);
        memory->table = table;
        memory->table_size = size;
        for (size_t i = 0; i < size; i++) table[i] = -1;
        for (int known = 0; known < memory->set_count; known++) put_into_table(memory, known);
    }
    memory->set_lists[memory->set_count] = (HybridList){0};
    put_into_table(memory, memory->set_count++);
    return true;
}

static float first_number(const HybridMemory *memory, int entry) {
    return memory->keys[(size_t)entry * (size_t)memory->key_size];
}

/* The place of the first entry with a number of at least `x`. */
static int place_of(const HybridMemory *memory, const HybridList *list, float x) {
    int low = 0, high = list->count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (first_number(memory, list->entries[middle]) < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Takes in the next entry, whose numbers are in their arrays: its impulses are those behind the last entry's, and it
   has its place in the list of its set by its first number. False when memory is short. */
static bool take_entry(HybridMemory *memory) {
    const int e = memory->entry_count, set = memory->entry_set[e];
    HybridList *list = &memory->set_lists[set];
    if (!array_reserve((void **)&list->entries, &list->capacity, (size_t)list->count + 1, sizeof *list->entries))
        return false;
    memory->entry_begin[e] = memory->impulse_count;
    memory->impulse_count += (size_t)memory->set_contacts[set];
    memory->entry_count++;
    const int place = place_of(memory, list, first_number(memory, e));
    for (int i = list->count++; i > place; i--) list->entries[i] = list->entries[i - 1];
    list->entries[place] = e;
    if (memory->reach[e] > list->reach) list->reach = memory->reach[e];
    return true;
}

const int32_t *hybrid_memory_about(const HybridMemory *memory, const HybridQuery *query, float radius, int *count) {
    const int set = find_set(memory, query->hash, query->contacts);
    *count = 0;
    if (set < 0) return NULL;
    const HybridList *list = &memory->set_lists[set];
    const int first = place_of(memory, list, query->key[0] - radius);
    int end = first;
    while (end < list->count && first_number(memory, list->entries[end]) <= query->key[0] + radius) end++;
    *count = end - first;
    return list->entries + first;
}

/* Keys, ellipsoids and answers of a memory (hybrid_memory.h). Sums run in a fixed order. */

/* A step of position correction removes this share of an overlap (engine/contact_problem.c). */
static const float push_out = 0.2f;

void hybrid_memory_numbers(const ProblemBody *body, float angle, float dt, float numbers[HYBRID_NUMBERS]) {
    const float rate = push_out / dt, arm = 0.25f * (body->size.x + body->size.y);
    numbers[0] = rate * body->position.x;
    numbers[1] = rate * body->position.y;
    numbers[2] = rate * arm * angle;
    numbers[3] = body->velocity.x;
    numbers[4] = body->velocity.y;
    numbers[5] = arm * body->angular_velocity;
}

void hybrid_memory_key(const HybridMemory *memory, const float *bomb, const float *others, float *key) {
    float away = 0, inside = 0, sums[HYBRID_COMPONENTS_MAX] = {0};
    for (int i = 0; i < HYBRID_NUMBERS; i++) key[i] = bomb[i];
    for (int i = 0; i < memory->numbers; i++) {
        const float from = others[i] - memory->centre[i],
                    *column = memory->rows + (size_t)i * (size_t)memory->components;
        away += from * from;
        for (int c = 0; c < memory->components; c++) sums[c] += from * column[c];
    }
    for (int c = 0; c < memory->components; c++) {
        key[HYBRID_NUMBERS + c] = sums[c];
        inside += sums[c] * sums[c];
    }
    key[HYBRID_NUMBERS + memory->components] = sqrtf(away > inside ? away - inside : 0);
}

/* product[i] = row i of M times `from`; returns from^T M from. */
static float apply(const HybridMemory *memory, int entry, const float *from, float *product) {
    const float *metric = memory->metrics + (size_t)entry * (size_t)memory->metric_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) product[i] = 0;
    for (int i = 0; i < memory->key_size; i++) {
        float own = 0;
        for (int j = 0; j < i; j++, metric++) {
            own += *metric * from[j];
            product[j] += *metric * from[i];
        }
        product[i] += own + *metric++ * from[i];
    }
    for (int i = 0; i < memory->key_size; i++) sum += product[i] * from[i];
    return sum;
}

/* key - x0; returns its squared length. */
static float take_away(const HybridMemory *memory, int entry, const float *key, float *from) {
    const float *centre = memory->keys + (size_t)entry * (size_t)memory->key_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) {
        from[i] = key[i] - centre[i];
        sum += from[i] * from[i];
    }
    return sum;
}

float hybrid_memory_distance(const HybridMemory *memory, int entry, const float *key) {
    float from[HYBRID_KEY_MAX] = {0}, product[HYBRID_KEY_MAX];
    take_away(memory, entry, key, from);
    return apply(memory, entry, from, product);
}

/* The most central of the entries, at most `least` from the query. */
static int search(const HybridMemory *memory, const HybridQuery *query, float radius, float least) {
    int count, best = -1;
    const int32_t *entries = hybrid_memory_about(memory, query, radius, &count);
    float from[HYBRID_KEY_MAX] = {0}, product[HYBRID_KEY_MAX];
    const bool inside = least <= 1;
    for (int i = 0; i < count; i++) {
        if (take_away(memory, entries[i], query->key, from) > memory->reach[entries[i]] && inside) continue;
        const float distance = apply(memory, entries[i], from, product);
        if (distance > least) continue;
        least = distance;
        best = entries[i];
    }
    return best;
}

int hybrid_memory_find(const HybridMemory *memory, const HybridQuery *query) {
    const int set = find_set(memory, query->hash, query->contacts);
    return set < 0 ? -1 : search(memory, query, sqrtf(memory->set_lists[set].reach), 1);
}

int hybrid_memory_nearest(const HybridMemory *memory, const HybridQuery *query, float radius) {
    return search(memory, query, radius, FLT_MAX);
}

void hybrid_memory_answer(const HybridMemory *memory, int entry, const float *key, ContactImpulse *impulses) {
    const size_t size = (size_t)memory->key_size;
    const int contacts = memory->set_contacts[memory->entry_set[entry]];
    const ContactImpulse *own = memory->impulses + memory->entry_begin[entry];
    float from[HYBRID_KEY_MAX] = {0};
    take_away(memory, entry, key, from);
    for (int i = 0; i < contacts; i++) impulses[i] = own[i];
    for (int n = 0; n < HYBRID_NEAR; n++) {
        const size_t row = (size_t)entry * HYBRID_NEAR + (size_t)n;
        const int32_t near = memory->near[row];
        if (near < 0) continue;
        const ContactImpulse *other = memory->impulses + memory->entry_begin[near];
        float share = 0;
        for (int i = 0; i < memory->key_size; i++) share += memory->weights[row * size + (size_t)i] * from[i];
        for (int i = 0; i < contacts; i++) {
            impulses[i].normal += share * (other[i].normal - own[i].normal);
            impulses[i].tangent += share * (other[i].tangent - own[i].tangent);
        }
    }
}

/* With y = M d and s = d^T M d: M' = M + (1 - s) / s^2 y y^T has d^T M' d = 1 and changes no direction that
   M-orthogonal to d has. For s > 1 this is the smallest ellipsoid that contains the old one and d (Pope 1997, 3.4). */
void hybrid_memory_stretch(HybridMemory *memory, int entry, const float *key) {
    float from[HYBRID_KEY_MAX] = {0}, product[HYBRID_KEY_MAX];
    const float length = take_away(memory, entry, key, from), distance = apply(memory, entry, from, product);
    if (!(distance > FLT_MIN)) return;
    const float factor = (1 - distance) / (distance * distance);
    float *metric = memory->metrics + (size_t)entry * (size_t)memory->metric_size;
    for (int i = 0; i < memory->key_size; i++)
        for (int j = 0; j <= i; j++) *metric++ += factor * product[i] * product[j];
    /* The inverse of M' is that of M plus (1 - 1 / s) d d^T. */
    if (distance > 1) memory->reach[entry] += (1 - 1 / distance) * length;
    HybridList *list = &memory->set_lists[memory->entry_set[entry]];
    if (memory->reach[entry] > list->reach) list->reach = memory->reach[entry];
}

void hybrid_memory_destroy(HybridMemory *memory) {
    if (memory == NULL) return;
    free(memory->centre);
    free(memory->rows);
    free(memory->set_hash);
    free(memory->set_contacts);
    for (int set = 0; set < memory->set_count; set++) free(memory->set_lists[set].entries);
    free(memory->set_lists);
    free(memory->entry_set);
    free(memory->entry_begin);
    free(memory->keys);
    free(memory->metrics);
    free(memory->reach);
    free(memory->near);
    free(memory->weights);
    free(memory->impulses);
    free(memory->table);
    free(memory);
}

HybridMemory *hybrid_memory_create(int body_count, int bomb, int components, Error *error) {
    if (body_count < 2 || body_count > HYBRID_BODIES_MAX || bomb < 0 || bomb >= body_count) {
        error_input(error, "hybrid", "%d bodies, of which %d is the bomb; expected 2 to %d", body_count, bomb,
                    HYBRID_BODIES_MAX);
        return NULL;
    }
    if (components < 1 || components > HYBRID_COMPONENTS_MAX)
        return error_input(error, "hybrid", "%d components; expected 1 to %d", components, HYBRID_COMPONENTS_MAX), NULL;
    HybridMemory *memory = calloc(1, sizeof *memory);
    if (memory == NULL) return error_memory(error, "hybrid"), NULL;
    memory->body_count = body_count;
    memory->bomb = bomb;
    memory->components = components;
    memory->numbers = HYBRID_NUMBERS * (body_count - 1);
    memory->key_size = HYBRID_NUMBERS + components + 1;
    memory->metric_size = memory->key_size * (memory->key_size + 1) / 2;
    memory->centre = calloc((size_t)memory->numbers, sizeof *memory->centre);
    memory->rows = calloc((size_t)components * (size_t)memory->numbers, sizeof *memory->rows);
    if (memory->centre != NULL && memory->rows != NULL) return memory;
    hybrid_memory_destroy(memory);
    error_memory(error, "hybrid");
    return NULL;
}

static size_t entry_size(const HybridMemory *memory) {
    const size_t key = (size_t)memory->key_size;
    return sizeof(float) * (key + (size_t)memory->metric_size + 1 + HYBRID_NEAR * key) +
           sizeof(int32_t) * (2 + HYBRID_NEAR) + sizeof(size_t);
}

size_t hybrid_memory_bytes(const HybridMemory *memory) {
    const size_t set = sizeof *memory->set_hash + sizeof(int32_t) + sizeof *memory->set_lists;
    return sizeof *memory + sizeof(float) * (size_t)memory->numbers * (size_t)(memory->components + 1) +
           set * (size_t)memory->set_count + sizeof(int32_t) * memory->table_size +
           entry_size(memory) * (size_t)memory->entry_count + sizeof *memory->impulses * memory->impulse_count;
}

size_t hybrid_memory_entry_bytes(const HybridMemory *memory, int contacts) {
    return entry_size(memory) + sizeof *memory->impulses * (size_t)contacts;
}

/* Gives an array that keeps its items room for `count` of `size` bytes. False when memory is short; the array stays
   valid. */
static bool resize(void **items, size_t count, size_t size) {
    void *grown = realloc(*items, count * size);
    if (grown == NULL) return false;
    *items = grown;
    return true;
}

/* At least doubled, so that adding costs O(1). */
static size_t room_for(size_t capacity, size_t wanted) {
    return wanted <= capacity ? capacity : wanted > 2 * capacity + 16 ? wanted : 2 * capacity + 16;
}

/* Room for so many. False when memory is short; the arrays stay valid. */
static bool reserve(HybridMemory *memory, size_t set_count, size_t entry_count, size_t impulse_count) {
    const size_t key = (size_t)memory->key_size, metric = (size_t)memory->metric_size,
                 sets = room_for(memory->set_capacity, set_count),
                 entries = room_for(memory->entry_capacity, entry_count),
                 impulses = room_for(memory->impulse_capacity, impulse_count);
    if (sets > memory->set_capacity && (!resize((void **)&memory->set_hash, sets, sizeof *memory->set_hash) ||
                                        !resize((void **)&memory->set_contacts, sets, sizeof *memory->set_contacts) ||
                                        !resize((void **)&memory->set_lists, sets, sizeof *memory->set_lists)))
        return false;
    memory->set_capacity = sets;
    if (entries > memory->entry_capacity &&
        (!resize((void **)&memory->entry_set, entries, sizeof *memory->entry_set) ||
         !resize((void **)&memory->entry_begin, entries, sizeof *memory->entry_begin) ||
         !resize((void **)&memory->keys, entries * key, sizeof *memory->keys) ||
         !resize((void **)&memory->metrics, entries * metric, sizeof *memory->metrics) ||
         !resize((void **)&memory->reach, entries, sizeof *memory->reach) ||
         !resize((void **)&memory->near, entries * HYBRID_NEAR, sizeof *memory->near) ||
         !resize((void **)&memory->weights, entries * HYBRID_NEAR * key, sizeof *memory->weights)))
        return false;
    memory->entry_capacity = entries;
    if (impulses > memory->impulse_capacity && !resize((void **)&memory->impulses, impulses, sizeof *memory->impulses))
        return false;
    memory->impulse_capacity = impulses;
    return true;
}

bool hybrid_memory_add(HybridMemory *memory, const HybridQuery *query, const HybridEntry *entry, Error *error) {
    const size_t key = (size_t)memory->key_size, metric = (size_t)memory->metric_size, e = (size_t)memory->entry_count,
                 contacts = (size_t)query->contacts;
    if (memory->entry_count >= HYBRID_ENTRIES_MAX ||
        !reserve(memory, (size_t)memory->set_count + 1, e + 1, memory->impulse_count + contacts))
        return error_memory(error, "hybrid");
    int set = find_set(memory, query->hash, query->contacts);
    if (set < 0) {
        set = memory->set_count;
        memory->set_hash[set] = query->hash;
        memory->set_contacts[set] = query->contacts;
        if (!take_set(memory)) return error_memory(error, "hybrid");
    }
    memory->entry_set[e] = set;
    memory->reach[e] = entry->reach;
    memcpy(memory->keys + e * key, query->key, key * sizeof *query->key);
    memcpy(memory->metrics + e * metric, entry->metric, metric * sizeof *entry->metric);
    memcpy(memory->near + e * HYBRID_NEAR, entry->near, HYBRID_NEAR * sizeof *entry->near);
    memcpy(memory->weights + e * HYBRID_NEAR * key, entry->weights, HYBRID_NEAR * key * sizeof(float));
    if (contacts > 0)
        memcpy(memory->impulses + memory->impulse_count, entry->impulses, contacts * sizeof *entry->impulses);
    return take_entry(memory) || error_memory(error, "hybrid");
}

/* Files of memories: kind "hybrid". The impulses are those of all contacts, entry after entry. */

/* How many the file has; the memory's arrays have them before it takes them in. */
typedef struct Contents {
    HybridMemory *memory;
    int64_t sets, entries, impulses;
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
        {"set_hash", NPZ_UINT64, 1, {contents->sets}, .data = memory->set_hash},
        {"set_contacts", NPZ_INT32, 1, {contents->sets}, .data = memory->set_contacts},
        {"entry_set", NPZ_INT32, 1, {entries}, .data = memory->entry_set},
        {"near", NPZ_INT32, 2, {entries, HYBRID_NEAR}, .data = memory->near},
        {"gate", NPZ_FLOAT32, 0, {0}, .data = &memory->gate, .range = &float_not_negative},
        {"tolerance", NPZ_FLOAT32, 0, {0}, .data = &memory->tolerance, .range = &float_positive},
        {"centre", NPZ_FLOAT32, 1, {memory->numbers}, .data = memory->centre, .range = &float_any},
        {"rows", NPZ_FLOAT32, 2, {memory->numbers, memory->components}, .data = memory->rows, .range = &float_any},
        {"keys", NPZ_FLOAT32, 2, {entries, key}, .data = memory->keys, .range = &float_any},
        {"metrics", NPZ_FLOAT32, 2, {entries, memory->metric_size}, .data = memory->metrics, .range = &float_any},
        {"reach", NPZ_FLOAT32, 1, {entries}, .data = memory->reach, .range = &float_not_negative},
        {"weights", NPZ_FLOAT32, 2, {entries, HYBRID_NEAR * key}, .data = memory->weights, .range = &float_any},
        {"impulses", NPZ_FLOAT32, 2, {contents->impulses, 2}, .data = memory->impulses, .range = &float_any}};
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

static bool make_arrays(void *of, Error *error) {
    const Contents *contents = of;
    return reserve(contents->memory, (size_t)contents->sets, (size_t)contents->entries, (size_t)contents->impulses) ||
           error_memory(error, "hybrid");
}

/* Sets first; then the entries, whose neighbours are of their own sets, and whose contacts are as many as the
   impulses. */
static bool take_all(void *of, const char *path, Error *error) {
    const Contents *contents = of;
    HybridMemory *memory = contents->memory;
    int64_t impulses = 0;
    if (memory->launches < 0) return error_input(error, path, "launches is %d; expected at least 0", memory->launches);
    for (int64_t i = 0; i < contents->sets; i++) {
        const int contacts = memory->set_contacts[i];
        if (contacts < 0 || contacts > HYBRID_CONTACTS_MAX)
            return error_input(error, path, "set_contacts: number %lld is %d; expected 0 to %d", (long long)i, contacts,
                               HYBRID_CONTACTS_MAX);
        if (find_set(memory, memory->set_hash[i], contacts) >= 0)
            return error_input(error, path, "set_hash: number %lld is there twice", (long long)i);
        if (!take_set(memory)) return error_memory(error, path);
    }
    for (int64_t i = 0; i < contents->entries; i++) {
        const int32_t set = memory->entry_set[i];
        if (set < 0 || set >= contents->sets)
            return error_input(error, path, "entry_set: number %lld is %d; expected 0 to %lld", (long long)i, (int)set,
                               (long long)contents->sets - 1);
        impulses += memory->set_contacts[set];
    }
    if (impulses != contents->impulses)
        return error_input(error, path, "%lld impulses; the entries have %lld contacts", (long long)contents->impulses,
                           (long long)impulses);
    for (int64_t i = 0; i < contents->entries * HYBRID_NEAR; i++) {
        const int32_t near = memory->near[i];
        if (near < -1 || near >= contents->entries ||
            (near >= 0 && memory->entry_set[near] != memory->entry_set[i / HYBRID_NEAR]))
            return error_input(error, path, "near: number %lld is %d, which is no entry of the same contacts",
                               (long long)i, (int)near);
    }
    for (int64_t i = 0; i < contents->entries; i++)
        if (!take_entry(memory)) return error_memory(error, path);
    return true;
}

static const NetFileKind kind = {"hybrid", HYBRID_VERSION, list_fields, read_sizes, make_arrays, take_all};

bool hybrid_memory_write(const HybridMemory *memory, const char *path, Error *error) {
    if (memory->entry_count == 0) return error_input(error, path, "the memory is empty: there is nothing to write");
    const Contents contents = {(HybridMemory *)memory, memory->set_count, memory->entry_count,
                               (int64_t)memory->impulse_count};
    return net_file_write(&kind, &contents, path, error);
}

HybridMemory *hybrid_memory_read(const char *path, Error *error) {
    Contents contents = {.memory = NULL};
    const bool ok = net_file_read(&kind, &contents, path, error);
    if (ok) return contents.memory;
    hybrid_memory_destroy(contents.memory);
    return NULL;
}
