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

/* The limit of a trajectory file. */
static const size_t MAX_FILE_SIZE = (size_t)2 << 30;

typedef enum Action { ACTION_NONE, ACTION_REPLACE, ACTION_ADD, ACTION_REMOVE } Action;

typedef struct Found {
    bool there, link, other; /* other: neither a regular file nor a link */
    uint64_t hash;
} Found;

static bool inspect(const char *path, Found *found, Error *error) {
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

/* The name of the expected file; if that is new, of the actual one. */
static const char *target_name(const ApprovalItem *item) {
    return item->expected.name[0] != '\0' ? item->expected.name : item->actual.name;
}

static bool decide(const ApprovalList *list, const ApprovalItem *item, Action *action, Error *error) {
    char target[PATH_MAX], source[PATH_MAX];
    Found expected, actual = {.there = false};
    if (!file_path(target, sizeof target, error, "%s/%s", list->expected, target_name(item)) ||
        !inspect(target, &expected, error))
        return false;
    if (expected.link || expected.other)
        return error_input(error, target, "must be a regular file%s", expected.link ? " (is a link)" : "");
    *action = ACTION_NONE;
    bool removed = item->actual.name[0] == '\0';
    if (removed ? !expected.there : expected.there && expected.hash == item->actual.hash) return true;
    if (!as_reported(&expected, &item->expected))
        return error_input(error, target, "has changed since the report was written; compare again");
    *action = removed ? ACTION_REMOVE : item->expected.name[0] == '\0' ? ACTION_ADD : ACTION_REPLACE;
    const char *name = removed ? item->expected.name : item->actual.name;
    if (!file_path(source, sizeof source, error, "%s/%s", list->actual, name) || !inspect(source, &actual, error))
        return false;
    if (actual.link) return error_input(error, source, "must be a regular file (is a link)");
    return as_reported(&actual, &item->actual) ||
           error_input(error, source, "has changed since the report was written; compare again");
}

/* Reads the actual file again and checks the hash of exactly the bytes that are written. */
static bool copy(const char *source, uint64_t hash, const char *target, Error *error) {
    size_t size;
    char *data = file_read(source, MAX_FILE_SIZE, &size, error);
    bool ok = data != NULL &&
              (hash_xxh3(data, size) == hash || error_input(error, source, "has changed during the approval")) &&
              file_write(target, data, size, error);
    free(data);
    return ok;
}

static bool apply(const ApprovalList *list, const ApprovalItem *item, Action action,
                  void (*on_change)(const char *what, const char *path), Approval *approval, Error *error) {
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
    if (action != ACTION_NONE) on_change(words[action], target);
    return true;
}

static bool is_selected(const ApprovalItem *item, const char *only, Approval *approval) {
    bool matches = only == NULL || fnmatch(only, target_name(item), 0) == 0;
    approval->not_selected += !matches;
    approval->not_shown += matches && !item->shown;
    return matches && item->shown;
}

static bool approve_list(const ApprovalList *list, const char *only,
                         void (*on_change)(const char *what, const char *path), Approval *approval, Error *error) {
    Action *actions = calloc(list->count + 1, sizeof *actions);
    if (actions == NULL) return error_memory(error, "approve");
    bool ok = true, *selected = calloc(list->count + 1, sizeof *selected);
    if (selected == NULL) ok = error_memory(error, "approve");
    for (size_t i = 0; ok && i < list->count; i++) {
        selected[i] = is_selected(&list->items[i], only, approval);
        ok = !selected[i] || decide(list, &list->items[i], &actions[i], error);
    }
    for (size_t i = 0; ok && i < list->count; i++)
        if (selected[i]) ok = apply(list, &list->items[i], actions[i], on_change, approval, error);
    free(selected);
    free(actions);
    return ok;
}

bool approve(const char *report, const char *only, void (*on_change)(const char *what, const char *path),
             Approval *approval, Error *error) {
    char path[PATH_MAX];
    ApprovalList list;
    *approval = (Approval){0};
    if (!file_path(path, sizeof path, error, "%s/results.json", report) || !approval_read(&list, path, error))
        return false;
    bool ok = approve_list(&list, only, on_change, approval, error);
    approval_free(&list);
    return ok;
}
