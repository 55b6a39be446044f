/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's claims that a choice of a factor lowers the error. */
#include "paper/findings/findings_tables.h"

#include <math.h>
#include <string.h>

/* Which side of a claim a network is on. */
typedef enum Side { WITHOUT, WITH, NEITHER, SIDES = NEITHER } Side;

static Side side_of(const char *word, const char *with, const char *without) {
    if (strcmp(word, with) == 0) return WITH;
    return strncmp(word, without, strlen(without)) == 0 ? WITHOUT : NEITHER;
}

/* raw, or raw-unturned. */
static Side by_inputs(const TrainedRow *row) { return side_of(row->inputs, "relative", "raw"); }
static Side by_labels(const TrainedRow *row) { return side_of(row->labels, "reference", "engine"); }
static Side by_data(const TrainedRow *row) { return side_of(row->data, "swept", "random"); }

/* Each with the scale that the paper uses with it. */
static Side by_output(const TrainedRow *row) {
    const Side side = side_of(row->output, "linear", "sigmoid");
    return strcmp(row->scale, side == WITH ? "standard" : "minmax") == 0 ? side : NEITHER;
}

/* 10-10-10-2 has two hidden layers. */
static Side by_layers(const TrainedRow *row) {
    int dashes = 0;
    for (const char *c = row->layers; *c != '\0'; c++) dashes += *c == '-';
    return dashes == 3 ? WITH : dashes == 2 ? WITHOUT : NEITHER;
}

static const struct {
    const char *factor;
    Side (*side)(const TrainedRow *row);
} claims[] = {
    {"inputs", by_inputs}, {"scaling", by_output}, {"data", by_data}, {"layers", by_layers}, {"labels", by_labels}};

typedef struct FactorClaim {
    const char *factor, *verdict;
    double with, without; /* lowest ratio to the constant predictor, of the baseline and the factor's networks */
} FactorClaim;

/* False if there is no network on one of the sides. */
static bool compare(const StudyTables *study, int claim, FactorClaim *row) {
    double lowest[SIDES] = {NAN, NAN};
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *network = &study->networks[i];
        if (strcmp(network->factor, claims[claim].factor) != 0 && strcmp(network->factor, "baseline") != 0) continue;
        const Side side = claims[claim].side(network);
        if (side != NEITHER) lowest[side] = fmin(lowest[side], network->ratio); /* of a number and NAN, the number */
    }
    *row = (FactorClaim){.factor = claims[claim].factor, .with = lowest[WITH], .without = lowest[WITHOUT]};
    row->verdict = row->with >= 1 && row->without >= 1 ? "Neither beats the constant predictor"
                   : row->with < row->without          ? "The claim holds here"
                                                       : "The claim does not hold here";
    return !isnan(row->with) && !isnan(row->without);
}

static bool write_claims(const FindingsFile *file, const StudyTables *study) {
    for (int claim = 0; claim < (int)(sizeof claims / sizeof *claims); claim++) {
        FactorClaim row;
        if (compare(study, claim, &row) && !findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn columns[] = {FINDINGS_TEXT(FactorClaim, factor), FINDINGS_NUMBER(FactorClaim, with),
                                    FINDINGS_NUMBER(FactorClaim, without), FINDINGS_TEXT(FactorClaim, verdict)};
const FindingsTable findings_claims = FINDINGS_TABLE("claims", columns, FactorClaim, write_claims);
