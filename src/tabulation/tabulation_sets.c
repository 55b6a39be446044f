/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulation/tabulation_sets.h"

#include "common/array.h"

#include <stdlib.h>

enum { LEAST_TABLE = 64 };

static void put(Tabulation *memory, int set) {
    size_t at = (size_t)memory->set_hash[set] & (memory->table_size - 1);
    while (memory->table[at] >= 0) at = (at + 1) & (memory->table_size - 1);
    memory->table[at] = set;
}

/* Keeps the table at most half full, so that searches are short. */
static bool grow_table(Tabulation *memory) {
    if (2 * ((size_t)memory->set_count + 1) <= memory->table_size) return true;
    const size_t size = memory->table_size > 0 ? 2 * memory->table_size : LEAST_TABLE;
    int32_t *table = malloc(size * sizeof *table);
    if (table == NULL) return false;
    free(memory->table);
    memory->table = table;
    memory->table_size = size;
    for (size_t i = 0; i < size; i++) table[i] = -1;
    for (int set = 0; set < memory->set_count; set++) put(memory, set);
    return true;
}

/* The new size of an array that keeps its items; false when memory is short. */
bool tabulation_resize(void **items, size_t count, size_t size) {
    void *grown = realloc(*items, count * size);
    if (grown == NULL) return false;
    *items = grown;
    return true;
}

int tabulation_set(const Tabulation *memory, uint64_t hash, int contacts) {
    if (memory->table_size == 0) return -1;
    size_t at = (size_t)hash & (memory->table_size - 1);
    for (int set; (set = memory->table[at]) >= 0; at = (at + 1) & (memory->table_size - 1))
        if (memory->set_hash[set] == hash && memory->set_contacts[set] == contacts) return set;
    return -1;
}

int tabulation_add_set(Tabulation *memory, uint64_t hash, int contacts) {
    if ((size_t)memory->set_count >= memory->set_capacity) {
        const size_t count = 2 * memory->set_capacity + 16;
        if (!tabulation_resize((void **)&memory->set_hash, count, sizeof *memory->set_hash) ||
            !tabulation_resize((void **)&memory->set_contacts, count, sizeof *memory->set_contacts) ||
            !tabulation_resize((void **)&memory->set_lists, count, sizeof *memory->set_lists))
            return -1;
        memory->set_capacity = count;
    }
    if (!grow_table(memory)) return -1;
    const int set = memory->set_count++;
    memory->set_hash[set] = hash;
    memory->set_contacts[set] = contacts;
    memory->set_lists[set] = (TabulationList){0};
    put(memory, set);
    return set;
}

static float first_number(const Tabulation *memory, int entry) {
    return memory->keys[(size_t)entry * (size_t)memory->key_size];
}

/* The place of the first entry with a number of at least `x`. */
static int place_of(const Tabulation *memory, const TabulationList *list, float x) {
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

bool tabulation_list_reserve(Tabulation *memory, int set) {
    TabulationList *list = &memory->set_lists[set];
    return array_reserve((void **)&list->entries, &list->capacity, (size_t)list->count + 1, sizeof *list->entries);
}

void tabulation_list_insert(Tabulation *memory, int entry) {
    TabulationList *list = &memory->set_lists[memory->entry_set[entry]];
    int at = place_of(memory, list, first_number(memory, entry));
    for (int i = list->count++; i > at; i--) list->entries[i] = list->entries[i - 1];
    list->entries[at] = entry;
    if (memory->reach[entry] > list->reach) list->reach = memory->reach[entry];
}

const int32_t *tabulation_about(const Tabulation *memory, const TabulationQuery *query, float radius, int *count) {
    const int set = tabulation_set(memory, query->hash, query->contacts);
    *count = 0;
    if (set < 0) return NULL;
    const TabulationList *list = &memory->set_lists[set];
    const int first = place_of(memory, list, query->key[0] - radius);
    int end = first;
    while (end < list->count && first_number(memory, list->entries[end]) <= query->key[0] + radius) end++;
    *count = end - first;
    return list->entries + first;
}
