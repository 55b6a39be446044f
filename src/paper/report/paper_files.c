/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/paper_files.h"

#include "common/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT(row, member) \
    { #member, TABLE_TEXT, offsetof(row, member), 0 }
#define NUMBER(row, name, member) \
    { name, TABLE_NUMBER, offsetof(row, member), 0 }
#define OPTIONAL(row, name, member) \
    { name, TABLE_OPTIONAL, offsetof(row, member), 0 }

static const TableColumn table1_columns[] = {
    TEXT(Table1Row, network),
    TEXT(Table1Row, target),
    TEXT(Table1Row, optimizer),
    NUMBER(Table1Row, "iteration", iteration),
    NUMBER(Table1Row, "test", test),
    NUMBER(Table1Row, "train", train),
    NUMBER(Table1Row, "constant", constant),
};
static const TableColumn network_columns[] = {
    TEXT(NetworkRow, network),
    TEXT(NetworkRow, factor),
    TEXT(NetworkRow, value),
    TEXT(NetworkRow, inputs),
    TEXT(NetworkRow, data),
    TEXT(NetworkRow, labels),
    TEXT(NetworkRow, target),
    TEXT(NetworkRow, layers),
    TEXT(NetworkRow, hidden),
    TEXT(NetworkRow, output),
    TEXT(NetworkRow, scale),
    NUMBER(NetworkRow, "parameters", parameters),
    OPTIONAL(NetworkRow, "test", test),
    OPTIONAL(NetworkRow, "constant", constant),
    OPTIONAL(NetworkRow, "ratio", ratio),
    OPTIONAL(NetworkRow, "accuracy", accuracy),
};
static const TableColumn rate_columns[] = {
    TEXT(RateRow, network),
    TEXT(RateRow, scene),
    TEXT(RateRow, definition),
    TEXT(RateRow, phase),
    OPTIONAL(RateRow, "rate", rate),
    OPTIONAL(RateRow, "constant", constant),
    OPTIONAL(RateRow, "engine1", engine[0]),
    OPTIONAL(RateRow, "engine4", engine[1]),
    OPTIONAL(RateRow, "engine10", engine[2]),
};
static const TableColumn closed_loop_columns[] = {
    TEXT(ClosedLoopRow, network),
    TEXT(ClosedLoopRow, scene),
    NUMBER(ClosedLoopRow, "frames_until_apart", frames),
    OPTIONAL(ClosedLoopRow, "penetration_max", penetration),
    OPTIONAL(ClosedLoopRow, "momentum_error", momentum),
    OPTIONAL(ClosedLoopRow, "energy_ratio", energy),
    OPTIONAL(ClosedLoopRow, "us_step", us_step),
    OPTIONAL(ClosedLoopRow, "us_step_engine", us_engine),
};
static const TableColumn law_columns[] = {
    TEXT(LawsRow, laws),
    OPTIONAL(LawsRow, "weight", weight),
    OPTIONAL(LawsRow, "seed", seed),
    OPTIONAL(LawsRow, "test", test),
    OPTIONAL(LawsRow, "constant", constant),
    OPTIONAL(LawsRow, "momentum", violations[0]),
    OPTIONAL(LawsRow, "energy", violations[1]),
    OPTIONAL(LawsRow, "approach", violations[2]),
    OPTIONAL(LawsRow, "cone", violations[3]),
};
static const TableColumn transfer_columns[] = {
    TEXT(TransferRow, start),
    OPTIONAL(TransferRow, "seed", seed),
    NUMBER(TransferRow, "launches", launches),
    NUMBER(TransferRow, "error", error),
    NUMBER(TransferRow, "constant", constant),
};
static const TableColumn study_columns[] = {TEXT(StudyRow, key), TEXT(StudyRow, value)};

static const struct {
    const char *name;
    const TableColumn *columns;
    size_t columns_size, row_size;
} specs[PAPER_TABLES] = {
    {"table1.csv", table1_columns, sizeof table1_columns, sizeof(Table1Row)},
    {"networks.csv", network_columns, sizeof network_columns, sizeof(NetworkRow)},
    {"rates.csv", rate_columns, sizeof rate_columns, sizeof(RateRow)},
    {"closed_loop.csv", closed_loop_columns, sizeof closed_loop_columns, sizeof(ClosedLoopRow)},
    {"laws.csv", law_columns, sizeof law_columns, sizeof(LawsRow)},
    {"transfer.csv", transfer_columns, sizeof transfer_columns, sizeof(TransferRow)},
    {"study.csv", study_columns, sizeof study_columns, sizeof(StudyRow)},
};

/* What is shown as a percentage has to be a share. */
static bool check_shares(const PaperFiles *files, Error *error) {
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        /* Comparisons with NAN are false. */
        if (row->rate > 1 || row->constant > 1 || row->engine[0] > 1 || row->engine[1] > 1 || row->engine[2] > 1)
            return csv_error(&files->tables[2].csv, i + 1, 0, error, "a rate above 1");
    }
    for (int i = 0; i < files->network_count; i++)
        if (files->networks[i].accuracy > 1)
            return csv_error(&files->tables[1].csv, i + 1, 0, error, "an accuracy above 1");
    return true;
}

static bool read_tables(PaperFiles *files, const char *folder, Error *error) {
    for (int i = 0; i < PAPER_TABLES; i++) {
        if (!file_path(files->paths[i], PAPER_PATH_SIZE, error, "%s/%s", folder, specs[i].name)) return false;
        int columns = (int)(specs[i].columns_size / sizeof(TableColumn));
        if (!table_read(&files->tables[i], files->paths[i], specs[i].columns, columns, specs[i].row_size, error))
            return false;
    }
    const Table *table = files->tables;
    files->table1 = table[0].rows, files->table1_count = table[0].count;
    files->networks = table[1].rows, files->network_count = table[1].count;
    files->rates = table[2].rows, files->rate_count = table[2].count;
    files->closed_loop = table[3].rows, files->closed_loop_count = table[3].count;
    files->laws = table[4].rows, files->law_count = table[4].count;
    files->transfer = table[5].rows, files->transfer_count = table[5].count;
    files->study = table[6].rows, files->study_count = table[6].count;
    return check_shares(files, error);
}

bool paper_files_read(PaperFiles *files, const char *folder, Error *error) {
    memset(files, 0, sizeof *files);
    if (read_tables(files, folder, error) && paper_figures_read(files, folder, error)) return true;
    paper_files_free(files);
    return false;
}

void paper_files_free(PaperFiles *files) {
    for (int i = 0; i < PAPER_TABLES; i++) table_free(&files->tables[i]);
    for (int i = 0; i < PAPER_FIGURES; i++) {
        free(files->captions[i]);
        free(files->pictures[i]);
    }
}
