/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems that the paper cites: how many of their claims hold. */
#include "paper/findings/findings_tables.h"

#include <string.h>

typedef struct SystemRow {
    const char *system;
    int claims, yes, partly, no;
} SystemRow;

static bool is_first_of_system(const StudyTables *study, int row) {
    const char *system = study->system_scores[row].system;
    if (strcmp(system, SYSTEM_RIVAL) == 0) return false;
    for (int i = 0; i < row; i++)
        if (strcmp(study->system_scores[i].system, system) == 0) return false;
    return true;
}

static SystemRow row_of(const StudyTables *study, const char *system) {
    SystemRow row = {.system = system};
    for (int i = 0; i < study->claim_count; i++) {
        const ClaimRow *claim = &study->claims[i];
        if (strcmp(claim->system, system) != 0) continue;
        row.claims++;
        row.yes += claim->holds == CLAIM_YES;
        row.partly += claim->holds == CLAIM_PARTLY;
        row.no += claim->holds == CLAIM_NO;
    }
    return row;
}

static bool write_systems(const FindingsFile *file, const StudyTables *study) {
    for (int i = 0; i < study->system_score_count; i++) {
        if (!is_first_of_system(study, i)) continue;
        const SystemRow row = row_of(study, study->system_scores[i].system);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn columns[] = {FINDINGS_TEXT(SystemRow, system), FINDINGS_COUNT(SystemRow, claims),
                                    FINDINGS_COUNT(SystemRow, yes), FINDINGS_COUNT(SystemRow, partly),
                                    FINDINGS_COUNT(SystemRow, no)};
const FindingsTable findings_systems = FINDINGS_TABLE("systems", columns, SystemRow, write_systems);
