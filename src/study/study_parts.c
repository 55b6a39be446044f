/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_parts.h"

#include "common/array.h"
#include "common/file.h"
#include "common/memory_stream.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PART_MAX_SIZE = 1 << 24 };

bool study_parts_open(StudyParts *parts, const char *folder, uint64_t key, Error *error) {
    if (!file_path(parts->folder, sizeof parts->folder, error, "%s/parts-%016" PRIx64, folder, key)) return false;
    return file_make_directory(parts->folder, error);
}

void study_parts_close(StudyParts *parts) {
    free(parts->text);
    parts->text = NULL;
}

/* The progress of a part as a share of the whole. */
typedef struct PartProgress {
    const StudyParts *parts;
    double weight;
    bool stopped;
} PartProgress;

static bool report(void *context, double done, double total) {
    PartProgress *part = context;
    double share = total > 0 ? part->weight * done / total : 0;
    if (!progress_report(part->parts->progress, part->parts->done + share, part->parts->total)) part->stopped = true;
    return !part->stopped;
}

static bool append_text(StudyParts *parts, const char *text, size_t size, Error *error) {
    if (!array_reserve((void **)&parts->text, &parts->capacity, parts->size + size + 1, 1))
        return error_memory(error, "study");
    memcpy(parts->text + parts->size, text, size);
    parts->size += size;
    parts->text[parts->size] = '\0';
    return true;
}

/* Does the part and writes its file. */
static bool write_part(StudyParts *parts, const StudyPart *part, const char *path, Error *error) {
    PartProgress own = {parts, part->weight, false};
    const Progress progress = {report, &own};
    char *text = NULL;
    size_t size = 0;
    FILE *lines = memory_stream(&text, &size);
    if (lines == NULL) return error_memory(error, "study");
    bool ok = part->write(part->context, lines, &progress, error);
    if (ferror(lines) && ok) ok = error_memory(error, "study");
    if (fclose(lines) != 0 && ok) ok = error_memory(error, "study");
    if (ok && own.stopped) ok = error_interrupted(error, part->name, "stopped; finished parts are kept");
    ok = ok && file_write(path, text, size, error) && append_text(parts, text, size, error);
    free(text);
    return ok;
}

bool study_parts_do(StudyParts *parts, const StudyPart *part, Error *error) {
    char path[STUDY_PARTS_PATH_SIZE + 128];
    if (!file_path(path, sizeof path, error, "%s/%s", parts->folder, part->name)) return false;
    bool there, ok = file_find(path, &there, error);
    if (ok && there) {
        size_t size;
        char *text = file_read(path, PART_MAX_SIZE, &size, error);
        ok = text != NULL && append_text(parts, text, size, error);
        free(text);
    } else if (ok) {
        ok = write_part(parts, part, path, error);
    }
    parts->done += part->weight;
    return ok;
}

bool study_parts_print(FILE *lines, const CsvLayout *layout, const void *row, Error *error) {
    fprintf(lines, "%s:", layout->name);
    return csv_row_print(lines, layout, row, error);
}

typedef struct PartsTable {
    const StudyParts *parts;
    const CsvLayout *layout;
} PartsTable;

static void print_table(FILE *csv, const void *context) {
    const PartsTable *table = context;
    const char *name = table->layout->name;
    const size_t size = strlen(name);
    csv_header_print(csv, table->layout);
    for (const char *line = table->parts->text; line != NULL && *line != '\0';) {
        size_t length = strcspn(line, "\n");
        if (strncmp(line, name, size) == 0 && line[size] == ':')
            fprintf(csv, "%.*s\n", (int)(length - size - 1), line + size + 1);
        line += length + (line[length] == '\n');
    }
}

bool study_parts_table(const StudyParts *parts, const char *folder, const CsvLayout *layout, Error *error) {
    char path[CSV_PATH_SIZE];
    const PartsTable table = {parts, layout};
    return csv_table_path(path, folder, layout, error) && file_write_text(path, print_table, &table, error);
}

static bool remove_files(DIR *folder, const char *path, Error *error) {
    const struct dirent *entry;
    do {
        errno = 0; /* readdir() returns NULL at the end and on failure */
        entry = readdir(folder);
        if (entry == NULL && errno != 0) return error_system(error, path, "cannot be read: %s", strerror(errno));
        if (entry != NULL && strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
            unlinkat(dirfd(folder), entry->d_name, 0) != 0)
            return error_system(error, path, "%s cannot be removed: %s", entry->d_name, strerror(errno));
    } while (entry != NULL);
    return true;
}

bool study_parts_remove(const StudyParts *parts, Error *error) {
    DIR *folder = opendir(parts->folder);
    if (folder == NULL) return error_system(error, parts->folder, "cannot be read: %s", strerror(errno));
    const bool empty = remove_files(folder, parts->folder, error);
    closedir(folder);
    return empty &&
           (rmdir(parts->folder) == 0 || error_system(error, parts->folder, "cannot be removed: %s", strerror(errno)));
}
