/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve_read.h"

#include "common/array.h"
#include "common/json.h"
#include "image/sequence.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_SIZE = 1 << 25 };

static bool is_plain_name(const char *name) {
    const char *ending = strrchr(name, '.');
    return name[0] != '.' && strchr(name, '/') == NULL && name_is_text(name) && ending != NULL &&
           (strcasecmp(ending, ".png") == 0 || strcmp(ending, ".npz") == 0);
}

/* Copies a text that must be there, not be empty and fit. */
static bool read_text(const Json *json, const JsonValue *object, const char *key, char *text, size_t size,
                      Error *error) {
    const JsonValue *value = json_need(json, object, key, JSON_STRING, error);
    if (value == NULL) return false;
    const size_t length = strlen(value->text);
    if (length == 0 || length >= size)
        return json_error(json, value, error, "'%s' must have 1 to %zu bytes", key, size - 1);
    memcpy(text, value->text, length + 1);
    return true;
}

static bool read_flag(const Json *json, const JsonValue *object, const char *key, bool *flag, Error *error) {
    const JsonValue *value = json_member(object, key);
    *flag = value != NULL && value->kind == JSON_TRUE;
    return (value != NULL && (value->kind == JSON_TRUE || value->kind == JSON_FALSE)) ||
           json_error(json, value != NULL ? value : object, error, "'%s' must be true or false", key);
}

/* null, or name, size and hash. */
static bool read_file(const Json *json, const JsonValue *item, const char *key, ApprovalFile *file, Error *error) {
    char digits[24];
    const JsonValue *value = json_member(item, key);
    if (value == NULL || value->kind == JSON_NULL) return true;
    if (value->kind != JSON_OBJECT) return json_error(json, value, error, "'%s' must be null or a file", key);
    if (!read_text(json, value, "name", file->name, sizeof file->name, error) ||
        !read_text(json, value, "xxh3", digits, sizeof digits, error))
        return false;
    if (!is_plain_name(file->name))
        return json_error(json, value, error, "a name must be that of a .png or .npz file, without a folder");
    if (strlen(digits) != 16 || strspn(digits, "0123456789abcdef") != 16)
        return json_error(json, value, error, "a hash has 16 digits from 0 to f");
    file->hash = strtoull(digits, NULL, 16);
    return true;
}

static bool read_item(const Json *json, const JsonValue *value, ApprovalItem *item, Error *error) {
    *item = (ApprovalItem){.failed = false};
    if (value->kind != JSON_OBJECT) return json_error(json, value, error, "a frame or trajectory must be an object");
    if (!read_flag(json, value, "failed", &item->failed, error) ||
        !read_flag(json, value, "shown", &item->shown, error) ||
        !read_file(json, value, "expected", &item->expected, error) ||
        !read_file(json, value, "actual", &item->actual, error))
        return false;
    return item->expected.name[0] != '\0' || item->actual.name[0] != '\0' ||
           json_error(json, value, error, "neither an expected nor an actual file");
}

static bool read_items(const Json *json, const char *key, ApprovalList *list, Error *error) {
    const JsonValue *items = json_need(json, json->values, key, JSON_ARRAY, error);
    if (items == NULL) return false;
    for (const JsonValue *value = json_first(items); value != NULL; value = json_next(items, value)) {
        ApprovalItem item;
        if (!read_item(json, value, &item, error)) return false;
        if (!item.failed) continue;
        if (!array_reserve((void **)&list->items, &list->capacity, list->count + 1, sizeof item))
            return error_memory(error, json->path);
        list->items[list->count++] = item;
    }
    return true;
}

static bool read_list(const Json *json, ApprovalList *list, Error *error) {
    const JsonValue *whole = json->values, *format = NULL;
    if (whole->kind == JSON_OBJECT) format = json_member(whole, "format");
    if (format == NULL || format->kind != JSON_STRING || strcmp(format->text, "twinbox compare 1") != 0)
        return json_error(json, whole, error, "this is no report of twinbox compare");
    return read_text(json, whole, "expected", list->expected, sizeof list->expected, error) &&
           read_text(json, whole, "actual", list->actual, sizeof list->actual, error) &&
           read_items(json, "frames", list, error) && read_items(json, "trajectories", list, error);
}

bool approval_read(ApprovalList *list, const char *path, Error *error) {
    Json json;
    if (!json_read(&json, path, MAX_SIZE, error)) return false;
    *list = (ApprovalList){.count = 0};
    bool ok = read_list(&json, list, error);
    json_free(&json);
    if (!ok) approval_free(list);
    return ok;
}

void approval_free(ApprovalList *list) { free(list->items); }
