/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of networks: one list of fields for writing, for a look at the shapes, and for reading. */
#include "base/base.h"
#include "base/npz.h"
#include "nets/nets.h"

#include <float.h>
#include <stdlib.h>

const FloatBounds float_any = {-FLT_MAX, FLT_MAX, "it must be finite"};
const FloatBounds float_positive = {FLT_TRUE_MIN, FLT_MAX, "it must be finite and greater than 0"};
const FloatBounds float_not_negative = {0, FLT_MAX, "it must be finite and not negative"};
const FloatBounds float_momentum = {0, 2, "it must be from 0 to 2"};

NpzArray net_field_array(const NetField *field) {
    return (NpzArray){field->name, field->type, field->rank, {field->shape[0], field->shape[1]}, field->data};
}

bool net_file_write(const NetFileKind *kind, const void *net, const char *path, Error *error) {
    NetField fields[NET_FIELDS_MAX];
    NpzArray arrays[2 + NET_FIELDS_MAX] = {{.name = "version", .type = NPZ_INT32, .data = &kind->version},
                                           {.name = "kind", .type = NPZ_TEXT, .data = kind->name}};
    const int count = kind->list((void *)net, fields); /* only a reader writes to what the fields point to */
    for (int i = 0; i < count; i++) arrays[2 + i] = net_field_array(&fields[i]);
    return npz_write(path, arrays, 2 + (size_t)count, error);
}

static bool check_numbers(const NpzFile *file, const NetField *field, const void *numbers, size_t count, Error *error) {
    const float *floats = numbers;
    const double *doubles = numbers;
    for (size_t i = 0; field->type == NPZ_FLOAT32 && i < count; i++)
        if (!(floats[i] >= field->range->least && floats[i] <= field->range->most))
            return error_input(error, npz_path(file), "%s: number %zu is %g; %s", field->name, i, (double)floats[i],
                               field->range->words);
    for (size_t i = 0; field->type == NPZ_FLOAT64 && i < count; i++)
        if (!isfinite(doubles[i]))
            return error_input(error, npz_path(file), "%s: number %zu is NaN or infinite", field->name, i);
    return true;
}

static bool read_field(NpzFile *file, const NetField *field, Error *error) {
    if (field->type == NPZ_TEXT)
        return (field->shown ? npz_read_name : npz_read_text)(file, field->name, field->data, (size_t)field->shape[0],
                                                              error);
    void *numbers = npz_read(file, field->name, field->type, field->rank, field->shape, error);
    if (numbers == NULL) return false;
    size_t count = 1;
    for (int r = 0; r < field->rank; r++) count *= (size_t)field->shape[r];
    const bool ok = check_numbers(file, field, numbers, count, error);
    if (ok) memcpy(field->data, numbers, count * npy_type_size(field->type));
    free(numbers);
    return ok;
}

static bool expect(const NpzFile *file, const NetField *fields, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        const NpzArray array = net_field_array(&fields[i]);
        if (!npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

bool net_fields_read(NpzFile *file, const NetField *fields, int count, Error *error) {
    if (!expect(file, fields, count, error)) return false;
    for (int i = 0; i < count; i++)
        if (!fields[i].known && !read_field(file, &fields[i], error)) return false;
    return true;
}

bool net_file_read(const NetFileKind *kind, void *net, const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    NetField fields[NET_FIELDS_MAX];
    bool ok = npz_check_kind(file, kind->name, kind->version, error) &&
              (kind->read_sizes == NULL || kind->read_sizes(net, file, error)) &&
              expect(file, fields, kind->list(net, fields), error) &&
              (kind->create == NULL || kind->create(net, error));
    /* Where the arrays are. */
    ok = ok && net_fields_read(file, fields, kind->list(net, fields), error) &&
         (kind->check == NULL || kind->check(net, npz_path(file), error));
    npz_close(file);
    return ok;
}

int net_file_integers(NpzFile *file, const char *name, int least, int most, int32_t *numbers, Error *error) {
    int64_t count = most;
    if (least < most && !npz_shape(file, name, NPZ_INT32, 1, &count, error)) return 0;
    if (count < least || count > most)
        return error_input(error, npz_path(file), "%s has %lld numbers; expected %d to %d", name, (long long)count,
                           least, most);
    int32_t *stored = npz_read(file, name, NPZ_INT32, 1, &count, error);
    if (stored == NULL) return 0;
    memcpy(numbers, stored, (size_t)count * sizeof *numbers);
    free(stored);
    return (int)count;
}

bool net_file_integer(NpzFile *file, const char *name, int *number, Error *error) {
    return npz_read_scalar(file, name, NPZ_INT32, number, sizeof *number, error);
}
