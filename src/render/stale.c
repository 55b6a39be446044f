/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/stale.h"

#include "render/manifest_print.h"
#include "render/sink.h"

#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void remove_listed(const Manifest *manifest, const char *line) {
    char path[PATH_MAX];
    PictureHashes hashes;
    const int index = manifest_line_read(line, strlen(line), &hashes);
    const char *directory = manifest->options->directory;
    if (index < 0 || (index >= manifest->first && index <= manifest->last)) return;
    if (sink_frame_path(path, sizeof path, directory, index) && sink_frame_is(directory, index, hashes.file))
        unlink(path);
}

/* Lines longer than those that manifests have are read in pieces, none of which looks like one. */
static void remove_all(const Manifest *manifest, FILE *list) {
    char line[MANIFEST_LINE_SIZE];
    while (fgets(line, sizeof line, list) != NULL) {
        const size_t end = strcspn(line, "\n"), begin = strspn(line, " ");
        if (line[end] == '\0' || begin > end) continue;
        line[end > 0 && line[end - 1] == ',' ? end - 1 : end] = '\0';
        remove_listed(manifest, line + begin);
    }
}

static void remove_listed_in(const Manifest *manifest, const char *path) {
    struct stat status;
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return;
    FILE *list = fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? fdopen(file, "r") : NULL;
    if (list == NULL) {
        close(file);
        return;
    }
    remove_all(manifest, list);
    fclose(list);
}

void stale_remove(const Manifest *manifest) {
    remove_listed_in(manifest, manifest->path);
    remove_listed_in(manifest, manifest->journal);
}
