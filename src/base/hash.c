/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/hash.h"

/* The same values with the widest vectors of the processor, in half the time. */
#if defined(__wasm__) || defined(TWINBOX_COMPARE_ONLY) /* there is no library to link */
#define XXH_INLINE_ALL
#ifdef __wasm__
#define XXH_VECTOR 0 /* XXH_SCALAR */
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
