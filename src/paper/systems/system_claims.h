/* SPDX-License-Identifier: GPL-3.0-or-later */
/* systems.csv: what the papers of the systems claim, and whether it holds here. Every verdict follows from measured
   numbers by a rule in code. */
#pragma once
#include "paper/systems/system_scores.h"

#include <stdio.h>

typedef enum ClaimHolds { CLAIM_NO, CLAIM_PARTLY, CLAIM_YES } ClaimHolds;
enum { CLAIM_HOLDS = CLAIM_YES + 1, CLAIM_TEXT_SIZE = 400 };

extern const char *const claim_holds_words[CLAIM_HOLDS + 1]; /* no, partly, yes */

typedef struct ClaimRow {
    const char *system, *claim, *source, *measured, *figure; /* at most CLAIM_TEXT_SIZE bytes each, one line */
    int holds;                                               /* ClaimHolds */
} ClaimRow;

extern const CsvLayout claim_layout;

/* What a system's claims are judged from, and where they go. */
typedef struct Claims {
    const char *system;           /* its name */
    const char *folder;           /* of the study: its table is in folder/system_NAME.csv */
    const SystemScoreRow *scores; /* [score_count] of all systems and rivals (system_score_find) */
    int score_count;
    FILE *lines; /* claim_state() writes to it */
} Claims;

typedef struct Claim {
    const char
        *claim; /* of their paper, one short sentence: "With little data it learns faster than the network alone" */
    const char *source;   /* "Ajay et al. 2019, section V" */
    const char *measured; /* here: what was measured, in which scenes, and by which rule it holds */
    ClaimHolds holds;
} Claim;

/* Adds a row. The format gives the figure: numbers with their units, "3.1 times (stack), 1.4 times (pyramid)"; NaN becomes
   a dash. */
bool claim_state(const Claims *claims, const Claim *claim, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* A rule of two limits: yes from `yes` on, partly from `partly` on. NaN, which was not measured, does not hold. */
ClaimHolds claim_at_least(double value, double yes, double partly);
ClaimHolds claim_at_most(double value, double yes, double partly);

/* A rule of several cases: yes if all of them hold, no if none does. */
ClaimHolds claim_in_cases(int holding, int cases);

/* Writes folder/systems.csv from the systems' tables and folder/system_scores.csv. systems: ended by NULL. ERROR_INPUT
   where a table is missing or damaged, with path:line:column, or a text is too long. */
struct PaperSystem;
bool system_claims_write(const struct PaperSystem *const *systems, const char *folder, Error *error);
