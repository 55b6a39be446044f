/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs with a network in place of the solver, and those of networks that give impulses. */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

static double cost_ratio(const ClosedLoopRow *row) { return row->us_engine > 0 ? row->us_step / row->us_engine : NAN; }

static void put_row(Document *document, const ClosedLoopRow *row) {
    document_name(document, row->network);
    document_name(document, row->scene);
    if (row->frames >= PAPER_RUN_FRAMES)
        document_cell(document, "all %d", PAPER_RUN_FRAMES);
    else
        document_number(document, row->frames);
    document_number(document, row->penetration);
    document_number(document, row->momentum);
    document_number(document, row->energy);
    document_number(document, row->us_step);
    document_number(document, row->us_engine);
    document_number(document, cost_ratio(row));
}

static const char columns[] =
    "Network|Scene|>Frames until apart|>Deepest penetration (m)|>Momentum error (N s)|>Energy / put "
    "in|>µs a step|>µs, engine|>Cost / engine";

/* No failure is hidden: each run of a scene is told. */
static void put_stack(Document *document, const ClosedLoopRow *row) {
    if (row->frames >= PAPER_RUN_FRAMES)
        document_item(document, "With %s the stack does as the engine's for all %d frames.",
                      csv_show(row->network).text, PAPER_RUN_FRAMES);
    else
        document_item(document,
                      "With %s the stack does not stand as the engine's does: it is 0.1 m apart after %s frames "
                      "(%.2f s).",
                      csv_show(row->network).text, show_number(row->frames).text, row->frames / 60);
}

static void put_cost(Document *document, const PaperFiles *files) {
    int known = 0, dearer = 0;
    double most = 0;
    const char *where = "";
    for (int i = 0; i < files->closed_loop_count; i++) {
        double ratio = cost_ratio(&files->closed_loop[i]);
        if (isnan(ratio)) continue;
        known++;
        dearer += ratio > 1;
        if (ratio > most) most = ratio, where = files->closed_loop[i].scene;
    }
    if (known == 0) return;
    document_paragraph(
        document,
        "The paper saw no difference in time in the small scenes and a slow pyramid. Here a step costs more "
        "than the engine's in %d of %d runs; the dearest costs %s times as much (%s).",
        dearer, known, show_number(most).text, csv_show(where).text);
}

void paper_put_closed_loop(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "In place of the solver");
    document_paragraph(
        document,
        "The network runs in the engine for %d frames, and each frame begins where its own last one ended. "
        "A run is apart once a body is 0.1 m from where the engine has it. Momentum error is the momentum "
        "that a step makes from nothing, energy the largest mechanical energy over what was put in: above "
        "1 it was made from nothing, too. Where several launches were run, frames are their median.",
        PAPER_RUN_FRAMES);
    document_table(document, "Closed loop", columns);
    for (int i = 0; i < files->closed_loop_count; i++) put_row(document, &files->closed_loop[i]);
    for (int i = 0; i < files->closed_loop_count; i++)
        if (strcmp(files->closed_loop[i].scene, "stack") == 0) put_stack(document, &files->closed_loop[i]);
    put_cost(document, files);
    document_figure(document, &files->figures[FIGURE_CLOSED_LOOP]);
}

/* NAN where none was measured. */
static double largest_momentum(const PaperFiles *files, const char *factor) {
    double largest = NAN;
    for (int i = 0; i < files->closed_loop_count; i++)
        if (paper_has_factor(files, files->closed_loop[i].network, factor))
            largest = fmax(largest, files->closed_loop[i].momentum); /* of a number and NAN, the number */
    return largest;
}

void paper_put_contact_net(Document *document, const PaperFiles *files) {
    if (paper_network_row(files, "contact-net") == NULL) return;
    document_heading(document, 2, "Outputs that obey the laws: contact-net");
    document_paragraph(document, "Beyond the paper: the network gives impulses along the contact's normal and tangent, "
                                 "projected on the friction cone, and both bodies get the same with opposite signs. "
                                 "So no step makes momentum from nothing, beyond rounding, whatever the network says.");
    document_table(document, "contact-net and baseline, closed loop", columns);
    for (int i = 0; i < files->closed_loop_count; i++) {
        const ClosedLoopRow *row = &files->closed_loop[i];
        if (paper_has_factor(files, row->network, "contact-net") || paper_has_factor(files, row->network, "baseline"))
            put_row(document, row);
    }
    double momentum = largest_momentum(files, "contact-net"), baseline = largest_momentum(files, "baseline");
    if (isnan(momentum) || isnan(baseline)) return;
    document_paragraph(document, "The largest momentum error of its runs is %s N s, of the baseline's %s N s.",
                       show_number(momentum).text, show_number(baseline).text);
}
