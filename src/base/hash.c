/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hashes of states (FNV-1a) and of files (xxHash). */
#include "base/hash.h"

/* The same values with the widest vectors of the processor, in half the time. */
#if defined(__wasm__) || defined(TWINBOX_COMPARE_ONLY) /* there is no library to link */
#define XXH_INLINE_ALL
#ifdef __wasm__
#define XXH_VECTOR 0    /* XXH_SCALAR */
#undef __wasm_simd128__ /* for which xxHash 0.8.3 includes the header of NEON */
#endif
#include <xxhash.h>
#elif defined(TWINBOX_AVX)
#include <xxh_x86dispatch.h>
#else
#include <xxhash.h>
#endif

uint64_t hash_fnv1a64(uint64_t hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

uint64_t hash_xxh3(const void *data, size_t size) { return XXH3_64bits(data, size); }

HashParts *hash_parts_create(void) {
    XXH3_state_t *state = XXH3_createState();
    if (state != NULL) (void)XXH3_64bits_reset(state);
    return (HashParts *)state;
}

void hash_parts_destroy(HashParts *parts) { (void)XXH3_freeState((XXH3_state_t *)parts); }

void hash_parts_add(HashParts *parts, const void *data, size_t size) {
    (void)XXH3_64bits_update((XXH3_state_t *)parts, data, size);
}

uint64_t hash_parts_end(HashParts *parts) {
    const uint64_t hash = XXH3_64bits_digest((XXH3_state_t *)parts);
    (void)XXH3_64bits_reset((XXH3_state_t *)parts);
    return hash;
}
