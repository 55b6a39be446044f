/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of findings.h, one function each. */
#pragma once
#include "paper/findings/study_tables.h"

#include <stdio.h>

/* Where a table's rows go. */
typedef struct FindingsFile {
    const CsvLayout *layout;
    FILE *out;
    Error *error;
} FindingsFile;

/* False with error set for numbers that are infinite. */
bool findings_add(const FindingsFile *file, const void *row);

typedef struct FindingsTable {
    CsvLayout layout;
    /* Adds all rows. */
    bool (*write)(const FindingsFile *file, const StudyTables *study);
} FindingsTable;

extern const FindingsTable findings_summary, findings_targets, findings_paper_table1, findings_factors,
    findings_definitions, findings_laws, findings_transfer, findings_aims, findings_claims, findings_systems;

/* Columns of a row with members of these names; a text, a count, a number that may be NAN. */
#define FINDINGS_TEXT(Row, member) \
    { #member, CSV_TEXT, .offset = offsetof(Row, member) }
#define FINDINGS_COUNT(Row, member) \
    { #member, CSV_INTEGER, .offset = offsetof(Row, member) }
#define FINDINGS_NUMBER(Row, member) \
    { #member, CSV_OPTIONAL, .offset = offsetof(Row, member), .digits = 9 }

/* An initialiser of a FindingsTable. */
#define FINDINGS_TABLE(name, columns, Row, write) \
    { CSV_LAYOUT(name, columns, Row, .min_rows = 0), write }
