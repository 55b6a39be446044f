/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Approval: folders in which no link is followed, the list of results.json, and the changes. */
#include "regression/approve.h"

#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "regression/sequence.h"

#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Folders and the files below them, held by descriptors of their directories, so that no link leads out of a folder,
   even if one is made meanwhile. */

typedef struct Root {
    int folder;       /* an open directory */
    const char *path; /* of the caller, for messages */
} Root;

typedef struct Place {
    int folder;          /* an open directory; -1 if there is no such folder */
    const char *name;    /* in it; points into the relative name */
    char path[PATH_MAX]; /* for messages */
} Place;

enum { OPEN_FOLDER = O_RDONLY | O_DIRECTORY | O_CLOEXEC };

/* Whether the path is to blame, not the system. */
static bool is_input(int cause) {
    return cause == ELOOP || cause == ENOTDIR || cause == EACCES || cause == ENOENT || cause == ENAMETOOLONG;
}

static bool refuse(int cause, const char *path, const char *what, Error *error) {
    return is_input(cause) ? error_input(error, path, "%s: %s", what, strerror(cause))
                           : error_system(error, path, "%s: %s", what, strerror(cause));
}

/* Steps from an open folder into each folder of *path that ends with a slash; *path moves behind the last. Closes the
   first. create: makes those that are missing. */
static int walk(int folder, const char **path, bool create) {
    for (const char *slash; folder >= 0 && (slash = strchr(*path, '/')) != NULL; *path = slash + 1) {
        char part[NAME_MAX + 1];
        const size_t length = (size_t)(slash - *path);
        if (length >= sizeof part) {
            close(folder);
            errno = ENAMETOOLONG;
            return -1;
        }
        memcpy(part, *path, length);
        part[length] = '\0';
        if (length == 0 || strcmp(part, ".") == 0) continue;
        int next = openat(folder, part, OPEN_FOLDER | O_NOFOLLOW);
        if (next < 0 && errno == ENOENT && create && (mkdirat(folder, part, 0777) == 0 || errno == EEXIST))
            next = openat(folder, part, OPEN_FOLDER | O_NOFOLLOW);
        const int cause = errno;
        close(folder);
        errno = cause;
        folder = next;
    }
    return folder;
}

/* Opens a folder that the user named, or one that is only read: links in `path` are followed. */
static bool root_open(Root *root, const char *path, Error *error) {
    *root = (Root){open(path, OPEN_FOLDER), path};
    if (root->folder >= 0) return true;
    return refuse(errno, path, "the folder cannot be opened", error);
}

const char *path_below_current(const char *path) {
    char current[PATH_MAX];
    if (path[0] == '/') {
        const size_t length = getcwd(current, sizeof current) != NULL ? strlen(current) : 0;
        if (length < 2 || strncmp(path, current, length) != 0 || (path[length] != '/' && path[length] != '\0'))
            return NULL;
        path += length + strspn(path + length, "/");
    }
    for (const char *part = path; (part = strstr(part, "..")) != NULL; part += 2)
        if ((part == path || part[-1] == '/') && (part[2] == '/' || part[2] == '\0')) return NULL;
    return path;
}

/* Opens a folder that a file named: ERROR_INPUT unless it lies below the current directory, without links on the way.
   report: that file, for messages. */
static bool root_open_below(Root *root, const char *path, const char *report, Error *error) {
    char whole[PATH_MAX];
    const char *relative = path_below_current(path), *rest = whole;
    *root = (Root){-1, path};
    if (relative == NULL)
        return error_input(error, report,
                           "the expected folder '%.1000s' is not below the current directory; if it is "
                           "the one to change, state it: --expected DIR",
                           path);
    if (!file_path(whole, sizeof whole, error, "%s/", relative)) return false;
    root->folder = walk(open(".", OPEN_FOLDER), &rest, false);
    if (root->folder >= 0) return true;
    const int cause = errno;
    return is_input(cause) ? error_input(error, report,
                                         "the expected folder '%.1000s' cannot be opened without following links: "
                                         "%s; if it is the one to change, state it: --expected DIR",
                                         path, strerror(cause))
                           : error_system(error, path, "the folder cannot be opened: %s", strerror(cause));
}

/* Opens the directory of `name` in the root; `name` is relative, without "." and "..". create: makes the folders that
   are missing. ERROR_INPUT if one is a link or no folder. After success, place_close(). */
static bool place_open(Place *place, const Root *root, const char *name, bool create, Error *error) {
    if (!file_path(place->path, sizeof place->path, error, "%s/%s", root->path, name)) return false;
    place->name = name;
    place->folder = walk(fcntl(root->folder, F_DUPFD_CLOEXEC, 0), &place->name, create);
    if (place->folder >= 0 || errno == ENOENT) return true;
    return refuse(errno, place->path,
                  is_input(errno) ? "its folder cannot be opened, or is a link" : "its folder cannot be opened", error);
}

static void place_close(const Place *place) {
    if (place->folder >= 0) close(place->folder);
}

enum { MAX_SIZE = 1 << 25 };

/* The required members. Others (verdict, tolerance, masks) are skipped. */
enum { FORMAT, EXPECTED_FOLDER, ACTUAL_FOLDER, FRAMES, TRAJECTORIES, MEMBERS };
static const char *const members[MEMBERS] = {"format", "expected", "actual", "frames", "trajectories"};

/* "x.png" or "sub/x.png": no part is empty or hidden, which includes "." and "..". */
static bool is_name_below(const char *name) {
    const char *ending = strrchr(name, '.');
    char before = '/';
    for (const char *c = name; *c != '\0'; before = *c++)
        if (before == '/' && (*c == '/' || *c == '.')) return false;
    return ending != NULL &&
           (strcasecmp(ending, ".png") == 0 || strcmp(ending, ".npz") == 0 || strcmp(ending, ".csv") == 0);
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
static bool read_file(const JsonReader *json, const json_t *item, const char *key, bool shown, ApprovalFile *file,
                      Error *error) {
    const json_t *value = json_object_get(item, key);
    *file = (ApprovalFile){.name = NULL};
    if (value == NULL || json_is_null(value)) return true;
    if (!json_is_object(value)) return json_read_error(json, error, "'%s' must be null or a file", key);
    const char *name = read_text(json, json_object_get(value, "name"), "name", PATH_MAX - 1, error);
    if (name == NULL) return false;
    if (!name_is_text(name) || (shown && !is_name_below(name))) /* what is not shown is not approved, whatever it is */
        return json_read_error(json, error, "a name must end with .png, .npz or .csv and lie below the folder");
    const char *digits = json_string_value(json_object_get(value, "xxh3"));
    if (digits == NULL || strlen(digits) != 16 || strspn(digits, "0123456789abcdef") != 16)
        return json_read_error(json, error, "a hash must have 16 digits from 0 to f");
    file->hash = strtoull(digits, NULL, 16);
    file->name = strdup(name); /* the value does not last */
    return file->name != NULL || error_memory(error, json->path);
}

static void free_names(const ApprovalItem *item) {
    free(item->expected.name);
    free(item->actual.name);
    free(item->verdicts);
}

void approval_free(ApprovalList *list) {
    for (size_t i = 0; i < list->count; i++) free_names(&list->items[i]);
    free(list->items);
}

static bool read_items(JsonReader *json, const char *key, ApprovalList *list, Error *error) {
    if (!json_read_char(json, '[')) return json_read_error(json, error, "'%s' must be an array", key);
    for (bool more = !json_read_char(json, ']'); more;) {
        ApprovalItem item = {0};
        const json_t *value = json_read_value(json, error);
        bool ok = value != NULL &&
                  (json_is_object(value) || json_read_error(json, error, "a frame or trajectory must be an object")) &&
                  read_flag(json, value, "failed", &item.failed, error) &&
                  read_flag(json, value, "shown", &item.shown, error) &&
                  read_file(json, value, "expected", item.shown, &item.expected, error) &&
                  read_file(json, value, "actual", item.shown, &item.actual, error);
        const char *verdicts = json_string_value(json_object_get(value, "verdicts"));
        if (ok && verdicts != NULL) ok = (item.verdicts = strdup(verdicts)) != NULL || error_memory(error, json->path);
        ok = ok && (item.expected.name != NULL || item.actual.name != NULL ||
                    json_read_error(json, error, "an expected or an actual file is required"));
        if (ok && item.failed && array_reserve((void **)&list->items, &list->capacity, list->count + 1, sizeof item)) {
            list->items[list->count++] = item;
        } else {
            free_names(&item);
            if (!ok || item.failed) return ok ? error_memory(error, json->path) : false;
        }
        if (!json_read_more(json, ']', &more, error)) return false;
    }
    return true;
}

static bool read_list(JsonReader *json, ApprovalList *list, Error *error) {
    bool seen[MEMBERS] = {false};
    if (!json_read_char(json, '{')) return json_read_error(json, error, "not a report of twinbox compare");
    for (bool more = true; more;) {
        const json_t *value = json_read_value(json, error); /* the key */
        int member = 0;
        if (value == NULL) return false;
        if (!json_is_string(value)) return json_read_error(json, error, "a key must be a string");
        while (member < MEMBERS && strcmp(json_string_value(value), members[member]) != 0) member++;
        if (member < MEMBERS && seen[member]) return json_read_error(json, error, "duplicate key");
        if (member < MEMBERS) seen[member] = true;
        if (!json_read_char(json, ':')) return json_read_error(json, error, "':' expected");
        if (member == FRAMES || member == TRAJECTORIES) {
            if (!read_items(json, members[member], list, error)) return false;
        } else if ((value = json_read_value(json, error)) == NULL) {
            return false;
        } else if (member < MEMBERS) {
            const char *text = read_text(json, value, members[member], PATH_MAX - 1, error);
            if (text == NULL) return false;
            if (member == FORMAT && strcmp(text, "twinbox compare 1") != 0)
                return json_read_error(json, error, "not a report of twinbox compare");
            if (member != FORMAT) strcpy(member == EXPECTED_FOLDER ? list->expected : list->actual, text);
        }
        if (!json_read_more(json, '}', &more, error)) return false;
    }
    if (!json_read_end(json, error)) return false;
    for (int i = 0; i < MEMBERS; i++)
        if (!seen[i])
            return error_input(error, json->path, "'%s' is missing: not a report of twinbox compare", members[i]);
    return true;
}

/* The name of the expected file; if that is new, of the actual one. */
static const char *target_of(const ApprovalItem *item) {
    return item->expected.name != NULL ? item->expected.name : item->actual.name;
}

static int by_target(const void *a, const void *b) {
    const ApprovalItem *const *x = a, *const *y = b;
    return strcmp(target_of(*x), target_of(*y));
}

bool approval_read(ApprovalList *list, const char *path, Error *error) {
    JsonReader json;
    if (!json_read_open(&json, path, MAX_SIZE, error)) return false;
    *list = (ApprovalList){.count = 0};
    bool ok = read_list(&json, list, error);
    json_read_close(&json);
    /* compare names a file once; many copies of an item would write one file as many times. */
    const ApprovalItem **items = malloc((list->count + 1) * sizeof *items);
    ok = ok && (items != NULL || error_memory(error, path));
    for (size_t i = 0; ok && i < list->count; i++) items[i] = &list->items[i];
    if (ok) qsort(items, list->count, sizeof *items, by_target);
    for (size_t i = 1; ok && i < list->count; i++)
        if (by_target(&items[i - 1], &items[i]) == 0)
            ok = error_input(error, path, "'%s' is there twice", target_of(items[i]));
    free(items);
    if (!ok) approval_free(list);
    return ok;
}

/* The limit of a trajectory file. */
static const size_t MAX_FILE_SIZE = (size_t)2 << 30;

typedef enum Action { ACTION_NONE, ACTION_REPLACE, ACTION_ADD, ACTION_REMOVE, ACTION_NOT_SELECTED } Action;

typedef struct Found {
    bool there;
    uint64_t hash;
} Found;

/* The folders stay open, so that all checks and changes are of the same two. */
typedef struct Folders {
    Root expected, actual;
} Folders;

/* A regular file of this name, or none. */
static bool inspect(const Root *root, const char *name, Found *found, Error *error) {
    Place place;
    struct stat status;
    *found = (Found){.there = false};
    if (!place_open(&place, root, name, false, error)) return false;
    bool ok = true;
    if (place.folder >= 0 && fstatat(place.folder, place.name, &status, AT_SYMLINK_NOFOLLOW) != 0) {
        ok = errno == ENOENT || error_system(error, place.path, "cannot be read: %s", strerror(errno));
    } else if (place.folder >= 0 && !S_ISREG(status.st_mode)) {
        ok = error_input(error, place.path, "must be a regular file%s", S_ISLNK(status.st_mode) ? " (is a link)" : "");
    } else if (place.folder >= 0) {
        size_t size;
        char *data = file_read_at(place.folder, place.name, place.path, MAX_FILE_SIZE, &size, error);
        ok = found->there = data != NULL;
        if (ok) found->hash = hash_xxh3(data, size);
        free(data);
    }
    place_close(&place);
    return ok;
}

static bool as_reported(const Found *found, const ApprovalFile *file) {
    bool wanted = file->name != NULL;
    return found->there == wanted && (!wanted || found->hash == file->hash);
}

static bool refuse_changed(const Root *root, const char *name, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/%s", root->path, name) &&
           error_input(error, path, "has changed since the report was written; compare again");
}

static bool decide(const Folders *folders, const ApprovalItem *item, Action *action, Error *error) {
    Found expected, actual = {.there = false};
    if (!inspect(&folders->expected, target_of(item), &expected, error)) return false;
    *action = ACTION_NONE;
    bool removed = item->actual.name == NULL;
    if (removed ? !expected.there : expected.there && expected.hash == item->actual.hash) return true;
    if (!as_reported(&expected, &item->expected)) return refuse_changed(&folders->expected, target_of(item), error);
    *action = removed ? ACTION_REMOVE : item->expected.name == NULL ? ACTION_ADD : ACTION_REPLACE;
    const char *name = removed ? item->expected.name : item->actual.name;
    return inspect(&folders->actual, name, &actual, error) &&
           (as_reported(&actual, &item->actual) || refuse_changed(&folders->actual, name, error));
}

#define CHANGED "has changed during the approval"

/* Reads the actual file again and checks the hash of exactly the bytes that are written. */
static bool apply(const Folders *folders, const ApprovalItem *item, Action action, const ApprovalRequest *request,
                  Approval *approval, Error *error) {
    static const char *const words[] = {"", "replaced", "added", "removed"};
    int *counts[] = {&approval->already, &approval->replaced, &approval->added, &approval->removed};
    Place target, source = {.folder = -1};
    (*counts[action])++;
    if (action == ACTION_NONE) return true;
    if (!place_open(&target, &folders->expected, target_of(item), action == ACTION_ADD, error)) return false;
    bool ok = target.folder >= 0 || error_input(error, target.path, CHANGED);
    if (ok && action == ACTION_REMOVE) {
        ok = unlinkat(target.folder, target.name, 0) == 0 ||
             error_system(error, target.path, "cannot be removed: %s", strerror(errno));
    } else if (ok && (ok = place_open(&source, &folders->actual, item->actual.name, false, error))) {
        size_t size;
        char *data = source.folder < 0
                         ? (error_input(error, source.path, CHANGED), NULL)
                         : file_read_at(source.folder, source.name, source.path, MAX_FILE_SIZE, &size, error);
        ok = data != NULL && (hash_xxh3(data, size) == item->actual.hash || error_input(error, source.path, CHANGED)) &&
             file_write_at(target.folder, target.name, target.path, data, size, error);
        free(data);
    }
    place_close(&source);
    if (ok) request->on_change(words[action], target.path, item->verdicts);
    place_close(&target);
    return ok;
}

/* Whether the request is about the item; counts why it is not. home.png also selects home.1.png, where that is
   replaced. */
static bool is_selected(const ApprovalItem *item, const ApprovalRequest *request, Approval *approval) {
    const char *only = request->only, *actual = item->actual.name;
    const bool matches =
        only == NULL || fnmatch(only, target_of(item), 0) == 0 || (actual != NULL && fnmatch(only, actual, 0) == 0);
    const bool kept = matches && request->missing == MISSING_KEPT && actual == NULL;
    approval->not_selected += !matches;
    approval->kept += kept;
    approval->not_shown += matches && !kept && !item->shown;
    return matches && !kept && item->shown;
}

/* Decides about all files before it changes the first. */
static bool approve_list(const ApprovalList *list, const Folders *folders, const ApprovalRequest *request,
                         Approval *approval, Error *error) {
    enum { NAMED = 5 };
    char names[1024] = "";
    int removed = 0;
    Action *actions = calloc(list->count + 1, sizeof *actions);
    bool ok = actions != NULL || error_memory(error, "approve");
    for (size_t i = 0; ok && i < list->count; i++) {
        const ApprovalItem *item = &list->items[i];
        actions[i] = ACTION_NOT_SELECTED;
        if (is_selected(item, request, approval)) ok = decide(folders, item, &actions[i], error);
        if (actions[i] == ACTION_REMOVE && removed++ < NAMED)
            text_join(names, sizeof names, ", ", "%.100s", target_of(item));
    }
    if (ok && request->only != NULL && list->count > 0 && approval->not_selected == (int)list->count)
        ok = error_input(error, "--only", "'%s' matches none of the %zu files that failed", request->only, list->count);
    /* Nobody knows here whether what is missing is gone, or was only not drawn this time. */
    if (removed > NAMED) text_join(names, sizeof names, ", ", "and %d more", removed - NAMED);
    if (ok && request->missing == MISSING_REFUSED && removed > 0)
        ok = error_input(error, request->report,
                         "%d expected file%s no actual one: %s; --partial keeps, --remove removes such files", removed,
                         removed == 1 ? " has" : "s have", names);
    for (size_t i = 0; ok && i < list->count; i++)
        if (actions[i] != ACTION_NOT_SELECTED)
            ok = apply(folders, &list->items[i], actions[i], request, approval, error);
    free(actions);
    return ok;
}

/* A foreign report chooses the folders: it may have any read, but only one below the current directory changed. */
bool approve(const ApprovalRequest *request, Approval *approval, Error *error) {
    char path[PATH_MAX];
    ApprovalList list;
    Folders folders;
    *approval = (Approval){0};
    if (!file_path(path, sizeof path, error, "%s/results.json", request->report) || !approval_read(&list, path, error))
        return false;
    bool ok = request->expected != NULL ? root_open(&folders.expected, request->expected, error)
                                        : root_open_below(&folders.expected, list.expected, path, error);
    if (ok) {
        ok = root_open(&folders.actual, list.actual, error);
        if (ok) {
            ok = approve_list(&list, &folders, request, approval, error);
            close(folders.actual.folder);
        }
        close(folders.expected.folder);
    }
    approval_free(&list);
    return ok;
}
