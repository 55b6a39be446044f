/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all readers of .npz files share. */
#include "npz/npz.h"

#include <stdlib.h>
#include <string.h>

bool npz_read_name(NpzFile *file, const char *name, char *text, size_t size, Error *error) {
    if (!npz_read_text(file, name, text, size, error)) return false;
    for (const char *c = text; *c != '\0'; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            return error_input(error, npz_path(file), "the name of the %s holds control characters", name);
    return true;
}

bool npz_read_scalar(NpzFile *file, const char *name, NpzType type, void *value, size_t size, Error *error) {
    void *data = npz_read(file, name, type, 0, NULL, error);
    if (data != NULL) memcpy(value, data, size);
    free(data);
    return data != NULL;
}

bool npz_check_kind(NpzFile *file, const char *kind, int32_t version, Error *error) {
    char found[64];
    int32_t stored;
    if (!npz_has(file, "kind") || !npz_read_text(file, "kind", found, sizeof found, error) || strcmp(found, kind) != 0)
        return error_input(error, npz_path(file), "not a file of kind '%s'", kind);
    if (!npz_read_scalar(file, "version", NPZ_INT32, &stored, sizeof stored, error)) return false;
    return stored == version ||
           error_input(error, npz_path(file), "%s of version %d; expected version %d", kind, (int)stored, (int)version);
}
