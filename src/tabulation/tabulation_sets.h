/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sets of contacts of a memory (tabulation.h), found by their hashes. */
#pragma once
#include "tabulation/tabulation.h"

/* The set with this hash and number of contacts, or -1. */
int tabulation_set(const Tabulation *memory, uint64_t hash, int contacts);

/* A new set without entries; -1 when memory is short. */
int tabulation_add_set(Tabulation *memory, uint64_t hash, int contacts);

/* Room for one more entry in a set's list; false when memory is short. Then the entry, added last, goes to its place. */
bool tabulation_list_reserve(Tabulation *memory, int set);
void tabulation_list_insert(Tabulation *memory, int entry);

/* Gives an array that keeps its items room for `count` of `size` bytes. False when memory is short; the array stays valid. */
bool tabulation_resize(void **items, size_t count, size_t size);
