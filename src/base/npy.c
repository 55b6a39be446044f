/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One .npy array: its header, written and parsed, and the conversion of its numbers. */
#include "base/base.h"
#include "base/npz.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "arrays are stored little-endian and copied unconverted; this machine is not little-endian"
#endif

static const struct {
    const char *code, *name;
    unsigned size;
} types[] = {
    [NPZ_FLOAT32] = {"<f4", "float32", 4}, [NPZ_FLOAT64] = {"<f8", "float64", 8}, [NPZ_INT32] = {"<i4", "int32", 4},
    [NPZ_UINT32] = {"<u4", "uint32", 4},   [NPZ_INT64] = {"<i8", "int64", 8},     [NPZ_UINT64] = {"<u8", "uint64", 8},
    [NPZ_UINT8] = {"|u1", "uint8", 1},     [NPZ_INT8] = {"|i1", "int8", 1},       [NPZ_INT16] = {"<i2", "int16", 2},
    [NPZ_UINT16] = {"<u2", "uint16", 2},   [NPZ_FLOAT16] = {"<f2", "float16", 2}, [NPZ_BOOL] = {"|b1", "bool", 1},
    [NPZ_TEXT] = {"<U", "text", 4},
};

static const char MAGIC[] = "\x93NUMPY";
enum {
    MAGIC_SIZE = sizeof MAGIC - 1,
    VERSION_1_SIZE = MAGIC_SIZE + 4,
    VERSION_2_SIZE = MAGIC_SIZE + 6,
    ALIGNMENT = 64
};

const char *npy_type_name(NpzType type) { return types[type].name; }

size_t npy_type_size(NpzType type) { return types[type].size; }

size_t npy_count(const NpyHead *head) { return (size_t)head->data_size / types[head->type].size; }

bool npy_measure(NpyHead *head) {
    uint64_t items = head->type == NPZ_TEXT ? (uint64_t)head->characters : 1;
    if (items > NPZ_MAX_BYTES) return false;
    for (int i = 0; i < head->rank; i++) {
        if ((uint64_t)head->shape[i] > NPZ_MAX_BYTES) return false;
        items *= (uint64_t)head->shape[i];
        if (items > NPZ_MAX_BYTES) return false;
    }
    head->data_size = items * types[head->type].size;
    return head->data_size <= NPZ_MAX_BYTES;
}

PRINTF_LIKE(3, 4) static size_t append(char *text, size_t used, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text + used, NPY_HEAD_MAX - used, format, arguments);
    va_end(arguments);
    return used + (size_t)length;
}

void npy_write_head(NpyHead *head, char text[NPY_HEAD_MAX]) {
    size_t used = append(text, VERSION_1_SIZE, "{'descr': '%s", types[head->type].code);
    if (head->type == NPZ_TEXT) used = append(text, used, "%" PRId64, head->characters);
    used = append(text, used, "', 'fortran_order': False, 'shape': (");
    for (int i = 0; i < head->rank; i++) used = append(text, used, i == 0 ? "%" PRId64 : ", %" PRId64, head->shape[i]);
    used = append(text, used, head->rank == 1 ? ",), }" : "), }");
    head->head_size = (used + 1 + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    memset(text + used, ' ', head->head_size - used);
    text[head->head_size - 1] = '\n';
    memcpy(text, MAGIC, MAGIC_SIZE);
    size_t length = head->head_size - VERSION_1_SIZE;
    text[MAGIC_SIZE] = 1;
    text[MAGIC_SIZE + 1] = 0;
    text[MAGIC_SIZE + 2] = (char)(length & 0xff);
    text[MAGIC_SIZE + 3] = (char)(length >> 8);
}

PRINTF_LIKE(2, 3) static bool refuse(char reason[NPY_REASON_SIZE], const char *format, ...) {
    PRINT_ARGUMENTS(reason, NPY_REASON_SIZE, format);
    return false;
}

/* Skips `word` if the text continues with it. */
static bool npy_take(const char **text, const char *word) {
    size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0) return false;
    *text += length;
    return true;
}

static bool take_number(const char **text, int64_t *number) {
    const char *digit = *text;
    *number = 0;
    while (*digit >= '0' && *digit <= '9' && *number < (INT64_MAX - 9) / 10) *number = *number * 10 + (*digit++ - '0');
    if (digit == *text || (*digit >= '0' && *digit <= '9')) return false;
    *text = digit;
    return true;
}

static bool take_type(const char **text, NpyHead *head) {
    head->big_endian = **text == '>';
    for (head->type = NPZ_FLOAT32; head->type <= NPZ_TEXT; head->type++) {
        const char *code = types[head->type].code, *rest = *text + 1;
        if ((**text != code[0] && (!head->big_endian || code[0] != '<')) || !npy_take(&rest, code + 1)) continue;
        *text = rest;
        return head->type != NPZ_TEXT || take_number(text, &head->characters);
    }
    return false;
}

/* "()", "(3,)", "(3, 2)". Counts all dimensions; head->shape has the first ones. */
static bool take_shape(const char **text, NpyHead *head) {
    if (npy_take(text, "()")) return true;
    if (!npy_take(text, "(")) return false;
    do {
        int64_t size;
        if (!take_number(text, &size)) return false;
        if (head->rank < NPZ_MAX_RANK) head->shape[head->rank] = size;
        head->rank++;
    } while (npy_take(text, ", "));
    return (head->rank > 1 || npy_take(text, ",")) && npy_take(text, ")");
}

/* Reads the dictionary and the blanks up to the line feed. */
static bool parse_dictionary(NpyHead *head, const char *text, char reason[NPY_REASON_SIZE]) {
    head->is_foreign = npy_take(&text, "{'descr': [");
    if (head->is_foreign) return refuse(reason, "not a plain array");
    if (!npy_take(&text, "{'descr': '")) return refuse(reason, "with a damaged header");
    const char *type = text;
    if (!take_type(&text, head) || *text != '\'') {
        head->is_foreign = true;
        int length = (int)strspn(type, "<>|=?abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789[]");
        return refuse(reason, "of the unsupported type '%.*s'", length < 32 ? length : 32, type);
    }
    if (!npy_take(&text, "', 'fortran_order': ")) return refuse(reason, "with a damaged header");
    head->fortran = npy_take(&text, "True");
    if ((!head->fortran && !npy_take(&text, "False")) || !npy_take(&text, ", 'shape': ") || !take_shape(&text, head) ||
        !npy_take(&text, ", }"))
        return refuse(reason, "with a damaged header");
    text += strspn(text, " ");
    if (strcmp(text, "\n") != 0) return refuse(reason, "with a damaged header");
    head->is_foreign = head->rank > NPZ_MAX_RANK || (head->type == NPZ_TEXT && head->rank > 0);
    if (head->rank > NPZ_MAX_RANK) return refuse(reason, "of more than %d dimensions", NPZ_MAX_RANK);
    if (head->is_foreign) return refuse(reason, "an array of texts; expected a single text");
    return npy_measure(head) || refuse(reason, "larger than 2 GiB");
}

bool npy_parse_head(NpyHead *head, const char *text, size_t size, char reason[NPY_REASON_SIZE]) {
    const unsigned char *bytes = (const unsigned char *)text;
    *head = (NpyHead){0};
    if (size < VERSION_2_SIZE || memcmp(text, MAGIC, MAGIC_SIZE) != 0) return refuse(reason, "not a .npy array");
    int version = bytes[MAGIC_SIZE];
    if (version < 1 || version > 2 || bytes[MAGIC_SIZE + 1] != 0)
        return refuse(reason, "in version %d.%d of .npy; expected 1.0 or 2.0", version, bytes[MAGIC_SIZE + 1]);
    size_t start = version == 1 ? VERSION_1_SIZE : VERSION_2_SIZE;
    uint64_t length = bytes[MAGIC_SIZE + 2] + 256U * bytes[MAGIC_SIZE + 3];
    if (version == 2) length += ((uint64_t)bytes[MAGIC_SIZE + 4] << 16) + ((uint64_t)bytes[MAGIC_SIZE + 5] << 24);
    if (length > size - start)
        return refuse(reason, "with a header that is cut off or longer than %d bytes", NPY_HEAD_MAX);
    char dictionary[NPY_HEAD_MAX + 1];
    memcpy(dictionary, text + start, length);
    dictionary[length] = '\0';
    if (strlen(dictionary) != length) return refuse(reason, "with a damaged header");
    head->head_size = start + length;
    return parse_dictionary(head, dictionary, reason);
}

/* Arrays of other types and orders than those that twinbox writes. */

/* Holds every number of every type, which a double does not. */
typedef long double Number;
_Static_assert(LDBL_MANT_DIG >= 64, "a long double holds any int64 and uint64");

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

#define LOAD(type)                              \
    do {                                        \
        type loaded_;                           \
        memcpy(&loaded_, item, sizeof loaded_); \
        return (Number)loaded_;                 \
    } while (0)

/* IEEE 754 binary16: 5 bits of exponent, 10 of fraction. */
static Number load_half(const void *item) {
    uint16_t bits;
    memcpy(&bits, item, sizeof bits);
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double size = exponent == 31  ? (fraction != 0 ? (double)NAN : (double)INFINITY)
                        : exponent == 0 ? ldexp(fraction, -24)
                                        : ldexp(1024 + fraction, exponent - 25);
    return (Number)copysign(size, bits >> 15 ? -1 : 1);
}

static Number npy_load(NpzType type, const void *item) {
    switch (type) {
    case NPZ_FLOAT16: return load_half(item);
    case NPZ_FLOAT32: LOAD(float);
    case NPZ_FLOAT64: LOAD(double);
    case NPZ_INT8: LOAD(int8_t);
    case NPZ_INT16: LOAD(int16_t);
    case NPZ_INT32: LOAD(int32_t);
    case NPZ_INT64: LOAD(int64_t);
    case NPZ_UINT16: LOAD(uint16_t);
    case NPZ_UINT32: LOAD(uint32_t);
    case NPZ_UINT64: LOAD(uint64_t);
    case NPZ_UINT8: LOAD(uint8_t);
    default: return *(const uint8_t *)item != 0; /* a bool of a file may be any byte */
    }
}

/* False if the number is no whole one in the type's range. */
#define STORE_WHOLE(type, least, most)                                                                         \
    do {                                                                                                       \
        if (!(number >= (Number)(least) && number <= (Number)(most)) || rintl(number) != number) return false; \
        memcpy(item, &(type){(type)number}, sizeof(type));                                                     \
        return true;                                                                                           \
    } while (0)

/* False if the number does not fit. */
static bool npy_store(NpzType type, Number number, void *item) {
    switch (type) {
    case NPZ_FLOAT32:
        memcpy(item, &(float){(float)number}, sizeof(float));
        return !isinf(*(float *)item) || isinf(number);
    case NPZ_FLOAT64: memcpy(item, &(double){(double)number}, sizeof(double)); return true;
    case NPZ_INT32: STORE_WHOLE(int32_t, INT32_MIN, INT32_MAX);
    case NPZ_INT64: STORE_WHOLE(int64_t, INT64_MIN, INT64_MAX);
    case NPZ_UINT32: STORE_WHOLE(uint32_t, 0, UINT32_MAX);
    case NPZ_UINT64: STORE_WHOLE(uint64_t, 0, UINT64_MAX);
    default: STORE_WHOLE(uint8_t, 0, UINT8_MAX);
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
static bool refuse_number(const NpyHead *head, size_t i, Number number, NpzType type, char reason[NPY_REASON_SIZE]) {
    int64_t index[NPZ_MAX_RANK] = {0};
    for (int k = head->rank - 1; k >= 0; k--) {
        index[k] = (int64_t)(i % (size_t)head->shape[k]);
        i /= (size_t)head->shape[k];
    }
    int used = snprintf(reason, NPY_REASON_SIZE, head->rank > 0 ? "item [" : "its value");
    for (int k = 0; k < head->rank; k++)
        used += snprintf(reason + used, NPY_REASON_SIZE - (size_t)used, "%" PRId64 "%s", index[k],
                         k + 1 < head->rank ? ", " : "]");
    snprintf(reason + used, NPY_REASON_SIZE - (size_t)used, " is %.17g, which does not fit into %s", (double)number,
             npy_type_name(type));
    return false;
}

bool npy_convert(const NpyHead *head, const void *data, NpzType type, void *converted, char reason[NPY_REASON_SIZE]) {
    const size_t count = npy_count(head), from = npy_type_size(head->type), to = npy_type_size(type);
    const bool reordered = head->fortran && head->rank > 1;
    for (size_t i = 0; i < count; i++) {
        size_t at = reordered ? fortran_index(head, i) : i;
        const Number number = npy_load(head->type, (const char *)data + at * from);
        if (!npy_store(type, number, (char *)converted + i * to)) return refuse_number(head, i, number, type, reason);
    }
    return true;
}
