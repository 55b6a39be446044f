/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve.h"

#include "common/file.h"
#include "common/hash.h"
#include "report/approve_place.h"
#include "report/approve_read.h"

#include <errno.h>
#include <fcntl.h>
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

static bool inspect(const Place *place, Found *found, Error *error) {
    struct stat status;
    *found =
        (Found){.there = place->folder >= 0 && fstatat(place->folder, place->name, &status, AT_SYMLINK_NOFOLLOW) == 0};
    if (!found->there)
        return place->folder < 0 || errno == ENOENT ||
               error_system(error, place->path, "cannot be read: %s", strerror(errno));
    found->link = S_ISLNK(status.st_mode);
    found->other = !found->link && !S_ISREG(status.st_mode);
    if (found->link || found->other) return true;
    size_t size;
    char *data = file_read_at(place->folder, place->name, place->path, MAX_FILE_SIZE, &size, error);
    if (data == NULL) return false;
    found->hash = hash_xxh3(data, size);
    free(data);
    return true;
}

static bool inspect_below(const char *root, const char *name, Found *found, Error *error) {
    Place place;
    if (!place_open(&place, root, name, false, error)) return false;
    bool ok = inspect(&place, found, error);
    if (ok && (found->link || found->other))
        ok = error_input(error, place.path, "must be a regular file%s", found->link ? " (is a link)" : "");
    place_close(&place);
    return ok;
}

static bool as_reported(const Found *found, const ApprovalFile *file) {
    bool wanted = file->name[0] != '\0';
    return found->there == wanted && (!wanted || found->hash == file->hash);
}

static bool refuse_changed(const char *root, const char *name, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/%s", root, name) &&
           error_input(error, path, "has changed since the report was written; compare again");
}

static bool decide(const ApprovalList *list, const ApprovalItem *item, Action *action, Error *error) {
    Found expected, actual = {.there = false};
    if (!inspect_below(list->expected, approval_target(item), &expected, error)) return false;
    *action = ACTION_NONE;
    bool removed = item->actual.name[0] == '\0';
    if (removed ? !expected.there : expected.there && expected.hash == item->actual.hash) return true;
    if (!as_reported(&expected, &item->expected)) return refuse_changed(list->expected, approval_target(item), error);
    *action = removed ? ACTION_REMOVE : item->expected.name[0] == '\0' ? ACTION_ADD : ACTION_REPLACE;
    const char *name = removed ? item->expected.name : item->actual.name;
    return inspect_below(list->actual, name, &actual, error) &&
           (as_reported(&actual, &item->actual) || refuse_changed(list->actual, name, error));
}

/* Reads the actual file again and checks the hash of exactly the bytes that are written. */
static bool copy(const Place *source, uint64_t hash, const Place *target, Error *error) {
    size_t size;
    if (source->folder < 0) return error_input(error, source->path, "has changed during the approval");
    char *data = file_read_at(source->folder, source->name, source->path, MAX_FILE_SIZE, &size, error);
    bool ok = data != NULL &&
              (hash_xxh3(data, size) == hash || error_input(error, source->path, "has changed during the approval")) &&
              file_write_at(target->folder, target->name, target->path, data, size, error);
    free(data);
    return ok;
}

static bool copy_from(const ApprovalList *list, const ApprovalFile *actual, const Place *target, Error *error) {
    Place source;
    if (!place_open(&source, list->actual, actual->name, false, error)) return false;
    bool ok = copy(&source, actual->hash, target, error);
    place_close(&source);
    return ok;
}

static bool apply(const ApprovalList *list, const ApprovalItem *item, Action action,
                  void (*on_change)(const char *what, const char *path), Approval *approval, Error *error) {
    static const char *const words[] = {"", "replaced", "added", "removed"};
    int *counts[] = {&approval->already, &approval->replaced, &approval->added, &approval->removed};
    Place target;
    (*counts[action])++;
    if (action == ACTION_NONE) return true;
    if (!place_open(&target, list->expected, approval_target(item), action == ACTION_ADD, error)) return false;
    bool ok = target.folder >= 0 || error_input(error, target.path, "has changed during the approval");
    if (ok && action == ACTION_REMOVE)
        ok = unlinkat(target.folder, target.name, 0) == 0 ||
             error_system(error, target.path, "cannot be removed: %s", strerror(errno));
    else if (ok)
        ok = copy_from(list, &item->actual, &target, error);
    if (ok) on_change(words[action], target.path);
    place_close(&target);
    return ok;
}

static bool is_selected(const ApprovalItem *item, const char *only, Approval *approval) {
    bool matches = only == NULL || fnmatch(only, approval_target(item), 0) == 0 ||
                   fnmatch(only, item->actual.name, 0) == 0; /* home.png, where home.1.png is replaced */
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
