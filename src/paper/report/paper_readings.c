/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the paper leaves open or tells in two ways, and which ways were taken; its figures 1 to 4. */
#include "paper/report/paper_parts.h"

static const char *const readings[][3] = {
    {"Inputs",
     "Ten numbers of positions, velocities and angular velocities (section 3); rotations too (section 4), which makes "
     "twelve; differences of positions instead of positions (3.1)",
     "relative: difference of positions, velocities, spins, rotations (10). raw: positions of both and rotations (12). "
     "raw-unturned: raw without rotations (10)"},
    {"Outputs", "Six: velocities and spins of both bodies (section 3). Two: a change of velocity along x and y (3.2)",
     "Both. Two are the change of the relative velocity"},
    {"Target",
     "The velocity after the collision (3), the relative velocity (3.1), a derivative of the velocity (3.2, 4)",
     "pair: what the pair's own impulses change in the step. net: the whole change of its bodies. impulse: one impulse "
     "in one sweep"},
    {"Hidden layers", "One of ten (3.2); two, as the new architecture (3.3); one to four searched (3)",
     "10-10-2 is the baseline; one to four layers in the search"},
    {"Output layer", "Linear, outputs standardised (3.1); sigmoid, outputs scaled to [0, 1] (3.2)",
     "Both. Errors of different scales are compared by their ratio to the constant's"},
    {"Launches",
     "X in ±15 m, printed as [15, 15], with random rotation and spin; then X in ±5 m in steps of 0.05 m (3.3)",
     "swept, random, and a mix"},
    {"Loss",
     "Aim below 0.001 (3.2); 0.000728 after 2000 iterations (Table 1); \"within the 10^-4 range\" after 5000 (3.3)",
     "Table 1 is compared row by row"},
    {"Accuracy", "The gate of 90% (3) and the successful predictions of 60% to 91% (4) are not defined",
     "Three definitions: within 5% of the output's range; within 0.1 m/s; bodies right against the converged solution"},
};

enum { READINGS = sizeof readings / sizeof *readings };

static void put_figures(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Engine, data and scenes");
    document_paragraph(document, "Figures 1 to 4 are the paper's, drawn anew from runs of this engine. They show the "
                                 "loop of the engine, its narrow phase, how data are recorded, and the scenes.");
    for (int i = FIGURE_LOOP; i <= FIGURE_SCENES; i++) document_figure(document, &files->figures[i]);
}

void paper_put_readings(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "What the paper leaves open");
    document_paragraph(document, "The paper tells some things in two ways and others not at all. Where it does, all "
                                 "readings below were tried, and every row of this report names its own.");
    for (int i = 0; i < READINGS; i++)
        document_item(document, "%s. The paper: %s. Here: %s.", readings[i][0], readings[i][1], readings[i][2]);
    document_paragraph(
        document, "The constant predictor says the mean of the training rows, whatever goes in. A few hard impacts "
                  "stretch the range of the outputs, so on the scale [0, 1] nearly all rows lie close to the mean, "
                  "and small errors and high rates come for free. The honest figure is the ratio of the test error "
                  "to the constant's: 1 has learned nothing, 0 everything.");
    put_figures(document, files);
}
