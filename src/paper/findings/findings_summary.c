/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts and extremes over all networks and runs. */
#include "paper/findings/findings_outlook.h"
#include "paper/findings/findings_tables.h"
#include "paper/study/aims.h"
#include "paper/study/published.h"
#include "study/closed_loop.h"

#include <math.h>
#include <string.h>

typedef struct SummaryRow {
    const char *key, *value;
} SummaryRow;

static bool add_text(const FindingsFile *file, const char *key, const char *value) {
    return findings_add(file, &(SummaryRow){key, value});
}

static bool add_number(const FindingsFile *file, const char *key, double value) {
    char text[32] = "";
    if (isfinite(value)) snprintf(text, sizeof text, "%.9g", value);
    return add_text(file, key, text);
}

static bool add_gate(const FindingsFile *file, const StudyTables *study) {
    int networks = 0, passed = 0, useless = 0;
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *row = &study->networks[i];
        if (isnan(row->accuracy) || isnan(row->ratio)) continue;
        networks++;
        passed += row->accuracy > PUBLISHED_GATE;
        useless += row->accuracy > PUBLISHED_GATE && row->ratio >= 1;
    }
    return add_number(file, "gate_networks", networks) && add_number(file, "gate_passed", passed) &&
           add_number(file, "gate_passed_not_below_constant", useless);
}

static bool add_rates(const FindingsFile *file, const StudyTables *study) {
    int rows = 0, beaten = 0;
    for (int i = 0; i < study->rate_count; i++) {
        const double rate = study->rates[i].share[RATE_NETWORK], constant = study->rates[i].share[RATE_CONSTANT];
        rows += !isnan(rate) && !isnan(constant);
        beaten += rate <= constant;
    }
    return add_number(file, "rates", rows) && add_number(file, "rates_not_above_constant", beaten);
}

static bool add_runs(const FindingsFile *file, const StudyTables *study) {
    enum { STACK = 1 }; /* of paper_scene_names */
    int complete = 0, stacks = 0, stacks_complete = 0;
    double shortest = CLOSED_LOOP_FRAMES;
    for (int i = 0; i < study->run_count; i++) {
        const bool stack = study->runs[i].scene == STACK;
        const bool whole = study->runs[i].frames_until_apart >= CLOSED_LOOP_FRAMES;
        complete += whole;
        stacks += stack;
        stacks_complete += stack && whole;
        shortest = fmin(shortest, study->runs[i].frames_until_apart);
    }
    return add_number(file, "runs", study->run_count) && add_number(file, "runs_complete", complete) &&
           add_number(file, "shortest_run", shortest) && add_number(file, "stack_runs", stacks) &&
           add_number(file, "stack_runs_complete", stacks_complete);
}

static bool add_costs(const FindingsFile *file, const StudyTables *study) {
    int timed = 0, slower = 0;
    double most = NAN;
    const char *scene = "";
    for (int i = 0; i < study->run_count; i++) {
        const double cost = ratio_of(study->runs[i].us_step, study->runs[i].us_step_engine);
        timed += !isnan(cost);
        slower += cost > 1;
        if (isnan(cost) || cost <= most) continue;
        most = cost;
        scene = paper_scene_names[study->runs[i].scene];
    }
    return add_number(file, "timed_runs", timed) && add_number(file, "slower_runs", slower) &&
           add_number(file, "highest_cost", most) && add_text(file, "highest_cost_scene", scene);
}

static double largest_momentum_error(const StudyTables *study, const char *factor) {
    double largest = NAN;
    for (int i = 0; i < study->run_count; i++)
        if (study_has_factor(study, study->runs[i].network, factor))
            largest = fmax(largest, study->runs[i].momentum_error); /* of a number and NAN, the number */
    return largest;
}

static bool add_laws(const FindingsFile *file, const StudyTables *study) {
    const LawCounts laws = law_counts(study);
    return add_number(file, "law_cases", laws.cases) && add_number(file, "law_cases_obeyed", laws.obeyed) &&
           add_number(file, "law_cases_better", laws.better);
}

static bool add_transfer(const FindingsFile *file, const StudyTables *study) {
    const TransferCounts transfer = transfer_counts(study);
    return add_number(file, "transfer_rows", transfer.rows) &&
           add_number(file, "transfer_rows_saved", transfer.saved) &&
           add_number(file, "transfer_constant", transfer.constant) &&
           add_number(file, "transfer_lowest_scratch", transfer.scratch) &&
           add_text(file, "transfer_scratch_is", transfer.scratch < transfer.constant ? "below" : "not below") &&
           add_number(file, "transfer_lowest", transfer.transfer) &&
           add_text(file, "transfer_is", transfer.transfer < transfer.constant ? "below" : "not below");
}

static bool add_claims(const FindingsFile *file, const StudyTables *study) {
    int held[CLAIM_HOLDS] = {0};
    for (int i = 0; i < study->claim_count; i++) held[study->claims[i].holds]++;
    return add_number(file, "system_claims", study->claim_count) &&
           add_number(file, "system_claims_yes", held[CLAIM_YES]) &&
           add_number(file, "system_claims_partly", held[CLAIM_PARTLY]) &&
           add_number(file, "system_claims_no", held[CLAIM_NO]);
}

static bool write_summary(const FindingsFile *file, const StudyTables *study) {
    return add_number(file, "paper_rows", PUBLISHED_SCORES) && add_number(file, "small_network", SMALL_NETWORK) &&
           add_number(file, "last_frame", CLOSED_LOOP_FRAMES) && add_number(file, "after_frames", AFTER_FRAMES) &&
           add_gate(file, study) && add_rates(file, study) && add_runs(file, study) && add_costs(file, study) &&
           add_number(file, "momentum_error_contact_net", largest_momentum_error(study, "contact-net")) &&
           add_number(file, "momentum_error_baseline", largest_momentum_error(study, "baseline")) &&
           add_laws(file, study) && add_transfer(file, study) && add_claims(file, study);
}

static const CsvColumn columns[] = {FINDINGS_TEXT(SummaryRow, key), FINDINGS_TEXT(SummaryRow, value)};
const FindingsTable findings_summary = FINDINGS_TABLE("summary", columns, SummaryRow, write_summary);
