/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the paper's report, in their order, and what they have in common. */
#pragma once
#include "paper/report/paper_files.h"

/* Counted by the parts on the paper's outlook, told again among its claims. */
typedef struct PaperFindings {
    int law_cases, laws_obeyed, laws_better; /* single laws and weights; of these, fewer violations, less test error */
    int transfer_rows, transfer_saved;       /* numbers of launches; those of which transfer needs fewer */
} PaperFindings;

void paper_put_summary(Document *document, const PaperFiles *files);
void paper_put_readings(Document *document, const PaperFiles *files);
void paper_put_table1(Document *document, const PaperFiles *files);
void paper_put_factors(Document *document, const PaperFiles *files);
void paper_put_rates(Document *document, const PaperFiles *files);
void paper_put_closed_loop(Document *document, const PaperFiles *files);
void paper_put_contact_net(Document *document, const PaperFiles *files);
void paper_put_laws(Document *document, const PaperFiles *files, PaperFindings *findings);
void paper_put_transfer(Document *document, const PaperFiles *files, PaperFindings *findings);
void paper_put_aims(Document *document, const PaperFiles *files);
void paper_put_claims(Document *document, const PaperFiles *files, const PaperFindings *findings);
void paper_put_study(Document *document, const PaperFiles *files);

enum { PAPER_SMALL_NETWORK = 500 }; /* parameters: the aims are for networks of at most so many */

/* The paper's gate: a network that passes it goes into the engine (section 3). */
#define PAPER_GATE 0.9

/* The paper's test scores of Table 1, by iteration. */
enum { PAPER_ROWS = 6 };
typedef struct PaperScore {
    double iteration, test, train;
} PaperScore;
extern const PaperScore paper_scores[PAPER_ROWS];

/* The three targets of the aims, by the words of the tables and in words; and the aim, a ratio to the constant. */
enum { PAPER_TARGETS = 3 };
typedef struct PaperTarget {
    const char *name, *words;
    double aim;
} PaperTarget;
extern const PaperTarget paper_targets[PAPER_TARGETS];

/* The first network with this factor, or NULL. */
const NetworkRow *paper_network_row(const PaperFiles *files, const char *factor);

/* The network of a target with the least ratio to the constant, of at most PAPER_SMALL_NETWORK parameters; NULL where
   there is none. *among: of how many. */
const NetworkRow *paper_best(const PaperFiles *files, const char *target, int *among);

/* NULL where there is no such row. */
const RateRow *paper_rate(const PaperFiles *files, const char *network, const char *scene, const char *definition,
                          const char *phase);

/* The constant's error for a target on the paper's scale, outputs scaled to [0, 1]; NAN where no network has that. */
double paper_constant(const PaperFiles *files, const char *target);

/* Whether scores of this network may stand beside the paper's: a target of the paper's, on its scale. */
bool paper_comparable(const PaperFiles *files, const char *network, const char *target);

/* The contact-net with the highest rate within 0.1 m/s in a scene; NULL where there is none. */
const RateRow *paper_contact_net_rate(const PaperFiles *files, const char *scene);

/* Whether networks.csv has the network under this factor. */
bool paper_has_factor(const PaperFiles *files, const char *network, const char *factor);
