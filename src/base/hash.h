/* SPDX-License-Identifier: GPL-3.0-or-later */
/* 64-bit hashes: FNV-1a for the reference trajectories, whose format defines it, XXH3 (libxxhash) elsewhere. Neither is
   cryptographic; both are the same on every machine. */
#pragma once
#include <stddef.h>
#include <stdint.h>

#define FNV1A64_START UINT64_C(1469598103934665603)

/* Continues an FNV-1a hash (begun with FNV1A64_START) over size bytes. */
uint64_t hash_fnv1a64(uint64_t hash, const void *data, size_t size);

uint64_t hash_xxh3(const void *data, size_t size);

/* The same of bytes that come in parts. NULL if out of memory. */
typedef struct HashParts HashParts;
HashParts *hash_parts_create(void);
void hash_parts_destroy(HashParts *parts);
void hash_parts_add(HashParts *parts, const void *data, size_t size);
uint64_t hash_parts_end(HashParts *parts); /* what follows is another hash */
