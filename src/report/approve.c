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
    *found = (Found){.there = false};
    if (place->folder < 0) return true;
    if (fstatat(place->folder, place->name, &status, AT_SYMLINK_NOFOLLOW) != 0)
        return errno == ENOENT || error_system(error, place->path, "cannot be read: %s", strerror(errno));
    found->there = true;
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

/* The folders stay open, so that all checks and changes are of the same two. */
typedef struct Folders {
    Root expected, actual;
} Folders;

static bool inspect_below(const Root *root, const char *name, Found *found, Error *error) {
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

static bool refuse_changed(const Root *root, const char *name, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/%s", root->path, name) &&
           error_input(error, path, "has changed since the report was written; compare again");
}

static bool decide(const Folders *folders, const ApprovalItem *item, Action *action, Error *error) {
    Found expected, actual = {.there = false};
    if (!inspect_below(&folders->expected, approval_target(item), &expected, error)) return false;
    *action = ACTION_NONE;
    bool removed = item->actual.name[0] == '\0';
    if (removed ? !expected.there : expected.there && expected.hash == item->actual.hash) return true;
    if (!as_reported(&expected, &item->expected))
        return refuse_changed(&folders->expected, approval_target(item), error);
    *action = removed ? ACTION_REMOVE : item->expected.name[0] == '\0' ? ACTION_ADD : ACTION_REPLACE;
    const char *name = removed ? item->expected.name : item->actual.name;
    return inspect_below(&folders->actual, name, &actual, error) &&
           (as_reported(&actual, &item->actual) || refuse_changed(&folders->actual, name, error));
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

static bool copy_from(const Folders *folders, const ApprovalFile *actual, const Place *target, Error *error) {
    Place source;
    if (!place_open(&source, &folders->actual, actual->name, false, error)) return false;
    bool ok = copy(&source, actual->hash, target, error);
    place_close(&source);
    return ok;
}

static bool apply(const Folders *folders, const ApprovalItem *item, Action action,
                  void (*on_change)(const char *what, const char *path), Approval *approval, Error *error) {
    static const char *const words[] = {"", "replaced", "added", "removed"};
    int *counts[] = {&approval->already, &approval->replaced, &approval->added, &approval->removed};
    Place target;
    (*counts[action])++;
    if (action == ACTION_NONE) return true;
    if (!place_open(&target, &folders->expected, approval_target(item), action == ACTION_ADD, error)) return false;
    bool ok = target.folder >= 0 || error_input(error, target.path, "has changed during the approval");
    if (ok && action == ACTION_REMOVE)
        ok = unlinkat(target.folder, target.name, 0) == 0 ||
             error_system(error, target.path, "cannot be removed: %s", strerror(errno));
    else if (ok)
        ok = copy_from(folders, &item->actual, &target, error);
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

static bool approve_list(const ApprovalList *list, const Folders *folders, const char *only,
                         void (*on_change)(const char *what, const char *path), Approval *approval, Error *error) {
    Action *actions = calloc(list->count + 1, sizeof *actions);
    if (actions == NULL) return error_memory(error, "approve");
    bool ok = true, *selected = calloc(list->count + 1, sizeof *selected);
    if (selected == NULL) ok = error_memory(error, "approve");
    for (size_t i = 0; ok && i < list->count; i++) {
        selected[i] = is_selected(&list->items[i], only, approval);
        ok = !selected[i] || decide(folders, &list->items[i], &actions[i], error);
    }
    for (size_t i = 0; ok && i < list->count; i++)
        if (selected[i]) ok = apply(folders, &list->items[i], actions[i], on_change, approval, error);
    free(selected);
    free(actions);
    return ok;
}

static bool open_expected(const ApprovalRequest *request, const ApprovalList *list, const char *report, Root *root,
                          Error *error) {
    return request->expected != NULL ? root_open(root, request->expected, error)
                                     : root_open_below(root, list->expected, report, error);
}

/* A foreign report chooses the folders: it may have any read, but only one below the current directory changed. */
static bool approve_in_folders(const ApprovalRequest *request, const ApprovalList *list, const char *report,
                               Approval *approval, Error *error) {
    Folders folders;
    if (!open_expected(request, list, report, &folders.expected, error)) return false;
    bool ok = root_open(&folders.actual, list->actual, error);
    if (ok) {
        ok = approve_list(list, &folders, request->only, request->on_change, approval, error);
        root_close(&folders.actual);
    }
    root_close(&folders.expected);
    return ok;
}

bool approve(const ApprovalRequest *request, Approval *approval, Error *error) {
    char path[PATH_MAX];
    ApprovalList list;
    *approval = (Approval){0};
    if (!file_path(path, sizeof path, error, "%s/results.json", request->report) || !approval_read(&list, path, error))
        return false;
    bool ok = approve_in_folders(request, &list, path, approval, error);
    approval_free(&list);
    return ok;
}
