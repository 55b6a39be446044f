/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's rates of successful prediction, by three definitions. */
#include "paper/report/paper_parts.h"
#include "simulate/phases.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name, *caption;
} definitions[] = {
    {"range", "Within 5% of the output's range, against the engine"},
    {"absolute", "Within 0.1 m/s, against the engine"},
    {"bodies", "Bodies right, against the converged solution of the same step"},
};

enum { DEFINITIONS = sizeof definitions / sizeof *definitions };

/* Networks that vary a factor have their rows above; what is no network of the study, or one that the report is about,
   is shown. The warm start is a column. */
static bool is_shown(const PaperFiles *files, const char *network) {
    static const char *const main_factors[] = {"baseline", "best", "contact-net"};
    if (strcmp(network, "warm-start") == 0) return false;
    bool known = false;
    for (int i = 0; i < files->network_count; i++) known |= strcmp(files->networks[i].network, network) == 0;
    for (int i = 0; i < 3; i++)
        if (paper_has_factor(files, network, main_factors[i])) return true;
    return !known;
}

typedef struct Tally {
    int rows, beaten_by_constant, beaten_by_warm_start, beaten_by_one_sweep;
} Tally;

static void put_row(Document *document, const PaperFiles *files, const RateRow *row, Tally *tally) {
    const RateRow *warm = paper_rate(files, "warm-start", row->scene, row->definition, row->phase);
    double warm_rate = warm != NULL ? warm->rate : NAN;
    document_name(document, row->network);
    document_name(document, row->scene);
    document_name(document, row->phase);
    document_percent(document, row->rate);
    document_percent(document, row->constant);
    document_percent(document, warm_rate);
    for (int i = 0; i < 3; i++) document_percent(document, row->engine[i]);
    tally->rows++;
    tally->beaten_by_constant += row->rate <= row->constant;
    tally->beaten_by_warm_start += row->rate <= warm_rate;
    tally->beaten_by_one_sweep += row->rate <= row->engine[0];
}

static void put_definition(Document *document, const PaperFiles *files, int definition) {
    document_table(document, definitions[definition].caption,
                   "Network|Scene|Frames|>Network|>Constant|>Warm start|>Engine, 1 sweep|>4 sweeps|>10 sweeps");
    Tally tally = {0};
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        if (strcmp(row->definition, definitions[definition].name) != 0 || !is_shown(files, row->network)) continue;
        put_row(document, files, row, &tally);
    }
    document_paragraph(
        document,
        "Of %d rows, the constant is right at least as often in %d, the warm start in %d, one sweep of the "
        "engine in %d.",
        tally.rows, tally.beaten_by_constant, tally.beaten_by_warm_start, tally.beaten_by_one_sweep);
}

void paper_put_rates(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Prediction rates");
    document_paragraph(
        document,
        "The paper's rates, 60%% to 91%%, by three definitions, each beside what costs nothing: the "
        "constant; the warm start, which uses the impulses of the step before again; and the engine with "
        "1, 4 and 10 sweeps, 10 being what it ships with. Frames of the impact begin when the bomb first "
        "touches a box; after: the %d frames that follow; rest: all others. A body is right if its velocity "
        "is within 0.05 m/s, or 5%% of what the solver has to change, of the converged solution.",
        AFTER_FRAMES);
    for (int i = 0; i < DEFINITIONS; i++) put_definition(document, files, i);
    document_figure(document, &files->figures[FIGURE_RATES]);
}
