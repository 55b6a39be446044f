/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The claims of Ajay et al. (2019), judged from system_sain.csv. */
#include "paper/systems/sain_study.h"

#include <math.h>

#define SOURCE "Ajay et al. 2019"

static const double clear = 0.95; /* of the rival's error: less is a gain that seeds do not explain */

/* The numbers of launches up to SAIN_LITTLE at which sain is more accurate than the other form. */
typedef struct Cases {
    int holding, count;
    double first[2], last[2]; /* both errors with the fewest and the most launches of these */
} Cases;

static Cases compare(const CsvTable *table, RelationForm other) {
    Cases cases = {0};
    for (int launches = 1; launches <= SAIN_LITTLE; launches *= 2) {
        const double with = sain_median(table, SAIN_STACK, RELATION_ENGINE, launches, sain_error),
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

static bool claim_cases(const Claims *claims, const CsvTable *table, RelationForm other, const Claim *claim,
                        Error *error) {
    const Cases cases = compare(table, other);
    Claim judged = *claim;
    judged.holds = claim_in_cases(cases.holding, cases.count);
    return claim_state(claims, &judged, error, "%.2f against %.2f m/s after 1 launch, %.2f against %.2f after %d",
                       cases.first[0], cases.first[1], cases.last[0], cases.last[1], SAIN_LITTLE);
}

/* Against the engine alone, with all launches. */
static bool claim_gain(const Claims *claims, const CsvTable *table, SainScene scene, const Claim *claim, Error *error) {
    const int most = sain_most_launches(table);
    const double with = sain_median(table, scene, RELATION_ENGINE, most, sain_error),
                 alone = sain_median(table, scene, RELATION_ALONE, most, sain_error),
                 engine = sain_median(table, scene, RELATION_ENGINE, most, sain_engine_error);
    Claim judged = *claim;
    judged.holds = claim_at_most(with / engine, clear, 1);
    return claim_state(claims, &judged, error, "%.2f m/s; engine alone %.2f, network alone %.2f", with, engine, alone);
}

bool sain_claims_state(const Claims *claims, Error *error) {
    static const Claim faster = {.claim = "With little data it is more accurate than the network alone",
                                 .source = SOURCE ", abstract",
                                 .measured =
                                     "stack, RMS velocity error at held-out impacts after 1 to 16 launches; holds "
                                     "where it is at most 95% of that without the engine"},
                       knows = {.claim = "It uses what the engine did to each body",
                                .source = SOURCE ", model",
                                .measured = "the same beside a network that sees, and corrects, what the engine did to "
                                            "another body"},
                       better = {.claim = "The learned correction makes the engine more accurate",
                                 .source = SOURCE ", abstract",
                                 .measured =
                                     "stack, held-out impacts, most launches; holds below 95% of the error of the "
                                     "engine alone, partly below all of it"},
                       transfers = {.claim = "It generalises to scenes that it was not trained on",
                                    .source = SOURCE ", abstract",
                                    .measured =
                                        "the same, trained on the stack only and scored on the settled pyramid"};
    CsvTable table;
    if (!csv_table_read_from(&table, claims->folder, &sain_layout, error)) return false;
    const bool ok = claim_cases(claims, &table, RELATION_ALONE, &faster, error) &&
                    claim_cases(claims, &table, RELATION_SHUFFLED, &knows, error) &&
                    claim_gain(claims, &table, SAIN_STACK, &better, error) &&
                    claim_gain(claims, &table, SAIN_PYRAMID, &transfers, error);
    csv_table_free(&table);
    return ok;
}
