/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/part_file.h"

#include "common/file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool part_file_open(PartFile *part, const char *folder, uint64_t key, Error *error) {
    *part = (PartFile){0};
    if (!file_path(part->path, sizeof part->path, error, "%s/chart-%016" PRIx64 ".part.csv", folder, key)) return false;
    bool there;
    return file_find(part->path, &there, error) && (!there || chart_csv_read(&part->done, part->path, error));
}

void part_file_close(PartFile *part) { chart_csv_free(&part->done); }

bool part_file_find(const PartFile *part, ChartRow *rows, int count) {
    for (int i = 0; i + count <= part->done.count; i += count) {
        const ChartRow *found = &part->done.rows[i];
        if (strcmp(found->scene, rows->scene) != 0 || strcmp(found->method, rows->method) != 0 ||
            strcmp(found->setting, rows->setting) != 0)
            continue;
        memcpy(rows, found, (size_t)count * sizeof *rows);
        return true;
    }
    return false;
}

bool part_file_write(const PartFile *part, const ChartRow *rows, int count, Error *error) {
    return count == 0 || csv_table_write(part->path, &chart_layout, rows, count, error);
}

bool part_file_remove(const PartFile *part, Error *error) { return file_remove(part->path, error); }
