/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve_read.h"

#include "common/array.h"
#include "common/file.h"
#include "image/sequence.h"
#include "report/json.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { KEY_SIZE = 64, MAX_SIZE = 1 << 28 };

static bool is_plain_name(const char *name) {
    const char *ending = strrchr(name, '.');
    return name[0] != '.' && strchr(name, '/') == NULL && name_is_text(name) && ending != NULL &&
           (strcasecmp(ending, ".png") == 0 || strcmp(ending, ".npz") == 0);
}

static bool read_hash(JsonReader *reader, uint64_t *hash) {
    char digits[KEY_SIZE];
    if (!json_string(reader, digits, sizeof digits)) return false;
    if (strlen(digits) != 16 || strspn(digits, "0123456789abcdef") != 16)
        return json_fail(reader, "a hash has 16 digits from 0 to f");
    *hash = strtoull(digits, NULL, 16);
    return true;
}

/* null, or name, size and hash. */
static bool read_file(JsonReader *reader, ApprovalFile *file) {
    char key[KEY_SIZE];
    bool hashed = false;
    int count = 0;
    if (json_null(reader)) return true;
    while (json_next_key(reader, &count, key, sizeof key)) {
        if (strcmp(key, "name") == 0) {
            if (json_string(reader, file->name, sizeof file->name) && !is_plain_name(file->name))
                json_fail(reader, "a name must be that of a .png or .npz file, without a folder");
        } else if (strcmp(key, "xxh3") == 0)
            hashed = read_hash(reader, &file->hash);
        else
            json_skip(reader);
    }
    return !reader->failed &&
           ((hashed && file->name[0] != '\0') || json_fail(reader, "a file needs a name and a hash (xxh3)"));
}

static bool read_item(JsonReader *reader, ApprovalItem *item) {
    char key[KEY_SIZE];
    int count = 0;
    *item = (ApprovalItem){.failed = false};
    while (json_next_key(reader, &count, key, sizeof key)) {
        if (strcmp(key, "failed") == 0)
            json_bool(reader, &item->failed);
        else if (strcmp(key, "shown") == 0)
            json_bool(reader, &item->shown);
        else if (strcmp(key, "expected") == 0)
            read_file(reader, &item->expected);
        else if (strcmp(key, "actual") == 0)
            read_file(reader, &item->actual);
        else
            json_skip(reader);
    }
    if (reader->failed) return false;
    return item->expected.name[0] != '\0' || item->actual.name[0] != '\0' ||
           json_fail(reader, "neither an expected nor an actual file");
}

static bool read_items(JsonReader *reader, ApprovalList *list) {
    int count = 0;
    ApprovalItem item;
    while (json_next_item(reader, &count)) {
        if (!read_item(reader, &item)) return false;
        if (!item.failed) continue;
        void *items = list->items;
        bool room = array_reserve(&items, &list->capacity, list->count + 1, sizeof item);
        list->items = items;
        if (!room) {
            reader->failed = true;
            return error_memory(reader->error, reader->path);
        }
        list->items[list->count++] = item;
    }
    return !reader->failed;
}

static bool read_list(JsonReader *reader, ApprovalList *list) {
    char key[KEY_SIZE], format[KEY_SIZE] = "";
    int count = 0;
    while (json_next_key(reader, &count, key, sizeof key)) {
        if (strcmp(key, "format") == 0)
            json_string(reader, format, sizeof format);
        else if (strcmp(key, "expected") == 0)
            json_string(reader, list->expected, sizeof list->expected);
        else if (strcmp(key, "actual") == 0)
            json_string(reader, list->actual, sizeof list->actual);
        else if (strcmp(key, "frames") == 0 || strcmp(key, "trajectories") == 0)
            read_items(reader, list);
        else
            json_skip(reader);
    }
    if (!json_end(reader)) return false;
    return (strcmp(format, "twinbox compare 1") == 0 && list->expected[0] != '\0' && list->actual[0] != '\0') ||
           json_fail(reader, "this is no report of twinbox compare");
}

bool approval_read(ApprovalList *list, const char *path, Error *error) {
    size_t size;
    char *text = file_read(path, MAX_SIZE, &size, error);
    if (text == NULL) return false;
    *list = (ApprovalList){.count = 0};
    JsonReader reader = json_reader(path, text, error);
    bool ok = read_list(&reader, list);
    free(text);
    if (!ok) approval_free(list);
    return ok;
}

void approval_free(ApprovalList *list) { free(list->items); }
