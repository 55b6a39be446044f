/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames of an earlier sequence in the folder, which could be mistaken for frames of this one. */
#include "base/base.h"
#include "base/file.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The manifest on disk: its journal, and what remains valid of an earlier one. */

/* A line ends in `"pixels": "16 digits", "file_hash": "16 digits"}`. */
enum { FILE_FROM_END = 16 + 2, PIXELS_FROM_END = FILE_FROM_END + 16 + 17 };

/* The start of every manifest. */
static const char signature[] = "{\n  \"twinbox\": \"";

static char *join(const char *directory, const char *name) {
    size_t size = strlen(directory) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s/%s", directory, name);
    return path;
}

bool manifest_open(Manifest *manifest, const Picture *picture, const RenderOptions *options, const MomentPlan *plan,
                   int first, int last, Error *error) {
    size_t size, count = (size_t)(last - first) + 1;
    *manifest =
        (Manifest){.picture = picture, .options = options, .plan = plan, .first = first, .last = last, .out = -1};
    manifest->path = join(options->directory, "manifest.json");
    manifest->journal = join(options->directory, "manifest.json.part");
    manifest->head = file_print(manifest_print_head, manifest, &size);
    manifest->hashes = calloc(count, sizeof *manifest->hashes);
    manifest->known = calloc(count, sizeof *manifest->known);
    return (manifest->path != NULL && manifest->journal != NULL && manifest->head != NULL && manifest->hashes != NULL &&
            manifest->known != NULL) ||
           error_memory(error, options->directory);
}

void manifest_close(Manifest *manifest) {
    if (manifest->out >= 0) close(manifest->out);
    free(manifest->path);
    free(manifest->journal);
    free(manifest->head);
    free(manifest->hashes);
    free(manifest->known);
}

/* The number after "frame_", or -1. */
static int index_of(const char *line) {
    static const char start[] = "{\"file\": \"frame_";
    if (strncmp(line, start, sizeof start - 1) != 0 || !isdigit((unsigned char)line[sizeof start - 1])) return -1;
    long index = strtol(line + sizeof start - 1, NULL, 10);
    return index <= INT32_MAX ? (int)index : -1;
}

/* The index of the frame that a line, without indentation and comma, lists, and its hashes as far as the line has any;
   -1: the line lists no frame. */
static int manifest_line_read(const char *line, size_t length, PictureHashes *hashes) {
    if (length < PIXELS_FROM_END) return -1;
    const char *end = line + length;
    *hashes = (PictureHashes){strtoull(end - PIXELS_FROM_END, NULL, 16), strtoull(end - FILE_FROM_END, NULL, 16)};
    return index_of(line);
}

/* Takes the hashes from a line, if the line equals the expected one with these hashes. */
static void recall_line(Manifest *manifest, const char *line, size_t length) {
    PictureHashes hashes;
    int index = manifest_line_read(line, length, &hashes);
    if (index < manifest->first || index > manifest->last) return;
    size_t size;
    char *expected = file_print(manifest_print_line, &(ManifestLine){manifest, index, hashes}, &size);
    /* `expected` ends with a newline. */
    if (expected != NULL && size == length + 1 && memcmp(expected, line, length) == 0) {
        manifest->hashes[index - manifest->first] = hashes;
        manifest->known[index - manifest->first] = true;
    }
    free(expected);
}

/* An incomplete last line was cut off by a kill and is ignored. */
static void recall_lines(Manifest *manifest, char *text) {
    for (char *line = text, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        while (*line == ' ') line++;
        size_t length = (size_t)(end - line);
        if (length > 0 && line[length - 1] == ',') length--;
        line[length] = '\0';
        recall_line(manifest, line, length);
    }
}

static int line_of_difference(const char *a, const char *b) {
    int line = 1;
    for (; *a == *b && *a != '\0'; a++, b++) line += *a == '\n';
    return line;
}

/* False, with `why` set, if the file is missing or of other pictures. */
static bool recall_file(Manifest *manifest, const char *path, char *why, size_t why_size) {
    Error error = {0};
    size_t size, head = strlen(manifest->head), count = (size_t)(manifest->last - manifest->first) + 1;
    char *text = file_read(path, head + 2 * (count + 1) * MANIFEST_LINE_SIZE, &size, &error);
    bool same = text != NULL && strncmp(text, manifest->head, head) == 0;
    if (same)
        recall_lines(manifest, text + head);
    else if (text != NULL)
        snprintf(why, why_size, "%s:%d differs: other runs, options or version", path,
                 line_of_difference(text, manifest->head));
    else
        snprintf(why, why_size, "%s", error.message);
    free(text);
    return same;
}

void manifest_recall(Manifest *manifest, char *why, size_t size) {
    char other[256];
    manifest->valid = recall_file(manifest, manifest->path, why, size);
    bool grows = access(manifest->journal, F_OK) == 0 && recall_file(manifest, manifest->journal, other, sizeof other);
    if (manifest->valid || grows) why[0] = '\0';
}

/* Reads at most `size` characters; -1 if it fails. */
static ssize_t read_start(int file, char *text, size_t size) {
    size_t used = 0;
    while (used < size) {
        const ssize_t got = read(file, text + used, size - used);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        used += (size_t)got;
    }
    return (ssize_t)used;
}

/* A file that is not a manifest belongs to the user and must not be overwritten. */
static bool check_overwritable(const char *path, Error *error) {
    struct stat status;
    char text[sizeof signature] = "";
    if (lstat(path, &status) != 0)
        return errno == ENOENT || error_system(error, path, "cannot be inspected: %s", strerror(errno));
    int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    const ssize_t size = file >= 0 ? read_start(file, text, sizeof text - 1) : -1;
    const int cause = size < 0 ? errno : 0;
    if (file >= 0) close(file);
    if (cause_is_system(cause)) return cause_error(cause, path, error);
    if (size == 0 && S_ISREG(status.st_mode)) return true;
    return (size > 0 && strcmp(text, signature) == 0) ||
           error_input(error, path, "is not a manifest of twinbox; move it away or choose another folder");
}

bool manifest_check(const Manifest *manifest, Error *error) {
    return check_overwritable(manifest->path, error) && check_overwritable(manifest->journal, error);
}

static bool stale_remove(const Manifest *manifest, Error *error);

bool manifest_begin(Manifest *manifest, bool whole, Error *error) {
    if (!manifest_check(manifest, error)) return false;
    if (whole && !stale_remove(manifest, error)) return false;
    size_t size;
    char *text = file_print(manifest_print_journal, manifest, &size);
    bool ok =
        text != NULL ? file_write_soon(manifest->journal, text, size, error) : error_memory(error, manifest->journal);
    free(text);
    if (!ok) return false;
    if (!manifest->valid && !file_remove(manifest->path, error)) return false;
    manifest->out = open(manifest->journal, O_WRONLY | O_APPEND | O_NOFOLLOW | O_NOCTTY | O_CLOEXEC);
    return manifest->out >= 0 || error_system(error, manifest->journal, "cannot write: %s", strerror(errno));
}

bool manifest_add(Manifest *manifest, int index, PictureHashes hashes, Error *error) {
    int i = index - manifest->first;
    const PictureHashes *old = &manifest->hashes[i];
    if (manifest->known[i] && old->pixels == hashes.pixels && old->file == hashes.file) return true;
    manifest->hashes[i] = hashes;
    manifest->known[i] = true;
    if (manifest->out < 0) return true;
    size_t size;
    char *line = file_print(manifest_print_line, &(ManifestLine){manifest, index, hashes}, &size);
    if (line == NULL) return error_memory(error, manifest->journal);
    const bool written = file_write_all(manifest->out, line, size) ||
                         error_system(error, manifest->journal, "cannot write: %s", strerror(errno));
    free(line);
    return written;
}

bool manifest_end(Manifest *manifest, Error *error) {
    return file_write_text(manifest->path, manifest_print_whole, manifest, error) &&
           file_remove(manifest->journal, error);
}

static bool remove_listed(const Manifest *manifest, const char *line, Error *error) {
    char path[PATH_MAX];
    PictureHashes hashes;
    const int index = manifest_line_read(line, strlen(line), &hashes);
    const char *directory = manifest->options->directory;
    if (index < 0 || (index >= manifest->first && index <= manifest->last)) return true;
    return !sink_frame_path(path, sizeof path, directory, index) || !sink_frame_is(directory, index, hashes.file) ||
           file_remove(path, error);
}

/* Lines longer than those that manifests have are read in pieces, none of which looks like one. */
static bool remove_all(const Manifest *manifest, FILE *list, const char *path, Error *error) {
    char line[MANIFEST_LINE_SIZE];
    while (fgets(line, sizeof line, list) != NULL) {
        const size_t end = strcspn(line, "\n"), begin = strspn(line, " ");
        if (line[end] == '\0' || begin > end) continue;
        line[end > 0 && line[end - 1] == ',' ? end - 1 : end] = '\0';
        if (!remove_listed(manifest, line + begin, error)) return false;
    }
    return !ferror(list) || error_system(error, path, "cannot read: %s", strerror(errno));
}

/* What is not a regular file lists nothing. */
static bool remove_listed_in(const Manifest *manifest, const char *path, Error *error) {
    struct stat status;
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return errno == ENOENT || errno == ELOOP || file_open_error(path, error);
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(file);
        return true;
    }
    FILE *list = fdopen(file, "r");
    if (list == NULL) {
        close(file);
        return error_memory(error, path);
    }
    const bool done = remove_all(manifest, list, path, error);
    fclose(list);
    return done;
}

/* Removes the frames that the folder's manifest or journal lists, that the new sequence does not overwrite, and whose
   bytes are unchanged; files of any other origin stay. To be called while both are still those of the earlier sequence: what
   an interrupted call leaves is then listed for the next one. ERROR_SYSTEM if one of them is left. */
static bool stale_remove(const Manifest *manifest, Error *error) {
    return remove_listed_in(manifest, manifest->path, error) && remove_listed_in(manifest, manifest->journal, error);
}
