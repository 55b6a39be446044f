/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/gns_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char abstract[] = "Sanchez-Gonzalez et al. 2020, abstract";

static const double compared_at = 1; /* s after the launch: later, runs have little in common */

/* m: a twentieth, and a hundredth, of a box's edge. */
static const double deformed = 0.05, little_deformed = 0.01;

/* Share by which the number of boxes that moved may be off. */
static const double moved_right = 0.25;

/* Hours: a day, a week. */
static const double day = 24, week = 168;

typedef struct Rows {
    const GnsRow *rows;
    int count;
} Rows;

static const char *const scenes[] = {"single", "stack", "pyramid_settled"};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* NULL: not measured. */
static const GnsRow *find(const Rows *rows, GnsMeasure measure, const char *variant, const char *scene,
                          double seconds) {
    for (int i = 0; i < rows->count; i++) {
        const GnsRow *row = &rows->rows[i];
        if (row->measure == (int)measure && strcmp(row->variant, variant) == 0 && strcmp(row->scene, scene) == 0 &&
            (isnan(seconds) || fabs(row->seconds - seconds) < 1e-6))
            return row;
    }
    return NULL;
}

static double error_of(const Rows *rows, int variant, const char *scene) {
    const GnsRow *row = find(rows, GNS_ROLLOUT, gns_variants[variant].name, scene, compared_at);
    return row != NULL ? row->error : NAN;
}

/* Counts the scenes and pairs of variants in which the first has the smaller error; adds the errors to the text. */
static void compare(const Rows *rows, const int *variants, int count, int *holding, int *cases, char *text,
                    size_t size) {
    *holding = *cases = 0;
    text[0] = '\0';
    for (int s = 0; s < SCENES; s++) {
        if (isnan(error_of(rows, variants[0], scenes[s]))) continue;
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s", used > 0 ? "; " : "", scenes[s]);
        for (int v = 0; v < count; v++) {
            const double error = error_of(rows, variants[v], scenes[s]);
            used = strlen(text);
            snprintf(text + used, size - used, "%s %.2f m (%s)", v > 0 ? "," : ":", error,
                     gns_variants[variants[v]].name);
            if (v == 0) continue;
            ++*cases;
            if (error_of(rows, variants[v - 1], scenes[s]) < error) ++*holding;
        }
    }
}

static bool claim_rounds(const Claims *claims, const Rows *rows, Error *error) {
    static const int variants[] = {GNS_SHIPPED, GNS_TWO_ROUNDS, GNS_ONE_ROUND};
    int holding, cases;
    char text[CLAIM_TEXT_SIZE];
    compare(rows, variants, 3, &holding, &cases, text, sizeof text);
    const Claim claim = {"The error of a rollout falls with the number M of rounds of messages", abstract,
                         "Mean distance of boxes from the taught run 1 s after the launch, held-out launches; of each "
                         "scene, M = 5 must beat 2, and 2 must beat 1",
                         claim_in_cases(holding, cases)};
    return claim_state(claims, &claim, error, "%s", text[0] != '\0' ? text : "not measured");
}

static bool claim_noise(const Claims *claims, const Rows *rows, Error *error) {
    static const int variants[] = {GNS_SHIPPED, GNS_NO_NOISE};
    int holding, cases;
    char text[CLAIM_TEXT_SIZE];
    compare(rows, variants, 2, &holding, &cases, text, sizeof text);
    const Claim claim = {
        "Noise on the inputs in training lowers the error of a rollout", abstract,
        "The same distance, of the same network trained without noise; it must be larger in each scene",
        claim_in_cases(holding, cases)};
    return claim_state(claims, &claim, error, "%s", text[0] != '\0' ? text : "not measured");
}

static bool claim_shapes(const Claims *claims, const Rows *rows, Error *error) {
    double most = NAN;
    char text[CLAIM_TEXT_SIZE] = "";
    for (int s = 0; s < SCENES; s++) {
        const GnsRow *soon = NULL, *last = NULL;
        for (int i = 0; i < rows->count; i++) {
            const GnsRow *row = &rows->rows[i];
            if (row->measure != GNS_ROLLOUT || strcmp(row->variant, gns_variants[GNS_NOT_RIGID].name) != 0 ||
                strcmp(row->scene, scenes[s]) != 0)
                continue;
            if (soon == NULL) soon = row;
            last = row;
        }
        if (soon == NULL) continue;
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s: %.3f m after %g s, %.3f m after %g s", used > 0 ? "; " : "",
                 scenes[s], soon->shape, soon->seconds, last->shape, last->seconds);
        most = fmax(most, last->shape);
    }
    const Claim claim = {
        "Particles alone do not keep shapes: boxes deform in long rollouts",
        "Sanchez-Gonzalez et al. 2020, section 3: particles, without a constraint of rigid bodies",
        "Distance of particles from the best-fitting rigid box, with rigid=off; yes from 5% of a box's "
        "edge in the worst scene, partly from 1%",
        claim_at_least(most, deformed, little_deformed)};
    return claim_state(claims, &claim, error, "%s", text[0] != '\0' ? text : "not measured");
}

static bool claim_large(const Claims *claims, const Rows *rows, Error *error) {
    static const char *const piles[] = {"pyramid", "pyramid_18"};
    int right = 0, cases = 0;
    char text[CLAIM_TEXT_SIZE] = "";
    for (int s = 0; s < 2; s++) {
        const GnsRow *row = find(rows, GNS_LARGE, gns_variants[GNS_SHIPPED].name, piles[s], NAN);
        if (row == NULL) continue;
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used,
                 "%s%s, %.0f boxes: %.0f moved (taught run: %.0f), %.2g m off, %.3g ms a step", used > 0 ? "; " : "",
                 piles[s], row->boxes, row->moved, row->moved_engine, row->error, row->ms_step);
        right += fabs(row->moved - row->moved_engine) <= moved_right * fmax(row->moved_engine, 1) ? 1 : 0;
        cases++;
    }
    const Claim claim = {"One network simulates many more bodies than it was trained on: 66 to 200 boxes", abstract,
                         "Boxes that moved more than 0.5 m: in each pile, their number must be within 25% of the "
                         "taught run's. An example of training has at most 12 boxes",
                         claim_in_cases(right, cases)};
    return claim_state(claims, &claim, error, "%s", text[0] != '\0' ? text : "not measured");
}

static bool claim_cost(const Claims *claims, const Rows *rows, Error *error) {
    const GnsRow *ours = find(rows, GNS_COST, "width 16, M = 5", "pyramid_settled", NAN);
    const GnsRow *theirs = find(rows, GNS_COST, "width 128, M = 10", "pyramid_settled", NAN);
    const double hours = theirs != NULL ? theirs->hours : NAN;
    const Claim claim = {
        "The paper's own network, 128 wide with M = 10, can be trained as there: 20 million steps of 2",
        "Sanchez-Gonzalez et al. 2020, appendix on training",
        "Time of a gradient step, all threads of this machine; yes within a day, partly within a week",
        claim_at_most(hours, day, week)};
    return claim_state(
        claims, &claim, error,
        "%.3g ms a gradient step, %.3g hours in all (16 wide, M = 5: %.3g ms, %.3g hours); a step of %.0f "
        "boxes takes %.3g ms (%.3g ms)",
        theirs != NULL ? theirs->ms_gradient : NAN, hours, ours != NULL ? ours->ms_gradient : NAN,
        ours != NULL ? ours->hours : NAN, theirs != NULL ? theirs->boxes : NAN, theirs != NULL ? theirs->ms_step : NAN,
        ours != NULL ? ours->ms_step : NAN);
}

bool gns_claims(const Claims *claims, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, claims->folder, &gns_table_layout, error)) return false;
    const Rows rows = {table.rows, table.count};
    const bool ok = claim_rounds(claims, &rows, error) && claim_noise(claims, &rows, error) &&
                    claim_shapes(claims, &rows, error) && claim_large(claims, &rows, error) &&
                    claim_cost(claims, &rows, error);
    csv_table_free(&table);
    return ok;
}
