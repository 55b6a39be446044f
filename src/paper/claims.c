/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the papers of the systems claim: the table of all claims, then the rules by which those of each system are
   judged from its table. */
#include "base/base.h"
#include "base/csv.h"
#include "learning/subspace_training.h"
#include "methods/sain_view.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "studies/study_page.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

static const char *const claim_holds_words[CLAIM_HOLDS + 1] = {"no", "partly", "yes"};

static const CsvColumn columns[] = {
    CSV_MEMBER(ClaimRow, system, CSV_NAME, .key = true),
    CSV_MEMBER(ClaimRow, claim, CSV_TEXT, .maximum = CLAIM_TEXT_SIZE, .quoted = true, .key = true),
    CSV_MEMBER(ClaimRow, source, CSV_TEXT, .maximum = CLAIM_TEXT_SIZE, .quoted = true),
    CSV_MEMBER(ClaimRow, measured, CSV_TEXT, .maximum = CLAIM_TEXT_SIZE, .quoted = true),
    CSV_MEMBER(ClaimRow, figure, CSV_TEXT, .maximum = CLAIM_TEXT_SIZE, .quoted = true),
    CSV_MEMBER(ClaimRow, holds, CSV_WORD, .words = claim_holds_words),
};
const CsvLayout claim_layout = CSV_LAYOUT("systems", columns, ClaimRow, .max_rows = 100);

ClaimHolds claim_at_least(double value, double yes, double partly) {
    return value >= yes ? CLAIM_YES : value >= partly ? CLAIM_PARTLY : CLAIM_NO;
}

ClaimHolds claim_at_most(double value, double yes, double partly) {
    return value <= yes ? CLAIM_YES : value <= partly ? CLAIM_PARTLY : CLAIM_NO;
}

ClaimHolds claim_in_cases(int holding, int cases) {
    return holding == 0 ? CLAIM_NO : holding == cases ? CLAIM_YES : CLAIM_PARTLY;
}

/* What does not fit could not be read back. */
static bool check_text(const Claims *claims, const char *text, Error *error) {
    return (text[0] != '\0' && strlen(text) <= CLAIM_TEXT_SIZE) ||
           error_input(error, claims->system, "a text of a claim has 1 to %d bytes (got '%s')", CLAIM_TEXT_SIZE, text);
}

/* A number that was not measured becomes a dash, which has as many bytes. */
static void show_dashes(char *figure) {
    static const char dash[] = "–";
    _Static_assert(sizeof dash == sizeof "nan", "the text keeps its length");
    for (char *at = strstr(figure, "nan"); at != NULL; at = strstr(at, "nan")) {
        char *begin = at > figure && at[-1] == '-' ? at - 1 : at;
        memmove(begin, at, strlen(at) + 1);
        memcpy(begin, dash, sizeof dash - 1);
    }
}

bool claim_state(const Claims *claims, const Claim *claim, Error *error, const char *format, ...) {
    char figure[CLAIM_TEXT_SIZE + 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(figure, sizeof figure, format, arguments);
    va_end(arguments);
    show_dashes(figure);
    const ClaimRow row = {claims->system, claim->claim, claim->source, claim->measured, figure, (int)claim->holds};
    return check_text(claims, row.claim, error) && check_text(claims, row.source, error) &&
           check_text(claims, row.measured, error) && check_text(claims, row.figure, error) &&
           csv_row_print(claims->lines, &claim_layout, &row, error);
}

bool system_claims_state(const PaperSystem *system, const char *folder, Claims *claims, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, system->table, error)) return false;
    bool stated = true;
    claims->system = system->name;
    for (int i = 0; stated && system->claims[i] != NULL; i++) stated = system->claims[i](claims, &table, error);
    csv_table_free(&table);
    return stated;
}

typedef struct Stating {
    const PaperSystem *const *systems;
    const char *folder;
    Claims claims;
} Stating;

static bool state_all(void *context, FILE *lines, Error *error) {
    Stating *stating = context;
    bool stated = true;
    stating->claims.lines = lines;
    csv_header_print(lines, &claim_layout);
    for (int i = 0; stated && stating->systems[i] != NULL; i++)
        stated = system_claims_state(stating->systems[i], stating->folder, &stating->claims, error);
    return stated;
}

bool system_claims_write(const PaperSystem *const *systems, const char *folder, Error *error) {
    char path[CSV_PATH_SIZE];
    CsvTable scores;
    if (!csv_table_path(path, folder, &claim_layout, error) ||
        !csv_table_read_from(&scores, folder, &system_score_layout, error))
        return false;
    Stating stating = {systems, folder, {.scores = scores.rows, .score_count = scores.count}};
    const bool written = text_write(path, state_all, &stating, error);
    csv_table_free(&scores);
    return written;
}

/* The claims of Sanchez-Gonzalez et al. (2020), judged from system_gns.csv. */

static const char abstract[] = "Sanchez-Gonzalez et al. 2020, abstract";

static const double compared_at = 1; /* s after the launch: later, runs have little in common */

/* m: a twentieth, and a hundredth, of a box's edge. */
static const double deformed = 0.05, little_deformed = 0.01;

/* Share by which the number of boxes that moved may be off. */
static const double moved_right = 0.25;

/* Hours: a day, a week. */
static const double day = 24, week = 168;

static const char *const taught_scenes[] = {"single", "stack", "pyramid_settled"};
enum { TAUGHT_SCENES = sizeof taught_scenes / sizeof *taught_scenes };

static const GnsRow unmeasured = {.error = NAN, .ms_step = NAN, .ms_gradient = NAN, .hours = NAN, .boxes = NAN};

static const GnsRow *claims_find(const CsvTable *table, GnsMeasure measure, const char *variant, const char *scene,
                                 double seconds) {
    const GnsRow *rows = table->rows;
    for (int i = 0; i < table->count; i++)
        if (rows[i].measure == (int)measure && strcmp(rows[i].variant, variant) == 0 &&
            strcmp(rows[i].scene, scene) == 0 && (isnan(seconds) || fabs(rows[i].seconds - seconds) < 1e-6))
            return &rows[i];
    return &unmeasured;
}

static double error_of(const CsvTable *table, int variant, const char *scene) {
    return claims_find(table, GNS_ROLLOUT, gns_variants[variant].name, scene, compared_at)->error;
}

static bool state_text(const Claims *claims, const Claim *claim, const char *text, Error *error) {
    return claim_state(claims, claim, error, "%s", text[0] != '\0' ? text : "not measured");
}

/* Whether the errors of the variants rise from each to the next, in how many scenes and pairs; adds the errors to the
   text. */
static ClaimHolds compare_variants(const CsvTable *table, const int *variants, int count, char text[CLAIM_TEXT_SIZE]) {
    int holding = 0, cases = 0;
    for (int s = 0; s < TAUGHT_SCENES; s++) {
        double before = error_of(table, variants[0], taught_scenes[s]);
        if (isnan(before)) continue;
        text_join(text, CLAIM_TEXT_SIZE, "; ", "%s", taught_scenes[s]);
        for (int v = 0; v < count; v++) {
            const double error = error_of(table, variants[v], taught_scenes[s]);
            text_add(text, CLAIM_TEXT_SIZE, "%s %.2f m (%s)", v > 0 ? "," : ":", error, gns_variants[variants[v]].name);
            cases += v > 0;
            holding += v > 0 && before < error;
            before = error;
        }
    }
    return claim_in_cases(holding, cases);
}

static bool claim_rounds(const Claims *claims, const CsvTable *table, Error *error) {
    static const int variants[] = {GNS_SHIPPED, GNS_TWO_ROUNDS, GNS_ONE_ROUND};
    char text[CLAIM_TEXT_SIZE] = "";
    const Claim claim = {"The error of a rollout falls with the number M of rounds of messages", abstract,
                         "Mean distance of boxes from the taught run 1 s after the launch, held-out launches; of each "
                         "scene, M = 5 must beat 2, and 2 must beat 1",
                         compare_variants(table, variants, 3, text)};
    return state_text(claims, &claim, text, error);
}

static bool claim_noise(const Claims *claims, const CsvTable *table, Error *error) {
    static const int variants[] = {GNS_SHIPPED, GNS_NO_NOISE};
    char text[CLAIM_TEXT_SIZE] = "";
    const Claim claim = {
        "Noise on the inputs in training lowers the error of a rollout", abstract,
        "The same distance, of the same network trained without noise; it must be larger in each scene",
        compare_variants(table, variants, 2, text)};
    return state_text(claims, &claim, text, error);
}

static bool claim_shapes(const Claims *claims, const CsvTable *table, Error *error) {
    double most = NAN;
    char text[CLAIM_TEXT_SIZE] = "";
    for (int s = 0; s < TAUGHT_SCENES; s++) {
        const GnsRow *soon = NULL, *last = NULL;
        for (int i = 0; i < table->count; i++) {
            const GnsRow *row = (const GnsRow *)table->rows + i;
            if (row->measure != GNS_ROLLOUT || strcmp(row->variant, gns_variants[GNS_NOT_RIGID].name) != 0 ||
                strcmp(row->scene, taught_scenes[s]) != 0)
                continue;
            if (soon == NULL) soon = row;
            last = row;
        }
        if (soon == NULL) continue;
        text_join(text, CLAIM_TEXT_SIZE, "; ", "%s", taught_scenes[s]);
        text_add(text, CLAIM_TEXT_SIZE, ": %.3f m after %g s, %.3f m after %g s", soon->shape, soon->seconds,
                 last->shape, last->seconds);
        most = fmax(most, last->shape);
    }
    const Claim claim = {
        "Particles alone do not keep shapes: boxes deform in long rollouts",
        "Sanchez-Gonzalez et al. 2020, section 3: particles, without a constraint of rigid bodies",
        "Distance of particles from the best-fitting rigid box, with rigid=off; yes from 5% of a box's "
        "edge in the worst scene, partly from 1%",
        claim_at_least(most, deformed, little_deformed)};
    return state_text(claims, &claim, text, error);
}

static bool claim_large(const Claims *claims, const CsvTable *table, Error *error) {
    static const char *const piles[] = {"pyramid", "pyramid_18"};
    int right = 0, cases = 0;
    char text[CLAIM_TEXT_SIZE] = "";
    for (int s = 0; s < 2; s++) {
        const GnsRow *row = claims_find(table, GNS_LARGE, gns_variants[GNS_SHIPPED].name, piles[s], NAN);
        if (row == &unmeasured) continue;
        text_join(text, CLAIM_TEXT_SIZE, "; ", "%s", piles[s]);
        text_add(text, CLAIM_TEXT_SIZE, ", %.0f boxes: %.0f moved (taught run: %.0f), %.2g m off, %.3g ms a step",
                 row->boxes, row->moved, row->moved_engine, row->error, row->ms_step);
        right += fabs(row->moved - row->moved_engine) <= moved_right * fmax(row->moved_engine, 1);
        cases++;
    }
    const Claim claim = {"One network simulates many more bodies than it was trained on: 66 to 200 boxes", abstract,
                         "Boxes that moved more than 0.5 m: in each pile, their number must be within 25% of the "
                         "taught run's. An example of training has at most 12 boxes",
                         claim_in_cases(right, cases)};
    return state_text(claims, &claim, text, error);
}

static bool claim_cost(const Claims *claims, const CsvTable *table, Error *error) {
    const GnsRow *ours = claims_find(table, GNS_COST, "width 16, M = 5", "pyramid_settled", NAN),
                 *theirs = claims_find(table, GNS_COST, "width 128, M = 10", "pyramid_settled", NAN);
    const Claim claim = {
        "The paper's own network, 128 wide with M = 10, can be trained as there: 20 million steps of 2",
        "Sanchez-Gonzalez et al. 2020, appendix on training",
        "Time of a gradient step, all threads of this machine; yes within a day, partly within a week",
        claim_at_most(theirs->hours, day, week)};
    return claim_state(
        claims, &claim, error,
        "%.3g ms a gradient step, %.3g hours in all (16 wide, M = 5: %.3g ms, %.3g hours); a step of %.0f "
        "boxes takes %.3g ms (%.3g ms)",
        theirs->ms_gradient, theirs->hours, ours->ms_gradient, ours->hours, theirs->boxes, theirs->ms_step,
        ours->ms_step);
}

ClaimRule *const gns_claims[] = {claim_rounds, claim_noise, claim_shapes, claim_large, claim_cost, NULL};

/* The claims of in-situ adaptive tabulation and of the paper's description of Ajay et al., judged from
   system_hybrid.csv. */

/* Those that the issue of memory is about: single, stack, settled pyramid. */
enum { REMEMBERED = 3 };
static const int remembered[REMEMBERED] = {0, 1, 3};

static const double standard_tolerance = 0.1; /* m/s */

/* The last row of a scene's learning with the standard tolerance: of one family; before a change; after it. */
typedef enum Part { ONE_FAMILY, BEFORE_CHANGE, AFTER_CHANGE } Part;

static HybridRow last_row(const CsvTable *table, int scene, Part part) {
    HybridRow found = {.share = NAN,
                       .error_95 = NAN,
                       .us_answer = NAN,
                       .us_solve = NAN,
                       .us_step = NAN,
                       .us_step_solve = NAN,
                       .paid = NAN};
    for (int i = 0; i < table->count; i++) {
        const HybridRow *row = (const HybridRow *)table->rows + i;
        if (row->scene == remembered[scene] && row->changes == (part != ONE_FAMILY) &&
            row->turned == (part == AFTER_CHANGE) && fabs(row->tolerance - standard_tolerance) < 1e-6)
            found = *row;
    }
    return found;
}

static bool claim_growth(const Claims *claims, const CsvTable *table, Error *error) {
    double share[REMEMBERED];
    int holding = 0;
    for (int i = 0; i < REMEMBERED; i++) {
        share[i] = last_row(table, i, ONE_FAMILY).share;
        holding += share[i] >= 0.5;
    }
    const Claim claim = {
        "After some launches most queries are answered from memory", "Pope 1997, section 4",
        "share of steps with an impact that the memory answers after all launches of one family; at least half "
        "(single, stack, settled pyramid)",
        claim_in_cases(holding, REMEMBERED)};
    return claim_state(claims, &claim, error, "%.0f%%, %.0f%%, %.0f%%", 100 * share[0], 100 * share[1], 100 * share[2]);
}

static bool claim_answers(const Claims *claims, const CsvTable *table, Error *error) {
    double wrong[REMEMBERED];
    int holding = 0;
    for (int i = 0; i < REMEMBERED; i++) {
        wrong[i] = last_row(table, i, ONE_FAMILY).error_95;
        holding += wrong[i] <= standard_tolerance;
    }
    const Claim claim = {
        "The error of answers stays within the tolerance", "Pope 1997, section 4; Lu and Pope 2009",
        "95% of the answers on launches not learned are within the tolerance of 0.1 m/s (single, stack, "
        "settled pyramid)",
        claim_in_cases(holding, REMEMBERED)};
    return claim_state(claims, &claim, error, "%.3g, %.3g, %.3g m/s", wrong[0], wrong[1], wrong[2]);
}

static bool claim_time_saved(const Claims *claims, const CsvTable *table, Error *error) {
    double factor[REMEMBERED], whole[REMEMBERED];
    int holding = 0;
    for (int i = 0; i < REMEMBERED; i++) {
        const HybridRow row = last_row(table, i, ONE_FAMILY);
        factor[i] = row.us_solve / row.us_answer;
        whole[i] = row.us_step_solve / row.us_step;
        holding += whole[i] >= 2;
    }
    const Claim claim = {
        "Tabulation is faster than solving, by orders of magnitude", "Pope 1997, section 4 (a factor of 1000)",
        "time of interior:near=0.001 over that of hybrid, on answered steps and, in brackets, on all steps with an "
        "impact, of which the latter is at least 2 (single, stack, settled pyramid)",
        claim_in_cases(holding, REMEMBERED)};
    return claim_state(claims, &claim, error, "%.3g (%.3g), %.3g (%.3g), %.3g (%.3g) times", factor[0], whole[0],
                       factor[1], whole[1], factor[2], whole[2]);
}

static bool claim_paid(const Claims *claims, const CsvTable *table, Error *error) {
    char text[REMEMBERED][24];
    int holding = 0;
    for (int i = 0; i < REMEMBERED; i++) {
        const double paid = last_row(table, i, ONE_FAMILY).paid;
        if (isnan(paid))
            snprintf(text[i], sizeof text[i], "never");
        else
            snprintf(text[i], sizeof text[i], "%.0f", paid);
        holding += !isnan(paid);
    }
    const Claim claim = {
        "The time saved pays for the learning", "the paper's description of Ajay et al. 2019",
        "launch from which on time saved exceeds the time spent on learning and questions, with one family "
        "(single, stack, settled pyramid)",
        claim_in_cases(holding, REMEMBERED)};
    return claim_state(claims, &claim, error, "%s, %s, %s", text[0], text[1], text[2]);
}

static bool claim_change(const Claims *claims, const CsvTable *table, Error *error) {
    double before[REMEMBERED], after[REMEMBERED];
    int holding = 0;
    for (int i = 0; i < REMEMBERED; i++) {
        before[i] = last_row(table, i, BEFORE_CHANGE).share;
        after[i] = last_row(table, i, AFTER_CHANGE).share;
        holding += after[i] >= 0.5 * before[i];
    }
    const Claim claim = {
        "The memory grows into new situations", "the paper's description of Ajay et al. 2019",
        "share answered before bombs turn and spin, and after as many launches with it; at least half of that "
        "before (single, stack, settled pyramid)",
        claim_in_cases(holding, REMEMBERED)};
    return claim_state(claims, &claim, error, "%.0f%% and %.0f%%, %.0f%% and %.0f%%, %.0f%% and %.0f%%",
                       100 * before[0], 100 * after[0], 100 * before[1], 100 * after[1], 100 * before[2],
                       100 * after[2]);
}

ClaimRule *const hybrid_claims[] = {claim_growth, claim_answers, claim_time_saved, claim_paid, claim_change, NULL};

/* The claims of Ajay et al. (2019), judged from system_sain.csv. */

#define SOURCE "Ajay et al. 2019"

static const double clear = 0.95; /* of the rival's error: less is a gain that seeds do not explain */

/* The numbers of launches up to SAIN_LITTLE at which sain is more accurate than the other form. */
typedef struct Launches {
    int holding, count;
    double first[2], last[2]; /* both errors with the fewest and the most launches of these */
} Launches;

static Launches compare_forms(const CsvTable *table, SainForm other) {
    Launches cases = {0};
    for (int launches = 1; launches <= SAIN_LITTLE; launches *= 2) {
        const double with = sain_median(table, SAIN_STACK, SAIN_WITH_ENGINE, launches, sain_error),
                     without = sain_median(table, SAIN_STACK, other, launches, sain_error);
        if (isnan(with) || isnan(without)) continue;
        double *kept = cases.count == 0 ? cases.first : cases.last;
        kept[0] = with;
        kept[1] = without;
        cases.holding += with < clear * without;
        cases.count++;
    }
    return cases;
}

static bool claim_cases(const Claims *claims, const CsvTable *table, SainForm other, const Claim *claim, Error *error) {
    const Launches cases = compare_forms(table, other);
    Claim judged = *claim;
    judged.holds = claim_in_cases(cases.holding, cases.count);
    return claim_state(claims, &judged, error, "%.2f against %.2f m/s after 1 launch, %.2f against %.2f after %d",
                       cases.first[0], cases.first[1], cases.last[0], cases.last[1], SAIN_LITTLE);
}

/* Against the engine alone, with all launches. */
static bool claim_gain(const Claims *claims, const CsvTable *table, SainScene scene, const Claim *claim, Error *error) {
    const int most = sain_most_launches(table);
    const double with = sain_median(table, scene, SAIN_WITH_ENGINE, most, sain_error),
                 alone = sain_median(table, scene, SAIN_ALONE, most, sain_error),
                 engine = sain_median(table, scene, SAIN_WITH_ENGINE, most, sain_engine_error);
    Claim judged = *claim;
    judged.holds = claim_at_most(with / engine, clear, 1);
    return claim_state(claims, &judged, error, "%.2f m/s; engine alone %.2f, network alone %.2f", with, engine, alone);
}

static bool claim_faster(const Claims *claims, const CsvTable *table, Error *error) {
    static const Claim claim = {.claim = "With little data it is more accurate than the network alone",
                                .source = SOURCE ", abstract",
                                .measured =
                                    "stack, RMS velocity error at held-out impacts after 1 to 16 launches; holds "
                                    "where it is at most 95% of that without the engine"};
    return claim_cases(claims, table, SAIN_ALONE, &claim, error);
}

static bool claim_knows(const Claims *claims, const CsvTable *table, Error *error) {
    static const Claim claim = {.claim = "It uses what the engine did to each body",
                                .source = SOURCE ", model",
                                .measured = "the same beside a network that sees, and corrects, what the engine did to "
                                            "another body"};
    return claim_cases(claims, table, SAIN_SHUFFLED, &claim, error);
}

static bool claim_better(const Claims *claims, const CsvTable *table, Error *error) {
    static const Claim claim = {.claim = "The learned correction makes the engine more accurate",
                                .source = SOURCE ", abstract",
                                .measured =
                                    "stack, held-out impacts, most launches; holds below 95% of the error of the "
                                    "engine alone, partly below all of it"};
    return claim_gain(claims, table, SAIN_STACK, &claim, error);
}

static bool claim_transfers(const Claims *claims, const CsvTable *table, Error *error) {
    static const Claim claim = {.claim = "It generalises to scenes that it was not trained on",
                                .source = SOURCE ", abstract",
                                .measured = "the same, trained on the stack only and scored on the settled pyramid"};
    return claim_gain(claims, table, SAIN_PYRAMID, &claim, error);
}

ClaimRule *const sain_claims[] = {claim_faster, claim_knows, claim_better, claim_transfers, NULL};

/* What Holden et al. 2019 claim, judged by system_subspace.csv. */

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

static bool claim_step_time(const Claims *claims, const CsvTable *table, Error *error) {
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

static bool claim_distance(const Claims *claims, const CsvTable *table, Error *error) {
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

ClaimRule *const subspace_claims[] = {claim_step_time, claim_distance, claim_network, claim_components, NULL};
