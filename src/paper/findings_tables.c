/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study's tables read again, and the findings with rows of their own: targets, transfer, laws, definitions. */
#include "base/base.h"
#include "base/csv.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "studies/statistics.h"

#include <math.h>
#include <string.h>

bool study_tables_read(StudyTables *study, const char *folder, Error *error) {
    const CsvLayout *const layouts[STUDY_TABLES] = {&paper_score_layout, &paper_trained_layout,
                                                    &paper_rate_layout,  &paper_closed_loop_layout,
                                                    &paper_law_layout,   &paper_transfer_layout};
    memset(study, 0, sizeof *study);
    CsvTable *table = study->tables;
    for (int i = 0; i < STUDY_TABLES; i++) {
        if (csv_table_read_from(&table[i], folder, layouts[i], error)) continue;
        study_tables_free(study);
        return false;
    }
    study->scores = table[0].rows, study->score_count = table[0].count;
    study->networks = table[1].rows, study->network_count = table[1].count;
    study->rates = table[2].rows, study->rate_count = table[2].count;
    study->runs = table[3].rows, study->run_count = table[3].count;
    study->laws = table[4].rows, study->law_count = table[4].count;
    study->transfers = table[5].rows, study->transfer_count = table[5].count;
    return true;
}

void study_tables_free(StudyTables *study) {
    for (int i = 0; i < STUDY_TABLES; i++) csv_table_free(&study->tables[i]);
}

const TrainedRow *study_network(const StudyTables *study, const char *name) {
    for (int i = 0; i < study->network_count; i++)
        if (strcmp(study->networks[i].network, name) == 0) return &study->networks[i];
    return NULL;
}

const TrainedRow *study_baseline(const StudyTables *study) {
    for (int i = 0; i < study->network_count; i++)
        if (strcmp(study->networks[i].factor, "baseline") == 0)
            return isnan(study->networks[i].ratio) ? NULL : &study->networks[i];
    return NULL;
}

bool study_has_factor(const StudyTables *study, const char *network, const char *factor) {
    const TrainedRow *row = study_network(study, network);
    return row != NULL && strcmp(row->factor, factor) == 0;
}

const TrainedRow *study_best(const StudyTables *study, PairTarget target, const char *factor, double max_parameters,
                             int *among) {
    const TrainedRow *best = NULL;
    *among = 0;
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *row = &study->networks[i];
        if (row->target != (int)target || isnan(row->ratio) || !(row->parameters <= max_parameters)) continue;
        if (factor != NULL && strcmp(row->factor, factor) != 0) continue;
        ++*among;
        if (best == NULL || row->ratio < best->ratio) best = row;
    }
    return best;
}

/* The row of another network with the scene, definition and phase of this one; NULL if there is none. */
static const RateRow *study_rate_of(const StudyTables *study, const char *network, const RateRow *row) {
    for (int i = 0; i < study->rate_count; i++) {
        const RateRow *other = &study->rates[i];
        if (strcmp(other->network, network) == 0 && other->scene == row->scene &&
            other->definition == row->definition && other->phase == row->phase)
            return other;
    }
    return NULL;
}

double ratio_of(double a, double b) { return b > 0 ? a / b : NAN; }

/* Closed loops: what networks reach in a scene, beside what solvers do. */

typedef struct LoopRow {
    const char *scene, *network; /* network: that follows the converged run for longest */
    int networks;
    double median, longest;              /* of the networks, frames */
    double engine, engine_100, interior; /* frames; NAN: not run */
} LoopRow;

static double frames_of(const StudyTables *study, int scene, const char *solver) {
    for (int i = 0; i < study->run_count; i++)
        if (study->runs[i].scene == scene && strcmp(study->runs[i].network, solver) == 0)
            return study->runs[i].frames_until_apart;
    return NAN;
}

static LoopRow compare_loops(const StudyTables *study, int scene) {
    double frames[PAPER_MAX_LOOPS];
    LoopRow row = {.scene = paper_scene_names[scene],
                   .network = "",
                   .longest = -1,
                   .engine = frames_of(study, scene, "engine:k=10"),
                   .engine_100 = frames_of(study, scene, "engine:k=100"),
                   .interior = frames_of(study, scene, "interior")};
    for (int i = 0; i < study->run_count; i++) {
        const ClosedLoopRow *run = &study->runs[i];
        if (run->scene != scene || study_network(study, run->network) == NULL) continue;
        frames[row.networks++] = run->frames_until_apart;
        if (!(run->frames_until_apart > row.longest)) continue;
        row.longest = run->frames_until_apart;
        row.network = run->network;
    }
    if (row.longest < 0) row.longest = NAN;
    row.median = statistics_quantile(frames, statistics_known(frames, row.networks), 0.5);
    return row;
}

static bool write_loops(const FindingsFile *file, const StudyTables *study) {
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        const LoopRow row = compare_loops(study, scene);
        if (row.networks > 0 && !findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn loop_columns[] = {FINDINGS_TEXT(LoopRow, scene),        FINDINGS_COUNT(LoopRow, networks),
                                         FINDINGS_NUMBER(LoopRow, median),     FINDINGS_NUMBER(LoopRow, longest),
                                         FINDINGS_TEXT(LoopRow, network),      FINDINGS_NUMBER(LoopRow, engine),
                                         FINDINGS_NUMBER(LoopRow, engine_100), FINDINGS_NUMBER(LoopRow, interior)};
const FindingsTable findings_loops = FINDINGS_TABLE("loops", loop_columns, LoopRow, write_loops);

/* Scores during training beside those of the paper's Table 1. */

/* The constant predictor's error for a target on the paper's scale, [0, 1]; NAN if no network has that scale. */
static double constant_on_paper_scale(const StudyTables *study, PairTarget target) {
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *row = &study->networks[i];
        if (row->target == (int)target && strcmp(row->scale, "minmax") == 0 && !isnan(row->constant))
            return row->constant;
    }
    return NAN;
}

/* The paper's score for a row's iteration. Only networks with a target of the paper's, on its scale, are comparable:
   NAN for others. */
static double paper_test(const StudyTables *study, const ScoreRow *row) {
    const TrainedRow *network = study_network(study, row->network);
    if (row->target >= PAPER_TARGETS || network == NULL || strcmp(network->scale, "minmax") != 0) return NAN;
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        if (published_scores[i].iteration == row->iteration) return published_scores[i].test;
    return NAN;
}

typedef struct TargetRow {
    const char *target, *best; /* best: of the small networks */
    double constant, ratio;    /* the constant predictor's error on the paper's scale; test error of the best over it */
    int paper_rows_worse;      /* rows of the paper's Table 1 with a higher error than the constant predictor */
    int small_networks;
    /* Scores of the study, by how they compare with the constant predictor's and with the paper's for the iteration. */
    int rows, not_below_constant, compared, below_paper, below_both;
} TargetRow;

static void count_scores(const StudyTables *study, PairTarget target, TargetRow *counts) {
    for (int i = 0; i < study->score_count; i++) {
        const ScoreRow *row = &study->scores[i];
        if (row->target != (int)target) continue;
        const double paper = paper_test(study, row);
        counts->rows++;
        counts->not_below_constant += row->test >= row->constant;
        counts->compared += !isnan(paper);
        counts->below_paper += row->test < paper;
        counts->below_both += row->test < paper && row->test < row->constant;
    }
}

static bool write_targets(const FindingsFile *file, const StudyTables *study) {
    for (PairTarget target = 0; target < PAIR_TARGETS; target++) {
        TargetRow row = {.target = pair_target_names[target], .constant = constant_on_paper_scale(study, target)};
        const TrainedRow *best = study_best(study, target, NULL, SMALL_NETWORK, &row.small_networks);
        row.best = best != NULL ? best->network : "";
        row.ratio = best != NULL ? best->ratio : NAN;
        for (int i = 0; i < PUBLISHED_SCORES; i++) row.paper_rows_worse += published_scores[i].test > row.constant;
        count_scores(study, target, &row);
        if (row.rows > 0 && !findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn target_columns[] = {FINDINGS_TEXT(TargetRow, target),
                                           FINDINGS_NUMBER(TargetRow, constant),
                                           FINDINGS_COUNT(TargetRow, paper_rows_worse),
                                           FINDINGS_COUNT(TargetRow, small_networks),
                                           FINDINGS_TEXT(TargetRow, best),
                                           FINDINGS_NUMBER(TargetRow, ratio),
                                           FINDINGS_COUNT(TargetRow, rows),
                                           FINDINGS_COUNT(TargetRow, not_below_constant),
                                           FINDINGS_COUNT(TargetRow, compared),
                                           FINDINGS_COUNT(TargetRow, below_paper),
                                           FINDINGS_COUNT(TargetRow, below_both)};
const FindingsTable findings_targets = FINDINGS_TABLE("targets", target_columns, TargetRow, write_targets);

static bool write_paper_table1(const FindingsFile *file, const StudyTables *study) {
    (void)study;
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        if (!findings_add(file, &published_scores[i])) return false;
    return true;
}

static const CsvColumn published_columns[] = {FINDINGS_NUMBER(PublishedScore, iteration),
                                              FINDINGS_NUMBER(PublishedScore, test),
                                              FINDINGS_NUMBER(PublishedScore, train)};
const FindingsTable findings_paper_table1 =
    FINDINGS_TABLE("paper_table1", published_columns, PublishedScore, write_paper_table1);

/* Transfer learning: medians over the seeds, and how many launches it saves. */

typedef struct LaunchesRow {
    double launches, scratch, transfer; /* transfer, scratch: median errors, m/s */
    double needed; /* the fewest launches with transfer for the error from scratch; NAN: none suffice */
} LaunchesRow;

typedef struct Launches {
    int count;
    LaunchesRow rows[PAPER_MAX_ROWS]; /* by rising numbers of launches */
} Launches;

static double median_error(const StudyTables *study, int transfer, double launches) {
    double values[PAPER_MAX_ROWS];
    int count = 0;
    for (int i = 0; i < study->transfer_count; i++) {
        const TransferRow *row = &study->transfers[i];
        if (row->transfer == transfer && row->launches == launches && !isnan(row->error)) values[count++] = row->error;
    }
    return statistics_quantile(values, count, 0.5);
}

/* The lowest number of launches above `than`; INFINITY if there is none. */
static double next_launches(const StudyTables *study, double than) {
    double next = INFINITY;
    for (int i = 0; i < study->transfer_count; i++)
        if (study->transfers[i].launches > than) next = fmin(next, study->transfers[i].launches);
    return next;
}

static double launches_needed(const Launches *all, double error) {
    for (int i = 0; i < all->count; i++)
        if (all->rows[i].transfer <= error) return all->rows[i].launches;
    return NAN;
}

static void find_launches(const StudyTables *study, Launches *all) {
    all->count = 0;
    for (double n = next_launches(study, 0); isfinite(n); n = next_launches(study, n))
        all->rows[all->count++] =
            (LaunchesRow){.launches = n, .scratch = median_error(study, 0, n), .transfer = median_error(study, 1, n)};
    for (int i = 0; i < all->count; i++) all->rows[i].needed = launches_needed(all, all->rows[i].scratch);
}

static bool write_transfer(const FindingsFile *file, const StudyTables *study) {
    Launches all;
    find_launches(study, &all);
    for (int i = 0; i < all.count; i++)
        if (!findings_add(file, &all.rows[i])) return false;
    return true;
}

static const CsvColumn findings_transfer_columns[] = {
    FINDINGS_NUMBER(LaunchesRow, launches), FINDINGS_NUMBER(LaunchesRow, scratch),
    FINDINGS_NUMBER(LaunchesRow, transfer), FINDINGS_NUMBER(LaunchesRow, needed)};
const FindingsTable findings_transfer =
    FINDINGS_TABLE("transfer", findings_transfer_columns, LaunchesRow, write_transfer);

TransferCounts transfer_counts(const StudyTables *study) {
    TransferCounts counts = {.constant = study->transfers[0].constant, .scratch = NAN, .transfer = NAN};
    Launches all;
    find_launches(study, &all);
    for (int i = 0; i < all.count; i++) {
        const LaunchesRow *row = &all.rows[i];
        /* Nothing can need fewer than the fewest. */
        counts.rows += i > 0 && !isnan(row->scratch);
        counts.saved += row->needed < row->launches;
        counts.scratch = fmin(counts.scratch, row->scratch); /* of a number and NAN, the number */
        counts.transfer = fmin(counts.transfer, row->transfer);
    }
    return counts;
}

/* Laws in the loss: medians over the seeds. */

typedef struct LawCase {
    const char *laws;
    int seeds;
    double weight, test, lowest_test, highest_test, ratio;
    double momentum, energy, approach, cone;
} LawCase;

/* The engine's rows have no weight: they are a case, too. */
static bool same_case(const LawRow *a, const LawRow *b) {
    return a->laws == b->laws && (a->weight == b->weight || (isnan(a->weight) && isnan(b->weight)));
}

/* What a row says: the violation of a law (LawName), or one of these. */
enum { TEST = LAWS, RELATIVE_TEST };

static double value_of(const LawRow *row, int what) {
    return what < LAWS ? row->violation[what] : what == TEST ? row->test : ratio_of(row->test, row->constant);
}

/* A quantile over the seeds of a case; 0 and 1 are the least and the most. */
static double quantile(const StudyTables *study, const LawRow *of, int what, double fraction) {
    double values[PAPER_MAX_ROWS];
    int count = 0;
    for (int i = 0; i < study->law_count; i++)
        if (same_case(&study->laws[i], of)) values[count++] = value_of(&study->laws[i], what);
    return statistics_quantile(values, statistics_known(values, count), fraction);
}

static LawCase case_of(const StudyTables *study, const LawRow *row) {
    LawCase law_case = {.laws = paper_law_words[row->laws],
                        .weight = row->weight,
                        .test = quantile(study, row, TEST, 0.5),
                        .lowest_test = quantile(study, row, TEST, 0),
                        .highest_test = quantile(study, row, TEST, 1),
                        .ratio = quantile(study, row, RELATIVE_TEST, 0.5),
                        .momentum = quantile(study, row, LAW_MOMENTUM, 0.5),
                        .energy = quantile(study, row, LAW_ENERGY, 0.5),
                        .approach = quantile(study, row, LAW_APPROACH, 0.5),
                        .cone = quantile(study, row, LAW_CONE, 0.5)};
    for (int i = 0; i < study->law_count; i++) law_case.seeds += same_case(&study->laws[i], row);
    return law_case;
}

static bool is_first_of_case(const StudyTables *study, int row) {
    for (int i = 0; i < row; i++)
        if (same_case(&study->laws[i], &study->laws[row])) return false;
    return true;
}

static bool write_laws(const FindingsFile *file, const StudyTables *study) {
    for (int i = 0; i < study->law_count; i++) {
        if (!is_first_of_case(study, i)) continue;
        const LawCase row = case_of(study, &study->laws[i]);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn findings_laws_columns[] = {
    FINDINGS_TEXT(LawCase, laws),       FINDINGS_NUMBER(LawCase, weight),      FINDINGS_COUNT(LawCase, seeds),
    FINDINGS_NUMBER(LawCase, test),     FINDINGS_NUMBER(LawCase, lowest_test), FINDINGS_NUMBER(LawCase, highest_test),
    FINDINGS_NUMBER(LawCase, ratio),    FINDINGS_NUMBER(LawCase, momentum),    FINDINGS_NUMBER(LawCase, energy),
    FINDINGS_NUMBER(LawCase, approach), FINDINGS_NUMBER(LawCase, cone)};
const FindingsTable findings_laws = FINDINGS_TABLE("laws", findings_laws_columns, LawCase, write_laws);

LawCounts law_counts(const StudyTables *study) {
    LawCounts counts = {0};
    const LawRow *none = NULL;
    for (int i = 0; i < study->law_count && none == NULL; i++)
        if (study->laws[i].laws == LAW_SET_NONE) none = &study->laws[i];
    for (int i = 0; none != NULL && i < study->law_count; i++) {
        const LawRow *row = &study->laws[i];
        if (row->laws >= LAWS || !(row->weight > 0) || !is_first_of_case(study, i)) continue;
        counts.cases++;
        counts.obeyed += quantile(study, row, row->laws, 0.5) < quantile(study, none, row->laws, 0.5);
        counts.better += quantile(study, row, TEST, 0.5) < quantile(study, none, TEST, 0.5);
    }
    return counts;
}

/* Rates of right predictions beside those of cheaper predictors. */

/* Networks that vary another factor are not in the report's tables of rates. */
static bool is_main(const StudyTables *study, const RateRow *row) {
    return study_has_factor(study, row->network, "baseline") || study_has_factor(study, row->network, "best") ||
           study_has_factor(study, row->network, "contact-net");
}

static double warm_start_rate(const StudyTables *study, const RateRow *row) {
    const RateRow *warm = study_rate_of(study, "warm-start", row);
    return warm != NULL ? warm->share[RATE_NETWORK] : NAN;
}

/* Of the main networks: in how many rows something cheaper is right at least as often. Of the baseline over all frames:
   its lowest and highest rate. */
typedef struct DefinitionRow {
    const char *definition;
    int rows, constant, warm_start, one_sweep;
    int baseline_scenes, baseline_constant;
    double baseline_low, baseline_high;
} DefinitionRow;

static void count_row(const StudyTables *study, const RateRow *rate, DefinitionRow *row) {
    const double share = rate->share[RATE_NETWORK];
    row->rows++;
    row->constant += share <= rate->share[RATE_CONSTANT];
    row->warm_start += share <= warm_start_rate(study, rate);
    row->one_sweep += share <= rate->share[RATE_ENGINE1];
    if (rate->phase != RATE_ALL || isnan(share) || !study_has_factor(study, rate->network, "baseline")) return;
    row->baseline_scenes++;
    row->baseline_constant += share <= rate->share[RATE_CONSTANT];
    row->baseline_low = fmin(row->baseline_low, share); /* of a number and NAN, the number */
    row->baseline_high = fmax(row->baseline_high, share);
}

static bool write_definitions(const FindingsFile *file, const StudyTables *study) {
    for (RateDefinition definition = 0; definition < RATE_DEFINITIONS; definition++) {
        DefinitionRow row = {
            .definition = rate_definition_names[definition], .baseline_low = NAN, .baseline_high = NAN};
        for (int i = 0; i < study->rate_count; i++)
            if (study->rates[i].definition == (int)definition && is_main(study, &study->rates[i]))
                count_row(study, &study->rates[i], &row);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn definition_columns[] = {
    FINDINGS_TEXT(DefinitionRow, definition),        FINDINGS_COUNT(DefinitionRow, rows),
    FINDINGS_COUNT(DefinitionRow, constant),         FINDINGS_COUNT(DefinitionRow, warm_start),
    FINDINGS_COUNT(DefinitionRow, one_sweep),        FINDINGS_COUNT(DefinitionRow, baseline_scenes),
    FINDINGS_NUMBER(DefinitionRow, baseline_low),    FINDINGS_NUMBER(DefinitionRow, baseline_high),
    FINDINGS_COUNT(DefinitionRow, baseline_constant)};
const FindingsTable findings_definitions =
    FINDINGS_TABLE("definitions", definition_columns, DefinitionRow, write_definitions);
