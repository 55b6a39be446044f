/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays of other types and orders than those that twinbox writes. */
#include "npz/npy.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A number of any type. Not a double alone: it does not hold every int64. */
typedef struct Number {
    enum { REAL, INTEGER, NATURAL } kind; /* which of the next three it is */
    double real;
    int64_t integer;
    uint64_t natural;
} Number;

void npy_swap(const NpyHead *head, void *data) {
    size_t size = npy_type_size(head->type), count = npy_count(head);
    unsigned char *item = data;
    for (size_t i = 0; i < count; i++, item += size)
        for (size_t low = 0, high = size - 1; low < high; low++, high--) {
            unsigned char byte = item[low];
            item[low] = item[high];
            item[high] = byte;
        }
}

#define LOAD(type, which, member)                    \
    do {                                             \
        type loaded_;                                \
        memcpy(&loaded_, item, sizeof loaded_);      \
        return (Number){(which), .member = loaded_}; \
    } while (0)

static Number load(NpzType type, const void *item) {
    switch (type) {
    case NPZ_FLOAT32: LOAD(float, REAL, real);
    case NPZ_FLOAT64: LOAD(double, REAL, real);
    case NPZ_INT8: LOAD(int8_t, INTEGER, integer);
    case NPZ_INT16: LOAD(int16_t, INTEGER, integer);
    case NPZ_INT32: LOAD(int32_t, INTEGER, integer);
    case NPZ_INT64: LOAD(int64_t, INTEGER, integer);
    case NPZ_UINT16: LOAD(uint16_t, NATURAL, natural);
    case NPZ_UINT32: LOAD(uint32_t, NATURAL, natural);
    case NPZ_UINT64: LOAD(uint64_t, NATURAL, natural);
    case NPZ_UINT8: LOAD(uint8_t, NATURAL, natural);
    default: return (Number){NATURAL, .natural = *(const uint8_t *)item != 0}; /* a bool of a file may be any byte */
    }
}

static bool store_float(const Number *number, float *item) {
    *item = number->kind == REAL      ? (float)number->real
            : number->kind == INTEGER ? (float)number->integer
                                      : (float)number->natural;
    return number->kind != REAL || !isinf(*item) || isinf(number->real);
}

static double as_double(const Number *number) {
    return number->kind == REAL      ? number->real
           : number->kind == INTEGER ? (double)number->integer
                                     : (double)number->natural;
}

/* As an int64, if it is a whole number in its range. */
static bool as_integer(const Number *number, int64_t *integer) {
    const double end = 0x1p63;
    if (number->kind == REAL) {
        if (!(number->real >= -end && number->real < end) || rint(number->real) != number->real) return false;
        *integer = (int64_t)number->real;
    } else
        *integer = number->kind == INTEGER ? number->integer : (int64_t)number->natural;
    return number->kind != NATURAL || number->natural <= INT64_MAX;
}

static bool as_natural(const Number *number, uint64_t *natural) {
    int64_t integer;
    if (number->kind == NATURAL) {
        *natural = number->natural;
        return true;
    }
    if (!as_integer(number, &integer) || integer < 0) return false;
    *natural = (uint64_t)integer;
    return true;
}

#define STORE(type, value)                      \
    do {                                        \
        type stored_ = (type)(value);           \
        memcpy(item, &stored_, sizeof stored_); \
    } while (0)

/* False if the number does not fit. */
static bool store(NpzType type, const Number *number, void *item) {
    int64_t integer = 0;
    uint64_t natural = 0;
    bool fits;
    switch (type) {
    case NPZ_FLOAT32: return store_float(number, item);
    case NPZ_FLOAT64: STORE(double, as_double(number)); return true;
    case NPZ_INT32:
        fits = as_integer(number, &integer) && integer >= INT32_MIN && integer <= INT32_MAX;
        STORE(int32_t, integer);
        return fits;
    case NPZ_INT64:
        fits = as_integer(number, &integer);
        STORE(int64_t, integer);
        return fits;
    case NPZ_UINT32:
        fits = as_natural(number, &natural) && natural <= UINT32_MAX;
        STORE(uint32_t, natural);
        return fits;
    case NPZ_UINT64:
        fits = as_natural(number, &natural);
        STORE(uint64_t, natural);
        return fits;
    default:
        fits = as_natural(number, &natural) && natural <= UINT8_MAX;
        STORE(uint8_t, natural);
        return fits;
    }
}

/* Where item i of the C order is stored. */
static size_t fortran_index(const NpyHead *head, size_t i) {
    size_t at = 0, stride[NPZ_MAX_RANK], size = 1;
    for (int k = 0; k < head->rank; k++) {
        stride[k] = size;
        size *= (size_t)head->shape[k];
    }
    for (int k = head->rank - 1; k >= 0; k--) {
        at += i % (size_t)head->shape[k] * stride[k];
        i /= (size_t)head->shape[k];
    }
    return at;
}

/* "item [3, 0] is 1e+300, which is not a float32" */
static bool refuse(const NpyHead *head, size_t i, const Number *number, NpzType type, char reason[NPY_REASON_SIZE]) {
    int64_t index[NPZ_MAX_RANK] = {0};
    for (int k = head->rank - 1; k >= 0; k--) {
        index[k] = (int64_t)(i % (size_t)head->shape[k]);
        i /= (size_t)head->shape[k];
    }
    int used = snprintf(reason, NPY_REASON_SIZE, head->rank > 0 ? "item [" : "its value");
    for (int k = 0; k < head->rank; k++)
        used += snprintf(reason + used, NPY_REASON_SIZE - (size_t)used, "%" PRId64 "%s", index[k],
                         k + 1 < head->rank ? ", " : "]");
    snprintf(reason + used, NPY_REASON_SIZE - (size_t)used, " is %.17g, which does not fit into %s", as_double(number),
             npy_type_name(type));
    return false;
}

bool npy_convert(const NpyHead *head, const void *data, NpzType type, void *converted, char reason[NPY_REASON_SIZE]) {
    const size_t count = npy_count(head), from = npy_type_size(head->type), to = npy_type_size(type);
    const bool reordered = head->fortran && head->rank > 1;
    for (size_t i = 0; i < count; i++) {
        size_t at = reordered ? fortran_index(head, i) : i;
        Number number = load(head->type, (const char *)data + at * from);
        if (!store(type, &number, (char *)converted + i * to)) return refuse(head, i, &number, type, reason);
    }
    return true;
}
