/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/piece_tables.h"

#include "common/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool piece_tables_print(FILE *results, const CsvLayout *layout, int section, const void *row, Error *error) {
    if (section < 0)
        fprintf(results, "%s:", layout->name);
    else
        fprintf(results, "%s/%d:", layout->name, section);
    return csv_row_print(results, layout, row, error);
}

/* A table that is being written. Its sections are files of their own until their group ends: so every piece is read once,
   and no row is kept in memory. */
typedef struct TableFile {
    const CsvLayout *layout;
    char path[CSV_PATH_SIZE];
    int draft, section_count;
    int *sections; /* [section_count] drafts; -1: no row yet */
} TableFile;

typedef struct Tables {
    const Pieces *pieces;
    TableFile *items; /* [count] */
    int count;
} Tables;

static void print_header(FILE *csv, const void *layout) { csv_header_print(csv, layout); }

static bool begin_table(TableFile *table, const char *folder, const CsvLayout *layout, Error *error) {
    size_t size;
    table->layout = layout;
    if (!csv_table_path(table->path, folder, layout, error)) return false;
    table->draft = file_draft(table->path, error);
    if (table->draft < 0) return false;
    char *header = file_print(print_header, layout, &size);
    const bool done = header != NULL ? file_draft_write(table->draft, table->path, header, size, error)
                                     : error_memory(error, table->path);
    free(header);
    return done;
}

static void close_sections(TableFile *table) {
    for (int i = 0; i < table->section_count; i++)
        if (table->sections[i] >= 0) close(table->sections[i]);
    free(table->sections);
    table->sections = NULL;
    table->section_count = 0;
}

static bool begin_sections(TableFile *table, int count, Error *error) {
    if (count == 0) return true;
    table->sections = malloc((size_t)count * sizeof *table->sections);
    if (table->sections == NULL) return error_memory(error, table->path);
    table->section_count = count;
    for (int i = 0; i < count; i++) table->sections[i] = -1;
    return true;
}

/* The sections, in their order, behind the rows so far. */
static bool join_sections(TableFile *table, Error *error) {
    bool done = true;
    for (int i = 0; done && i < table->section_count; i++)
        if (table->sections[i] >= 0 && !file_copy(table->draft, table->sections[i]))
            done = error_system(error, table->path, "cannot write: %s", strerror(errno));
    close_sections(table);
    return done;
}

/* Where the rows of a line go; *row is behind its tag. -1 with error set. A line of no table of ours is a fault of the
   study's. */
static int find_draft(Tables *tables, const char *line, const char **row, Error *error) {
    const size_t length = strcspn(line, ":/\n");
    for (int i = 0; i < tables->count; i++) {
        TableFile *table = &tables->items[i];
        if (strncmp(line, table->layout->name, length) != 0 || table->layout->name[length] != '\0') continue;
        char *end = (char *)line + length;
        const long section = *end == '/' ? strtol(end + 1, &end, 10) : -1;
        if (*end != ':' || section < -1 || section >= table->section_count) break;
        *row = end + 1;
        if (section < 0) return table->draft;
        if (table->sections[section] < 0) table->sections[section] = file_draft(table->path, error);
        return table->sections[section];
    }
    error_system(error, "tables", "a piece has the line '%.*s', which belongs to no table", (int)strcspn(line, "\n"),
                 line);
    return -1;
}

/* Rows of one table that follow each other are written together. Notes of the study's own are left out. */
static bool add_lines(Tables *tables, char *text, Error *error) {
    int draft = -1;
    char *rows = text, *end = text;
    for (char *line = text; *line != '\0';) {
        const char *row;
        if (*line == '#') {
            line += strcspn(line, "\n") + 1;
            continue;
        }
        const int target = find_draft(tables, line, &row, error);
        const size_t size = strcspn(row = target >= 0 ? row : line, "\n") + 1;
        if (target < 0) return false;
        if (target != draft && end > rows && !file_draft_write(draft, "table", rows, (size_t)(end - rows), error))
            return false;
        if (target != draft) rows = end = line;
        draft = target;
        memmove(end, row, size);
        line = (char *)row + size;
        end += size;
    }
    return end == rows || file_draft_write(draft, "table", rows, (size_t)(end - rows), error);
}

static bool add_piece(Tables *tables, int64_t piece, Error *error) {
    size_t size;
    char *text = pieces_read(tables->pieces, piece, &size, NULL, error);
    if (text == NULL) return false;
    const bool whole = size == strlen(text) && (size == 0 || text[size - 1] == '\n'),
               done = whole ? add_lines(tables, text, error)
                            : error_system(error, "tables", "a piece is not made of lines");
    free(text);
    return done;
}

static bool add_group(Tables *tables, const PieceGroup *group, Error *error) {
    bool done = true;
    for (int i = 0; done && i < tables->count; i++) done = begin_sections(&tables->items[i], group->sections, error);
    for (int64_t i = group->first; done && i < group->first + group->count; i++) done = add_piece(tables, i, error);
    for (int i = 0; done && i < tables->count; i++) done = join_sections(&tables->items[i], error);
    return done;
}

bool piece_tables_write(const Pieces *pieces, const char *folder, const CsvLayout *const *layouts, int layout_count,
                        const PieceGroup *groups, int group_count, Error *error) {
    const PieceGroup all = {0, pieces->plan->count, 0};
    Tables tables = {pieces, calloc((size_t)layout_count, sizeof *tables.items), 0};
    bool done = tables.items != NULL || error_memory(error, folder);
    while (done && tables.count < layout_count) {
        tables.items[tables.count].draft = -1;
        done = begin_table(&tables.items[tables.count], folder, layouts[tables.count], error);
        tables.count++;
    }
    if (done && groups == NULL) done = add_group(&tables, &all, error);
    for (int i = 0; done && groups != NULL && i < group_count; i++) done = add_group(&tables, &groups[i], error);
    for (int i = 0; done && i < tables.count; i++)
        done = file_draft_publish(tables.items[i].draft, tables.items[i].path, error);
    for (int i = 0; i < tables.count; i++) {
        close_sections(&tables.items[i]);
        if (tables.items[i].draft >= 0) close(tables.items[i].draft);
    }
    free(tables.items);
    return done;
}
