/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of output paths. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "cli/output_checks.h"

#include <errno.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { KIND_SIZE = 64 };

/* Makes a file that goes at once: permissions alone do not tell, as for root, full tables or /proc. `folder` ends in a
   slash or is empty. */
static bool try_folder(const char *folder, const char *path, Error *error) {
    char inside[PATH_MAX];
    if (!file_path(inside, sizeof inside, error, "%sfile", folder)) return false;
    Error failure = {0};
    const int file = file_draft(inside, &failure);
    if (file < 0) return error_system(error, path, "cannot write: %s", file_make_cause(inside, errno));
    close(file);
    return true;
}

bool output_check_file(const char *path, const char *ending, Error *error) {
    struct stat status;
    char folder[PATH_MAX];
    if (path_is_standard(path)) return true;
    const bool there = stat(path, &status) == 0;
    if (there && S_ISDIR(status.st_mode)) return error_input(error, path, "is a folder; expected the name of a file");
    if (there && (!S_ISREG(status.st_mode) || standard_output_is(&status))) return true;
    if (ending != NULL && !file_name_ends_with(path, ending))
        return error_input(error, path, "the name must end in %s", ending);
    return file_path(folder, sizeof folder, error, "%.*s", (int)file_folder_length(path), path) &&
           try_folder(folder, path, error);
}

bool output_check_npz(const char *path, const char *kind, Error *error) {
    struct stat status;
    char found[KIND_SIZE];
    if (!output_check_file(path, ".npz", error)) return false;
    if (path_is_standard(path) || stat(path, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0 ||
        standard_output_is(&status))
        return true;
    /* What the file holds: "unknown" if it is not an .npz file. */
    Error failure = {0};
    NpzFile *file = npz_open(path, &failure);
    snprintf(found, KIND_SIZE, "unknown");
    if (file != NULL && !npz_has(file, "kind") && npz_has(file, "position")) snprintf(found, KIND_SIZE, "run");
    if (file != NULL && npz_has(file, "kind") && !npz_read_name(file, "kind", found, KIND_SIZE, &failure))
        snprintf(found, KIND_SIZE, "unknown");
    npz_close(file);
    if (failure.kind == ERROR_SYSTEM) {
        *error = failure;
        return false;
    }
    if (strcmp(found, kind != NULL ? kind : "run") == 0) return true;
    return error_input(error, path,
                       "holds a file of kind '%s', which a file of kind '%s' does not replace; choose another "
                       "name, or remove it",
                       found, kind != NULL ? kind : "run");
}

bool output_check_folder(const char *path, Error *error) {
    struct stat status;
    char folder[PATH_MAX];
    if (!output_check_folder_name(path, error)) return false;
    if (!file_path(folder, sizeof folder - 1, error, "%s", path)) return false;
    size_t length = strlen(folder);
    while (length > 0 && stat(folder, &status) != 0) {
        if (errno == ENOTDIR) return error_system(error, path, "cannot write: a part of the path is not a folder");
        while (length > 0 && folder[length - 1] == '/') length--;
        while (length > 0 && folder[length - 1] != '/') length--;
        folder[length] = '\0';
    }
    if (length > 0 && !S_ISDIR(status.st_mode))
        return error_system(error, path, "cannot write: '%s' is not a folder", folder);
    if (length > 0 && folder[length - 1] != '/') strcat(folder, "/");
    return try_folder(folder, path, error);
}

bool output_check_folder_name(const char *path, Error *error) {
    static const char *const endings[] = {".png", ".svg",  ".pdf", ".html", ".csv",  ".json",
                                          ".npz", ".yaml", ".md",  ".mp4",  ".webm", ".gif"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (file_name_ends_with(path, endings[i]))
            return error_input(error, path, "is the name of a file; expected that of a folder, such as %.*s",
                               (int)(strlen(path) - strlen(endings[i])), path);
    return true;
}
