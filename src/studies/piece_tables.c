/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables from the results of pieces; keys and work of studies. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/piece_tables.h"

#include <stdlib.h>
#include <string.h>

bool study_key_add_scene(StudyKey *key, const char *path, Error *error) {
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

bool piece_tables_print(FILE *results, const CsvLayout *layout, int section, const void *row, Error *error) {
    if (section < 0)
        fprintf(results, "%s:", layout->name);
    else
        fprintf(results, "%s/%d:", layout->name, section);
    return csv_row_print(results, layout, row, error);
}

/* The results of all pieces, while tables are made of them. */
typedef struct Tables {
    const CsvLayout *const *layouts; /* [layout_count] */
    const PieceGroup *groups;        /* [group_count] */
    int layout_count, group_count;
    char **texts; /* [pieces] */
} Tables;

/* Whether a line is a row of one of the tables, or a note. Other lines are a fault of the study's. */
static bool check_line(const Tables *tables, const char *line, int sections, Error *error) {
    const size_t length = strcspn(line, ":/\n");
    if (*line == '#') return true;
    for (int i = 0; i < tables->layout_count; i++) {
        const char *name = tables->layouts[i]->name;
        if (strncmp(line, name, length) != 0 || name[length] != '\0') continue;
        char *end = (char *)line + length;
        const long section = *end == '/' ? strtol(end + 1, &end, 10) : -1;
        if (*end == ':' && section >= -1 && section < sections) return true;
    }
    return error_system(error, "tables", "a piece has the line '%.*s', which belongs to no table",
                        (int)strcspn(line, "\n"), line);
}

static bool read_pieces(const Tables *tables, const Pieces *pieces, Error *error) {
    for (int g = 0; g < tables->group_count; g++) {
        const PieceGroup *group = &tables->groups[g];
        for (int64_t i = group->first; i < group->first + group->count; i++) {
            size_t size;
            char *text = tables->texts[i] = pieces_read(pieces, i, &size, NULL, error);
            if (text == NULL) return false;
            if (size != strlen(text) || (size > 0 && text[size - 1] != '\n'))
                return error_system(error, "tables", "a piece is not made of lines");
            for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1)
                if (!check_line(tables, line, group->sections, error)) return false;
        }
    }
    return true;
}

typedef struct Table {
    const Tables *tables;
    const CsvLayout *layout;
} Table;

static void print_table(FILE *out, const void *context) {
    const Table *table = context;
    csv_header_print(out, table->layout);
    for (int g = 0; g < table->tables->group_count; g++) {
        const PieceGroup *group = &table->tables->groups[g];
        for (int section = -1; section < group->sections; section++) { /* -1: rows without one */
            char tag[CSV_NAME_SIZE + 16] = "";
            text_add(tag, sizeof tag, "%s", table->layout->name);
            if (section >= 0) text_add(tag, sizeof tag, "/%d", section);
            text_add(tag, sizeof tag, ":");
            const size_t length = strlen(tag);
            for (int64_t i = group->first; i < group->first + group->count; i++)
                for (const char *line = table->tables->texts[i]; *line != '\0'; line += strcspn(line, "\n") + 1)
                    if (strncmp(line, tag, length) == 0)
                        fwrite(line + length, 1, strcspn(line, "\n") + 1 - length, out);
        }
    }
}

bool piece_tables_write(const Pieces *pieces, const char *folder, const CsvLayout *const *layouts, int layout_count,
                        const PieceGroup *groups, int group_count, Error *error) {
    const int64_t count = pieces->plan->count;
    const PieceGroup all = {0, count, 0};
    const Tables tables = {layouts, groups != NULL ? groups : &all, layout_count, groups != NULL ? group_count : 1,
                           calloc((size_t)count + 1, sizeof *tables.texts)};
    bool done = (tables.texts != NULL || error_memory(error, folder)) && read_pieces(&tables, pieces, error);
    for (int i = 0; done && i < layout_count; i++) {
        char path[CSV_PATH_SIZE];
        done = csv_table_path(path, folder, layouts[i], error) &&
               file_write_text(path, print_table, &(Table){&tables, layouts[i]}, error);
    }
    for (int64_t i = 0; tables.texts != NULL && i < count; i++) free(tables.texts[i]);
    free(tables.texts);
    return done;
}
