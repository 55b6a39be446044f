/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulation/tabulation.h"

#include "tabulation/tabulation_sets.h"

#include <stdlib.h>
#include <string.h>

void tabulation_destroy(Tabulation *memory) {
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

Tabulation *tabulation_create(int body_count, int bomb, int components, Error *error) {
    if (body_count < 2 || body_count > TABULATION_BODIES_MAX || bomb < 0 || bomb >= body_count) {
        error_input(error, "hybrid", "%d bodies, of which %d is the bomb; expected 2 to %d", body_count, bomb,
                    TABULATION_BODIES_MAX);
        return NULL;
    }
    if (components < 1 || components > TABULATION_COMPONENTS_MAX) {
        error_input(error, "hybrid", "%d components; expected 1 to %d", components, TABULATION_COMPONENTS_MAX);
        return NULL;
    }
    Tabulation *memory = calloc(1, sizeof *memory);
    if (memory == NULL) {
        error_memory(error, "hybrid");
        return NULL;
    }
    memory->body_count = body_count;
    memory->bomb = bomb;
    memory->components = components;
    memory->numbers = TABULATION_NUMBERS * (body_count - 1);
    memory->key_size = TABULATION_NUMBERS + components + 1;
    memory->metric_size = memory->key_size * (memory->key_size + 1) / 2;
    memory->centre = calloc((size_t)memory->numbers, sizeof *memory->centre);
    memory->rows = calloc((size_t)components * (size_t)memory->numbers, sizeof *memory->rows);
    if (memory->centre != NULL && memory->rows != NULL) return memory;
    tabulation_destroy(memory);
    error_memory(error, "hybrid");
    return NULL;
}

static size_t entry_size(const Tabulation *memory) {
    const size_t key = (size_t)memory->key_size;
    return sizeof(float) * (key + (size_t)memory->metric_size + 1 + TABULATION_NEAR * key) +
           sizeof(int32_t) * (2 + TABULATION_NEAR) + sizeof(size_t);
}

size_t tabulation_bytes(const Tabulation *memory) {
    const size_t set = sizeof *memory->set_hash + sizeof(int32_t) + sizeof *memory->set_lists;
    return sizeof *memory + sizeof(float) * (size_t)memory->numbers * (size_t)(memory->components + 1) +
           set * (size_t)memory->set_count + sizeof(int32_t) * memory->table_size +
           entry_size(memory) * (size_t)memory->entry_count + sizeof *memory->impulses * memory->impulse_count;
}

size_t tabulation_entry_bytes(const Tabulation *memory, int contacts) {
    return entry_size(memory) + sizeof *memory->impulses * (size_t)contacts;
}

static bool reserve_entry(Tabulation *memory, int contacts) {
    const size_t key = (size_t)memory->key_size, impulses = memory->impulse_count + (size_t)contacts;
    if (impulses > memory->impulse_capacity) {
        if (!tabulation_resize((void **)&memory->impulses, 2 * impulses, sizeof *memory->impulses)) return false;
        memory->impulse_capacity = 2 * impulses;
    }
    if ((size_t)memory->entry_count < memory->entry_capacity) return true;
    const size_t count = 2 * memory->entry_capacity + 16;
    if (!tabulation_resize((void **)&memory->entry_set, count, sizeof *memory->entry_set) ||
        !tabulation_resize((void **)&memory->entry_begin, count, sizeof *memory->entry_begin) ||
        !tabulation_resize((void **)&memory->keys, count * key, sizeof *memory->keys) ||
        !tabulation_resize((void **)&memory->metrics, count * (size_t)memory->metric_size, sizeof *memory->metrics) ||
        !tabulation_resize((void **)&memory->reach, count, sizeof *memory->reach) ||
        !tabulation_resize((void **)&memory->near, count * TABULATION_NEAR, sizeof *memory->near) ||
        !tabulation_resize((void **)&memory->weights, count * TABULATION_NEAR * key, sizeof *memory->weights))
        return false;
    memory->entry_capacity = count;
    return true;
}

bool tabulation_add(Tabulation *memory, const TabulationQuery *query, const TabulationEntry *entry, Error *error) {
    const size_t key = (size_t)memory->key_size, metric = (size_t)memory->metric_size, e = (size_t)memory->entry_count;
    if (memory->entry_count >= TABULATION_ENTRIES_MAX || !reserve_entry(memory, query->contacts))
        return error_memory(error, "hybrid");
    int set = tabulation_set(memory, query->hash, query->contacts);
    if (set < 0) set = tabulation_add_set(memory, query->hash, query->contacts);
    if (set < 0 || !tabulation_list_reserve(memory, set)) return error_memory(error, "hybrid");
    memory->entry_set[e] = set;
    memory->entry_begin[e] = memory->impulse_count;
    memory->reach[e] = entry->reach;
    memcpy(memory->keys + e * key, query->key, key * sizeof *query->key);
    memcpy(memory->metrics + e * metric, entry->metric, metric * sizeof *entry->metric);
    memcpy(memory->near + e * TABULATION_NEAR, entry->near, TABULATION_NEAR * sizeof *entry->near);
    memcpy(memory->weights + e * TABULATION_NEAR * key, entry->weights, TABULATION_NEAR * key * sizeof(float));
    if (query->contacts > 0)
        memcpy(memory->impulses + memory->impulse_count, entry->impulses,
               (size_t)query->contacts * sizeof *entry->impulses);
    memory->impulse_count += (size_t)query->contacts;
    memory->entry_count++;
    tabulation_list_insert(memory, (int)e);
    return true;
}
