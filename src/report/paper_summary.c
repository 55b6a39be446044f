/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The few numbers that decide. */
#include "report/paper_parts.h"

#include <math.h>
#include <string.h>

static void put_best(Document *document, const PaperFiles *files, const PaperTarget *target) {
    int among;
    const NetworkRow *best = paper_best(files, target->name, &among);
    if (best == NULL) return;
    int worse = 0;
    for (int i = 0; i < PAPER_ROWS; i++) worse += paper_scores[i].test > best->constant;
    document_item(
        document,
        "Target %s (%s): always saying the mean scores %s, less than %d of the %d rows of the paper's Table 1. "
        "The best of %d small networks, %s, scores %s: %s of the constant's error.",
        target->name, target->words, show_number(best->constant).text, worse, PAPER_ROWS, among,
        csv_show(best->network).text, show_number(best->test).text, show_percent(best->ratio).text);
}

static void put_gate(Document *document, const PaperFiles *files) {
    int known = 0, passed = 0, useless = 0;
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (isnan(row->accuracy) || isnan(row->ratio)) continue;
        known++;
        passed += row->accuracy > PAPER_GATE;
        useless += row->accuracy > PAPER_GATE && row->ratio >= 1;
    }
    document_item(
        document,
        "The paper puts a network into the engine when it is right in over 90%% of cases. %d of %d networks "
        "pass that gate, read as \"within 5%% of the output's range\"; %d of those that pass are no better than "
        "the constant.",
        passed, known, useless);
}

static void put_rate(Document *document, const PaperFiles *files, const NetworkRow *baseline, const char *definition,
                     const char *words) {
    double least = INFINITY, most = -INFINITY;
    int count = 0, beaten = 0;
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        if (strcmp(row->network, baseline->network) != 0 || strcmp(row->definition, definition) != 0 ||
            strcmp(row->phase, "all") != 0 || isnan(row->rate))
            continue;
        least = fmin(least, row->rate);
        most = fmax(most, row->rate);
        beaten += row->rate <= row->constant;
        count++;
    }
    if (count == 0) return;
    document_item(document,
                  "The paper reports 60%% to 91%% successful predictions and does not define success. Counted as %s, "
                  "the baseline is right in %s to %s of cases over %d scenes; in %d of them the constant is right at "
                  "least as often.",
                  words, show_percent(least).text, show_percent(most).text, count, beaten);
}

static void put_closed_loop(Document *document, const PaperFiles *files) {
    int runs = 0, together = 0;
    double shortest = PAPER_RUN_FRAMES, longest = 0;
    for (int i = 0; i < files->closed_loop_count; i++) {
        const ClosedLoopRow *row = &files->closed_loop[i];
        if (strcmp(row->network, "warm-start") == 0) continue;
        runs++;
        together += row->frames >= PAPER_RUN_FRAMES;
        shortest = fmin(shortest, row->frames);
        longest = fmax(longest, row->frames);
    }
    if (runs == 0) return;
    document_item(
        document,
        "With a network in place of the solver, %d of %d runs stay within 0.1 m of the engine's for %d frames "
        "(10 s); the first leaves it after %.0f frames, the last after %.0f%s.",
        together, runs, PAPER_RUN_FRAMES, shortest, longest, together > 0 ? " (never)" : "");
}

static void put_contact_net(Document *document, const PaperFiles *files) {
    static const char *const scenes[] = {"single", "stack"};
    for (int i = 0; i < 2; i++) {
        const RateRow *row = paper_contact_net_rate(files, scenes[i]);
        const RateRow *warm = paper_rate(files, "warm-start", scenes[i], "absolute", "all");
        if (row == NULL) continue;
        document_item(
            document,
            "Beyond the paper, a network that gives impulses instead of velocities (%s) is within 0.1 m/s in %s "
            "of cases in scene %s; the impulses of the step before, used again unchanged, in %s.",
            csv_show(row->network).text, show_percent(row->rate).text, scenes[i],
            show_percent(warm != NULL ? warm->rate : NAN).text);
    }
}

void paper_put_summary(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Summary");
    for (int i = 0; i < PAPER_TARGETS; i++) put_best(document, files, &paper_targets[i]);
    put_gate(document, files);
    const NetworkRow *baseline = paper_network(files, "baseline");
    if (baseline != NULL) {
        put_rate(document, files, baseline, "range", "\"within 5% of the output's range\"");
        put_rate(document, files, baseline, "absolute", "\"within 0.1 m/s\"");
    }
    put_closed_loop(document, files);
    put_contact_net(document, files);
}
