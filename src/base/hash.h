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
