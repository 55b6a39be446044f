/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the report states beyond the study's tables: the summary, aims, factors, claims, systems; and the writing of
   all. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"
#include "studies/closed_loop.h"
#include "studies/study_page.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool findings_add(const FindingsFile *file, const void *row) {
    return csv_row_print(file->out, &file->table->layout, row, file->error);
}

/* Counts and extremes over all networks and runs. */

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
    double unconverged[PAPER_SCENES] = {0}; /* each row of a scene states it again; NAN in an old study */
    for (int i = 0; i < study->rate_count; i++) {
        unconverged[study->rates[i].scene] = study->rates[i].unconverged;
        const double rate = study->rates[i].share[RATE_NETWORK], constant = study->rates[i].share[RATE_CONSTANT];
        rows += !isnan(rate) && !isnan(constant);
        beaten += rate <= constant;
    }
    double left_out = 0;
    for (int scene = 0; scene < PAPER_SCENES; scene++) left_out += unconverged[scene];
    return add_number(file, "rates", rows) && add_number(file, "rates_not_above_constant", beaten) &&
           add_number(file, "rates_unconverged", left_out);
}

/* How many networks of the study differ from the paper's in one factor, and in several. */
static bool add_networks(const FindingsFile *file, const StudyTables *study) {
    const PaperNetwork baseline = paper_network(0);
    int one = 0, several = 0;
    for (int i = 0; i < paper_network_count; i++) {
        char names[PAPER_FACTORS_SIZE];
        const PaperNetwork network = paper_network(i);
        if (study_network(study, network.name) == NULL) continue;
        const int factors = paper_network_factors(&network, &baseline, names);
        one += factors == 1;
        several += factors > 1;
    }
    return add_number(file, "networks_one_factor", one) && add_number(file, "networks_several_factors", several);
}

/* Runs of networks; solvers stand beside them. */
static bool add_runs(const FindingsFile *file, const StudyTables *study) {
    enum { STACK = 1 }; /* of paper_scene_names */
    int runs = 0, complete = 0, stacks = 0, stacks_complete = 0;
    double shortest = CLOSED_LOOP_FRAMES, longest = 0;
    for (int i = 0; i < study->run_count; i++) {
        if (study_network(study, study->runs[i].network) == NULL) continue;
        runs++;
        longest = fmax(longest, study->runs[i].frames_until_apart);
        const bool stack = study->runs[i].scene == STACK;
        const bool whole = study->runs[i].frames_until_apart >= CLOSED_LOOP_FRAMES;
        complete += whole;
        stacks += stack;
        stacks_complete += stack && whole;
        shortest = fmin(shortest, study->runs[i].frames_until_apart);
    }
    return add_number(file, "runs", runs) && add_number(file, "runs_complete", complete) &&
           add_number(file, "shortest_run", shortest) && add_number(file, "longest_run", longest) &&
           add_number(file, "stack_runs", stacks) && add_number(file, "stack_runs_complete", stacks_complete);
}

static bool add_costs(const FindingsFile *file, const StudyTables *study) {
    int timed = 0, slower = 0;
    double most = NAN;
    const char *scene = "";
    for (int i = 0; i < study->run_count; i++) {
        if (study_network(study, study->runs[i].network) == NULL) continue;
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

static bool write_summary(const FindingsFile *file, const StudyTables *study) {
    return add_number(file, "paper_rows", PUBLISHED_SCORES) && add_number(file, "small_network", SMALL_NETWORK) &&
           add_number(file, "last_frame", CLOSED_LOOP_FRAMES) && add_number(file, "after_frames", AFTER_FRAMES) &&
           add_networks(file, study) && add_gate(file, study) && add_rates(file, study) && add_runs(file, study) &&
           add_costs(file, study) &&
           add_number(file, "momentum_error_contact_net", largest_momentum_error(study, "contact-net")) &&
           add_number(file, "momentum_error_baseline", largest_momentum_error(study, "baseline")) &&
           add_laws(file, study) && add_transfer(file, study);
}

static const CsvColumn findings_summary_columns[] = {FINDINGS_TEXT(SummaryRow, key), FINDINGS_TEXT(SummaryRow, value)};
static const FindingsTable findings_summary =
    FINDINGS_TABLE("summary", findings_summary_columns, SummaryRow, write_summary);

/* The study's aims, and the paper's claims about factors. */

typedef struct AimRow {
    const char *kind;    /* error: test error over the constant predictor's; rate: within 0.1 m/s */
    const char *subject; /* target, or scene */
    const char *network, *verdict;
    double aim, measured, free, missed_by; /* free: what costs nothing, the constant predictor or the warm start */
} AimRow;

/* Errors are to be at most the aim, rates at least. */
static void findings_judge(AimRow *row, bool at_least) {
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
    findings_judge(&row, false);
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
    findings_judge(&row, true);
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
static const FindingsTable findings_aims = FINDINGS_TABLE("aims", aim_columns, AimRow, write_aims);

/* The paper's claims that a choice of a factor lowers the error. */

/* Which side of a claim a network is on. */
typedef enum Side { WITHOUT, WITH, NEITHER, SIDES = NEITHER } Side;

static Side side_of(const char *word, const char *with, const char *without) {
    if (strcmp(word, with) == 0) return WITH;
    return strncmp(word, without, strlen(without)) == 0 ? WITHOUT : NEITHER;
}

/* raw, or raw-unturned. */
static Side by_inputs(const TrainedRow *row) { return side_of(row->inputs, "relative", "raw"); }
static Side by_labels(const TrainedRow *row) { return side_of(row->labels, "reference", "engine"); }
static Side by_data(const TrainedRow *row) { return side_of(row->data, "swept", "random"); }

/* Each with the scale that the paper uses with it. */
static Side by_output(const TrainedRow *row) {
    const Side side = side_of(row->output, "linear", "sigmoid");
    return strcmp(row->scale, side == WITH ? "standard" : "minmax") == 0 ? side : NEITHER;
}

/* 10-10-10-2 has two hidden layers. */
static Side by_layers(const TrainedRow *row) {
    int dashes = 0;
    for (const char *c = row->layers; *c != '\0'; c++) dashes += *c == '-';
    return dashes == 3 ? WITH : dashes == 2 ? WITHOUT : NEITHER;
}

static const struct {
    const char *factor;
    Side (*side)(const TrainedRow *row);
} claims[] = {
    {"inputs", by_inputs}, {"scaling", by_output}, {"data", by_data}, {"layers", by_layers}, {"labels", by_labels}};

typedef struct FactorClaim {
    const char *factor, *verdict;
    double with, without; /* lowest ratio to the constant predictor, of the baseline and the factor's networks */
} FactorClaim;

/* False if there is no network on one of the sides. */
static bool findings_claims_compare(const StudyTables *study, int claim, FactorClaim *row) {
    double lowest[SIDES] = {NAN, NAN};
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *network = &study->networks[i];
        if (strcmp(network->factor, claims[claim].factor) != 0 && strcmp(network->factor, "baseline") != 0) continue;
        const Side side = claims[claim].side(network);
        if (side != NEITHER) lowest[side] = fmin(lowest[side], network->ratio); /* of a number and NAN, the number */
    }
    *row = (FactorClaim){.factor = claims[claim].factor, .with = lowest[WITH], .without = lowest[WITHOUT]};
    row->verdict = row->with >= 1 && row->without >= 1 ? "Neither beats the constant predictor"
                   : row->with < row->without          ? "The claim holds here"
                                                       : "The claim does not hold here";
    return !isnan(row->with) && !isnan(row->without);
}

static bool write_claims(const FindingsFile *file, const StudyTables *study) {
    for (int claim = 0; claim < (int)(sizeof claims / sizeof *claims); claim++) {
        FactorClaim row;
        if (findings_claims_compare(study, claim, &row) && !findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn findings_claims_columns[] = {
    FINDINGS_TEXT(FactorClaim, factor), FINDINGS_NUMBER(FactorClaim, with), FINDINGS_NUMBER(FactorClaim, without),
    FINDINGS_TEXT(FactorClaim, verdict)};
static const FindingsTable findings_claims =
    FINDINGS_TABLE("claims", findings_claims_columns, FactorClaim, write_claims);

/* Networks that differ from the baseline in one factor. */

static bool is_factor(const StudyTables *study, int network) {
    const char *factor = study->networks[network].factor;
    if (strcmp(factor, "baseline") == 0) return false;
    for (int i = 0; i < network; i++)
        if (strcmp(study->networks[i].factor, factor) == 0) return false;
    return true;
}

typedef struct FactorRow {
    const char *factor, *best, *verdict;
    int networks, passed; /* passed: the paper's gate */
    double ratio, baseline_ratio;
} FactorRow;

static const char *findings_factors_compare(const TrainedRow *best, const TrainedRow *baseline) {
    if (best->ratio >= 1)
        return baseline->ratio < 1 ? "worse than the constant predictor" : "neither beats the constant predictor";
    return best->ratio < baseline->ratio ? "better than the baseline" : "not better than the baseline";
}

/* Only networks with the same target can be compared. */
static void find_best(const StudyTables *study, FactorRow *row) {
    int among;
    const TrainedRow *baseline = study_baseline(study);
    if (baseline == NULL) return;
    row->baseline_ratio = baseline->ratio;
    const TrainedRow *best = study_best(study, (PairTarget)baseline->target, row->factor, INFINITY, &among);
    if (best == NULL) return;
    row->best = best->value;
    row->ratio = best->ratio;
    row->verdict = findings_factors_compare(best, baseline);
}

static bool write_factors(const FindingsFile *file, const StudyTables *study) {
    for (int first = 0; first < study->network_count; first++) {
        if (!is_factor(study, first)) continue;
        FactorRow row = {
            .factor = study->networks[first].factor, .best = "", .verdict = "", .ratio = NAN, .baseline_ratio = NAN};
        for (int i = first; i < study->network_count; i++) {
            if (strcmp(study->networks[i].factor, row.factor) != 0) continue;
            row.networks++;
            row.passed += study->networks[i].accuracy > PUBLISHED_GATE;
        }
        find_best(study, &row);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn factor_columns[] = {
    FINDINGS_TEXT(FactorRow, factor), FINDINGS_COUNT(FactorRow, networks), FINDINGS_COUNT(FactorRow, passed),
    FINDINGS_TEXT(FactorRow, best),   FINDINGS_NUMBER(FactorRow, ratio),   FINDINGS_NUMBER(FactorRow, baseline_ratio),
    FINDINGS_TEXT(FactorRow, verdict)};
static const FindingsTable findings_factors = FINDINGS_TABLE("factors", factor_columns, FactorRow, write_factors);

static bool write_rows(void *context, FILE *out, Error *error) {
    FindingsFile *file = context;
    file->out = out;
    file->error = error;
    csv_header_print(out, &file->table->layout);
    return file->table->write(file, file->study);
}

bool findings_write(const char *folder, Error *error) {
    static const FindingsTable *const tables[] = {
        &findings_summary, &findings_targets,  &findings_paper_table1, &findings_factors, &findings_definitions,
        &findings_laws,    &findings_transfer, &findings_aims,         &findings_claims,  &findings_loops};
    StudyTables study;
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/findings", folder) || !study_tables_read(&study, folder, error))
        return false;
    bool written = file_make_directory(path, error);
    for (size_t i = 0; written && i < sizeof tables / sizeof *tables; i++) {
        FindingsFile file = {.table = tables[i], .study = &study};
        written = file_path(path, sizeof path, error, "%s/findings/%s.csv", folder, tables[i]->layout.name) &&
                  text_write(path, write_rows, &file, error);
    }
    study_tables_free(&study);
    return written;
}
