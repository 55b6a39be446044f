/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Holden et al. 2019 claim, judged by system_subspace.csv. */
#include "paper/study/paper_data.h"
#include "paper/systems/subspace_study.h"
#include "subspace_training/subspace_training.h"

#include <math.h>

/* Times as fast as the offline engine: the least that they report. */
static const double least_claimed = 300;

/* Cases of a rule: how many, in how many it holds, and the range of its figure. */
typedef struct Cases {
    int count, holding;
    double least, most;
} Cases;

static void add_case(Cases *cases, double figure, bool holds) {
    if (isnan(figure)) return;
    cases->least = cases->count == 0 ? figure : fmin(cases->least, figure);
    cases->most = cases->count == 0 ? figure : fmax(cases->most, figure);
    cases->count++;
    cases->holding += holds;
}

/* The ratio of an engine's step to that of each row of subspace in its scene. */
static Cases speed_over(const CsvTable *table, const char *engine) {
    const SubspaceStudyRow *rows = table->rows;
    Cases cases = {0};
    for (int i = 0; i < table->count; i++) {
        if (rows[i].components == 0) continue;
        const SubspaceStudyRow *other = subspace_study_find(rows, table->count, rows[i].scene, engine);
        const double ratio = other != NULL ? other->us_step / rows[i].us_step : NAN;
        add_case(&cases, ratio, ratio >= least_claimed);
    }
    return cases;
}

static bool claim_speed(const Claims *claims, const CsvTable *table, Error *error) {
    const Cases reference = speed_over(table, SUBSPACE_STUDY_OFFLINE), interior = speed_over(table, SUBSPACE_OFFLINE),
                engine = speed_over(table, "engine");
    const Claim claim = {"A step is 300 to 5,000 times as fast as that of the offline engine",
                         "Holden et al. 2019, section 6",
                         "whole step of the converged solution over a step with 8, 32 and 128 components in four "
                         "scenes; holds if all are 300 times as fast, partly if some are",
                         claim_in_cases(reference.holding, reference.count)};
    return claim_state(claims, &claim, error,
                       "%.0f to %.0f times (converged solution), %.0f to %.0f times (interior), %.1f to %.0f times "
                       "(engine)",
                       reference.least, reference.most, interior.least, interior.most, engine.least, engine.most);
}

static bool claim_error(const Claims *claims, const CsvTable *table, Error *error) {
    const SubspaceStudyRow *rows = table->rows;
    Cases error_of = {0}, floor = {0}, chaos = {0};
    for (int i = 0; i < table->count; i++) {
        if (rows[i].components == 0) continue;
        const SubspaceStudyRow *engine = subspace_study_find(rows, table->count, rows[i].scene, "engine");
        add_case(&error_of, rows[i].rms, rows[i].rms <= SUBSPACE_APART);
        add_case(&floor, rows[i].floor_rms, true);
        add_case(&chaos, engine != NULL ? engine->rms : NAN, true);
    }
    const Claim claim = {"Its runs stay near those of the offline engine", "Holden et al. 2019, section 6",
                         "distance of positions (RMS over bodies, frames and held-out launches); holds if it is at "
                         "most 0.1 m in all cases, partly if in some",
                         claim_in_cases(error_of.holding, error_of.count)};
    return claim_state(claims, &claim, error,
                       "%.2g to %.2g m; the components alone lose %.2g to %.2g m, the engine is %.2g to %.2g m away",
                       error_of.least, error_of.most, floor.least, floor.most, chaos.least, chaos.most);
}

static bool claim_network(const Claims *claims, const CsvTable *table, Error *error) {
    const SubspaceStudyRow *rows = table->rows;
    Cases cases = {0};
    for (int i = 0; i < table->count; i++) {
        if (rows[i].components == 0) continue;
        const double ratio = rows[i].rms / rows[i].linear_rms;
        add_case(&cases, ratio, ratio < 1);
    }
    const Claim claim = {"The network corrects the linear term", "Holden et al. 2019, section 4",
                         "distance with the network over that of the linear term alone; holds if it is below 1 in all "
                         "cases, partly if in some",
                         claim_in_cases(cases.holding, cases.count)};
    return claim_state(claims, &claim, error, "%.2f to %.2f of the linear term's, below 1 in %d of %d cases",
                       cases.least, cases.most, cases.holding, cases.count);
}

/* Of scenes with more than eight numbers. */
static bool claim_components(const Claims *claims, const CsvTable *table, Error *error) {
    const SubspaceStudyRow *rows = table->rows;
    Cases cases = {0};
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        const SubspaceStudyRow *few = subspace_study_find(rows, table->count, scene, "subspace:components=8"),
                               *many = subspace_study_find(rows, table->count, scene, "subspace:components=128");
        if (few == NULL || many == NULL) continue;
        add_case(&cases, many->rms / few->rms, many->rms < few->rms);
    }
    const Claim claim = {"More components are more accurate", "Holden et al. 2019, section 6",
                         "distance with all, at most 128, components over that with 8, in stack and pyramids; holds if "
                         "it is below 1 in all, partly if in some",
                         claim_in_cases(cases.holding, cases.count)};
    return claim_state(claims, &claim, error, "%.2f to %.2f of that with 8, below 1 in %d of %d scenes", cases.least,
                       cases.most, cases.holding, cases.count);
}

bool subspace_claim(const Claims *claims, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, claims->folder, &subspace_study_layout, error)) return false;
    const bool stated = claim_speed(claims, &table, error) && claim_error(claims, &table, error) &&
                        claim_network(claims, &table, error) && claim_components(claims, &table, error);
    csv_table_free(&table);
    return stated;
}
