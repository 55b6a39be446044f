/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/findings/findings.h"

#include "common/file.h"
#include "common/memory_stream.h"
#include "paper/findings/findings_tables.h"

#include <limits.h>
#include <stdlib.h>

bool findings_add(const FindingsFile *file, const void *row) {
    return csv_row_print(file->out, file->layout, row, file->error);
}

static bool write_table(const FindingsTable *table, const StudyTables *study, const char *folder, Error *error) {
    char path[PATH_MAX], *text = NULL;
    size_t size;
    if (!file_path(path, sizeof path, error, "%s/findings/%s.csv", folder, table->layout.name)) return false;
    const FindingsFile file = {&table->layout, memory_stream(&text, &size), error};
    if (file.out == NULL) return error_memory(error, path);
    csv_header_print(file.out, file.layout);
    bool written = table->write(&file, study);
    const bool whole = !ferror(file.out);
    if ((fclose(file.out) != 0 || !whole) && written) written = error_memory(error, path);
    written = written && file_write(path, text, size, error);
    free(text);
    return written;
}

bool findings_write(const char *folder, Error *error) {
    static const FindingsTable *const tables[] = {
        &findings_summary, &findings_targets,  &findings_paper_table1, &findings_factors, &findings_definitions,
        &findings_laws,    &findings_transfer, &findings_aims,         &findings_claims,  &findings_systems};
    StudyTables study;
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/findings", folder) || !study_tables_read(&study, folder, error))
        return false;
    bool written = file_make_directory(path, error);
    for (size_t i = 0; written && i < sizeof tables / sizeof *tables; i++)
        written = write_table(tables[i], &study, folder, error);
    study_tables_free(&study);
    return written;
}
