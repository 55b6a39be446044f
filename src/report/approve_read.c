/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve_read.h"

#include "common/array.h"
#include "common/hash.h"
#include "image/sequence.h"
#include "json/json_read.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_SIZE = 1 << 25 };

/* The required members. Others (verdict, tolerance, masks) are skipped. */
enum { FORMAT, EXPECTED, ACTUAL, FRAMES, TRAJECTORIES, MEMBERS };
static const char *const members[MEMBERS] = {"format", "expected", "actual", "frames", "trajectories"};

/* "x.png" or "sub/x.png": no part is empty or hidden, which includes "." and "..". */
static bool is_name_below(const char *name) {
    const char *ending = strrchr(name, '.');
    char before = '/';
    for (const char *c = name; *c != '\0'; before = *c++)
        if (before == '/' && (*c == '/' || *c == '.')) return false;
    return name_is_text(name) && ending != NULL && (strcasecmp(ending, ".png") == 0 || strcmp(ending, ".npz") == 0);
}

/* A string of 1 to `max` bytes, valid as long as the value; otherwise NULL with error set. */
static const char *read_text(const JsonReader *json, const json_t *value, const char *key, size_t max, Error *error) {
    const char *text = json_string_value(value);
    size_t length = json_string_length(value);
    if (length > 0 && length <= max) return text;
    json_read_error(json, error, "'%s' must be a string of 1 to %zu bytes", key, max);
    return NULL;
}

static bool read_flag(const JsonReader *json, const json_t *item, const char *key, bool *flag, Error *error) {
    const json_t *value = json_object_get(item, key);
    *flag = json_is_true(value);
    return json_is_true(value) || json_is_false(value) ||
           json_read_error(json, error, "'%s' must be true or false", key);
}

/* null, or name, size and hash. */
static bool read_file(const JsonReader *json, const json_t *item, const char *key, ApprovalFile *file, Error *error) {
    const json_t *value = json_object_get(item, key);
    *file = (ApprovalFile){.name = ""};
    if (value == NULL || json_is_null(value)) return true;
    if (!json_is_object(value)) return json_read_error(json, error, "'%s' must be null or a file", key);
    file->name = read_text(json, json_object_get(value, "name"), "name", PATH_MAX - 1, error);
    if (file->name == NULL) return false;
    if (!is_name_below(file->name))
        return json_read_error(json, error, "a name must end with .png or .npz and lie below the folder");
    const char *digits = json_string_value(json_object_get(value, "xxh3"));
    if (digits == NULL || strlen(digits) != 16 || strspn(digits, "0123456789abcdef") != 16)
        return json_read_error(json, error, "a hash must have 16 digits from 0 to f");
    file->hash = strtoull(digits, NULL, 16);
    return true;
}

static bool read_item(const JsonReader *json, const json_t *value, ApprovalItem *item, Error *error) {
    if (!json_is_object(value)) return json_read_error(json, error, "a frame or trajectory must be an object");
    if (!read_flag(json, value, "failed", &item->failed, error) ||
        !read_flag(json, value, "shown", &item->shown, error) ||
        !read_file(json, value, "expected", &item->expected, error) ||
        !read_file(json, value, "actual", &item->actual, error))
        return false;
    return item->expected.name[0] != '\0' || item->actual.name[0] != '\0' ||
           json_read_error(json, error, "an expected or an actual file is required");
}

static void free_name(const ApprovalFile *file) {
    if (file->name[0] != '\0') free((void *)file->name);
}

static void free_names(const ApprovalItem *item) {
    free_name(&item->expected);
    free_name(&item->actual);
}

/* Gives the file a copy of its name, which outlives the value that it was read from. */
static bool keep_name(ApprovalFile *file) {
    const char *name = file->name[0] != '\0' ? strdup(file->name) : "";
    file->name = name != NULL ? name : "";
    return name != NULL;
}

static bool add_item(ApprovalList *list, ApprovalItem item) {
    const bool kept = keep_name(&item.expected);
    bool ok = keep_name(&item.actual) && kept &&
              array_reserve((void **)&list->items, &list->capacity, list->count + 1, sizeof item);
    if (ok)
        list->items[list->count++] = item;
    else
        free_names(&item);
    return ok;
}

/* The hashes of the files that were named so far: a table with open addressing, at most half full. 0 is an empty place. */
typedef struct Named {
    uint64_t *hashes; /* [size], a power of two */
    size_t size, count;
} Named;

static uint64_t *find_place(const Named *named, uint64_t hash) {
    size_t at = hash & (named->size - 1);
    while (named->hashes[at] != 0 && named->hashes[at] != hash) at = (at + 1) & (named->size - 1);
    return &named->hashes[at];
}

static bool grow(Named *named) {
    enum { FIRST_SIZE = 64 };
    if (2 * named->count < named->size) return true;
    Named larger = {.size = named->size > 0 ? 2 * named->size : FIRST_SIZE, .count = named->count};
    if ((larger.hashes = calloc(larger.size, sizeof *larger.hashes)) == NULL) return false;
    for (size_t i = 0; i < named->size; i++)
        if (named->hashes[i] != 0) *find_place(&larger, named->hashes[i]) = named->hashes[i];
    free(named->hashes);
    *named = larger;
    return true;
}

/* compare names a file once; many copies of an item would write one file as many times. */
static bool add_name(const JsonReader *json, Named *named, const ApprovalItem *item, Error *error) {
    const char *target = approval_target(item);
    uint64_t hash = hash_xxh3(target, strlen(target)), *place;
    if (hash == 0) hash = 1;
    if (!grow(named)) return error_memory(error, json->path);
    if (*(place = find_place(named, hash)) == hash) return json_read_error(json, error, "'%s' is there twice", target);
    *place = hash;
    named->count++;
    return true;
}

static bool read_items(JsonReader *json, const char *key, ApprovalList *list, Named *named, Error *error) {
    if (!json_read_char(json, '[')) return json_read_error(json, error, "'%s' must be an array", key);
    for (bool more = !json_read_char(json, ']'); more;) {
        ApprovalItem item = {0};
        const json_t *value = json_read_value(json, error);
        if (value == NULL || !read_item(json, value, &item, error)) return false;
        if (item.failed && !add_name(json, named, &item, error)) return false;
        if (item.failed && !add_item(list, item)) return error_memory(error, json->path);
        if (!json_read_more(json, ']', &more, error)) return false;
    }
    return true;
}

static bool read_member(JsonReader *json, int member, ApprovalList *list, Named *named, Error *error) {
    if (member == FRAMES || member == TRAJECTORIES) return read_items(json, members[member], list, named, error);
    const json_t *value = json_read_value(json, error);
    if (value == NULL || member == MEMBERS) return value != NULL;
    const char *text = read_text(json, value, members[member], PATH_MAX - 1, error);
    if (text == NULL) return false;
    if (member == FORMAT)
        return strcmp(text, "twinbox compare 1") == 0 ||
               json_read_error(json, error, "not a report of twinbox compare");
    strcpy(member == EXPECTED ? list->expected : list->actual, text);
    return true;
}

/* The next member's key and colon. *member is MEMBERS for a key that is not in the list. */
static bool read_key(JsonReader *json, bool seen[MEMBERS], int *member, Error *error) {
    const json_t *key = json_read_value(json, error);
    if (key == NULL) return false;
    if (!json_is_string(key)) return json_read_error(json, error, "a key must be a string");
    *member = 0;
    while (*member < MEMBERS && strcmp(json_string_value(key), members[*member]) != 0) ++*member;
    if (*member < MEMBERS && seen[*member]) return json_read_error(json, error, "duplicate key");
    if (*member < MEMBERS) seen[*member] = true;
    return json_read_char(json, ':') || json_read_error(json, error, "':' expected");
}

static bool read_list(JsonReader *json, ApprovalList *list, Named *named, Error *error) {
    bool seen[MEMBERS] = {false};
    if (!json_read_char(json, '{')) return json_read_error(json, error, "not a report of twinbox compare");
    for (bool more = true; more;) {
        int member = MEMBERS;
        if (!read_key(json, seen, &member, error) || !read_member(json, member, list, named, error) ||
            !json_read_more(json, '}', &more, error))
            return false;
    }
    if (!json_read_end(json, error)) return false;
    for (int i = 0; i < MEMBERS; i++)
        if (!seen[i])
            return error_input(error, json->path, "'%s' is missing: not a report of twinbox compare", members[i]);
    return true;
}

const char *approval_target(const ApprovalItem *item) {
    return item->expected.name[0] != '\0' ? item->expected.name : item->actual.name;
}

bool approval_read(ApprovalList *list, const char *path, Error *error) {
    JsonReader json;
    if (!json_read_open(&json, path, MAX_SIZE, error)) return false;
    *list = (ApprovalList){.count = 0};
    Named named = {0};
    bool ok = read_list(&json, list, &named, error);
    free(named.hashes);
    json_read_close(&json);
    if (!ok) approval_free(list);
    return ok;
}

void approval_free(ApprovalList *list) {
    for (size_t i = 0; i < list->count; i++) free_names(&list->items[i]);
    free(list->items);
}
