/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve.h"

#include "common/file.h"
#include "common/hash.h"
#include "report/approve_read.h"

#include <errno.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What is read whole; a trajectory's limit. */
static const size_t MAX_FILE_SIZE = (size_t)2 << 30;

typedef enum Action { ACTION_NONE, ACTION_REPLACE, ACTION_ADD, ACTION_REMOVE } Action;

/* A regular file of this hash, or, with an empty name, none. */
typedef struct Found {
    bool there, link, other; /* other: neither a file nor a link */
    uint64_t hash;
} Found;

static bool look(const char *path, Found *found, Error *error) {
    struct stat status;
    *found = (Found){.there = lstat(path, &status) == 0};
    if (!found->there) return errno == ENOENT || error_input(error, path, "cannot be read: %s", strerror(errno));
    found->link = S_ISLNK(status.st_mode);
    found->other = !found->link && !S_ISREG(status.st_mode);
    if (found->link || found->other) return true;
    size_t size;
    char *data = file_read(path, MAX_FILE_SIZE, &size, error);
    if (data == NULL) return false;
    found->hash = hash_xxh3(data, size);
    free(data);
    return true;
}

static bool as_reported(const Found *found, const ApprovalFile *file) {
    bool wanted = file->name[0] != '\0';
    return found->there == wanted && (!wanted || found->hash == file->hash);
}

/* The expected file's name: that of the actual one where it is new. */
static const char *target_name(const ApprovalItem *item) {
    return item->expected.name[0] != '\0' ? item->expected.name : item->actual.name;
}

/* What is to be done, after all has been looked at. */
static bool decide(const ApprovalList *list, const ApprovalItem *item, Action *action, Error *error) {
    char target[PATH_MAX], source[PATH_MAX];
    Found expected, actual = {.there = false};
    if (!file_path(target, sizeof target, error, "%s/%s", list->expected, target_name(item)) ||
        !look(target, &expected, error))
        return false;
    if (expected.link || expected.other)
        return error_input(error, target, "is %s, and no file", expected.link ? "a link" : "something else");
    *action = ACTION_NONE;
    bool stays_away = item->actual.name[0] == '\0';
    if (stays_away ? !expected.there : expected.there && expected.hash == item->actual.hash) return true;
    if (!as_reported(&expected, &item->expected))
        return error_input(error, target, "is no longer what the report has shown; compare again");
    *action = stays_away ? ACTION_REMOVE : item->expected.name[0] == '\0' ? ACTION_ADD : ACTION_REPLACE;
    const char *name = stays_away ? item->expected.name : item->actual.name;
    if (!file_path(source, sizeof source, error, "%s/%s", list->actual, name) || !look(source, &actual, error))
        return false;
    if (actual.link) return error_input(error, source, "is a link, and no file");
    return as_reported(&actual, &item->actual) ||
           error_input(error, source, "is no longer what the report has shown; compare again");
}

/* Reads the actual file again: what is written is what has the hash. */
static bool copy(const char *source, uint64_t hash, const char *target, Error *error) {
    size_t size;
    char *data = file_read(source, MAX_FILE_SIZE, &size, error);
    bool ok = data != NULL &&
              (hash_xxh3(data, size) == hash || error_input(error, source, "has changed while it was approved")) &&
              file_write(target, data, size, error);
    free(data);
    return ok;
}

static bool carry_out(const ApprovalList *list, const ApprovalItem *item, Action action,
                      void (*told)(const char *what, const char *path), Approval *approval, Error *error) {
    static const char *const words[] = {"", "replaced", "added", "removed"};
    int *counts[] = {&approval->already, &approval->replaced, &approval->added, &approval->removed};
    char target[PATH_MAX], source[PATH_MAX];
    if (!file_path(target, sizeof target, error, "%s/%s", list->expected, target_name(item)) ||
        !file_path(source, sizeof source, error, "%s/%s", list->actual, item->actual.name))
        return false;
    if (action == ACTION_REMOVE && unlink(target) != 0)
        return error_system(error, target, "cannot be removed: %s", strerror(errno));
    if ((action == ACTION_REPLACE || action == ACTION_ADD) && !copy(source, item->actual.hash, target, error))
        return false;
    (*counts[action])++;
    if (action != ACTION_NONE) told(words[action], target);
    return true;
}

static bool is_asked(const ApprovalItem *item, const char *only, Approval *approval) {
    bool matches = only == NULL || fnmatch(only, target_name(item), 0) == 0;
    approval->not_asked += !matches;
    approval->not_shown += matches && !item->shown;
    return matches && item->shown;
}

static bool approve_list(const ApprovalList *list, const char *only, void (*told)(const char *what, const char *path),
                         Approval *approval, Error *error) {
    Action *actions = malloc((list->count + 1) * sizeof *actions);
    if (actions == NULL) return error_memory(error, "approve");
    bool ok = true, *asked = malloc(list->count + 1);
    if (asked == NULL) ok = error_memory(error, "approve");
    for (size_t i = 0; ok && i < list->count; i++) {
        asked[i] = is_asked(&list->items[i], only, approval);
        ok = !asked[i] || decide(list, &list->items[i], &actions[i], error);
    }
    for (size_t i = 0; ok && i < list->count; i++)
        if (asked[i]) ok = carry_out(list, &list->items[i], actions[i], told, approval, error);
    free(asked);
    free(actions);
    return ok;
}

bool approve(const char *report, const char *only, void (*told)(const char *what, const char *path), Approval *approval,
             Error *error) {
    char path[PATH_MAX];
    ApprovalList list;
    *approval = (Approval){0};
    if (!file_path(path, sizeof path, error, "%s/results.json", report) || !approval_read(&list, path, error))
        return false;
    bool ok = approve_list(&list, only, told, approval, error);
    approval_free(&list);
    return ok;
}
