/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study's aims, and the paper's claims about factors. */
#include "paper/findings/findings_tables.h"
#include "paper/study/aims.h"

#include <math.h>
#include <string.h>

typedef struct AimRow {
    const char *kind;    /* error: test error over the constant predictor's; rate: within 0.1 m/s */
    const char *subject; /* target, or scene */
    const char *network, *verdict;
    double aim, measured, free, missed_by; /* free: what costs nothing, the constant predictor or the warm start */
} AimRow;

/* Errors are to be at most the aim, rates at least. */
static void judge(AimRow *row, bool at_least) {
    const double missed = at_least ? row->aim - row->measured : row->measured - row->aim;
    row->missed_by = missed > 0 ? missed : NAN;
    if (isnan(row->measured))
        row->verdict = "not measured";
    else if (missed > 0)
        row->verdict = "missed";
    else
        row->verdict = at_least && row->free >= row->aim ? "reached, also at no cost" : "reached";
}

/* The network for a target with the lowest error. */
static AimRow error_aim(const StudyTables *study, PairTarget target) {
    int among;
    const TrainedRow *best = study_best(study, target, NULL, SMALL_NETWORK, &among);
    AimRow row = {.kind = "error",
                  .subject = pair_target_names[target],
                  .network = best != NULL ? best->network : "",
                  .aim = target_aims[target],
                  .measured = best != NULL ? best->ratio : NAN,
                  .free = 1};
    judge(&row, false);
    return row;
}

/* The contact-net with the highest rate in a scene. */
static AimRow rate_aim(const StudyTables *study, int scene, double aim) {
    AimRow row = {
        .kind = "rate", .subject = paper_scene_names[scene], .network = "", .aim = aim, .measured = NAN, .free = NAN};
    for (int i = 0; i < study->rate_count; i++) {
        const RateRow *rate = &study->rates[i];
        const double share = rate->share[RATE_NETWORK];
        if (rate->scene != scene || rate->definition != RATE_ABSOLUTE || rate->phase != RATE_ALL) continue;
        if (strcmp(rate->network, "warm-start") == 0) row.free = share;
        if (!study_has_factor(study, rate->network, "contact-net") || share <= row.measured || isnan(share)) continue;
        row.network = rate->network;
        row.measured = share;
    }
    judge(&row, true);
    return row;
}

static bool write_aims(const FindingsFile *file, const StudyTables *study) {
    enum { SINGLE, STACK }; /* of paper_scene_names */
    for (int target = 0; target < PAPER_TARGETS; target++) {
        const AimRow row = error_aim(study, (PairTarget)target);
        if (!findings_add(file, &row)) return false;
    }
    const AimRow single = rate_aim(study, SINGLE, 0.95), stack = rate_aim(study, STACK, 0.75);
    return findings_add(file, &single) && findings_add(file, &stack);
}

static const CsvColumn aim_columns[] = {FINDINGS_TEXT(AimRow, kind),       FINDINGS_TEXT(AimRow, subject),
                                        FINDINGS_NUMBER(AimRow, aim),      FINDINGS_TEXT(AimRow, network),
                                        FINDINGS_NUMBER(AimRow, measured), FINDINGS_NUMBER(AimRow, free),
                                        FINDINGS_TEXT(AimRow, verdict),    FINDINGS_NUMBER(AimRow, missed_by)};
const FindingsTable findings_aims = FINDINGS_TABLE("aims", aim_columns, AimRow, write_aims);
