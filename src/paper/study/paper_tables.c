/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_tables.h"

#include "study/closed_loop.h"

/* A value beyond these limits is an error in the file. */
#define ERROR_MOST 1e30
#define TIME_MOST 1e12 /* us */
#define SEED_MOST 1e10 /* --seed is below 2^32 */

/* Enough for every integer that is written. */
enum { INTEGER_DIGITS = 10, VALUE_SIZE = 256 };

const char *const paper_law_words[LAW_WORDS + 1] = {
    [LAW_MOMENTUM] = "momentum", [LAW_ENERGY] = "energy", [LAW_APPROACH] = "approach", [LAW_CONE] = "cone",
    [LAW_SET_ALL] = "all",       [LAW_SET_NONE] = "none", [LAW_SET_ENGINE] = "engine"};
const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1] = {"adam", "gd", "bfgs", "lm", NULL};
const char *const paper_phase_words[RATE_PHASES + 1] = {
    [PHASE_IMPACT] = "impact", [PHASE_AFTER] = "after", [PHASE_REST] = "rest", [RATE_ALL] = "all"};
static const char *const start_words[] = {"scratch", "transfer", NULL};

static const CsvColumn score_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(ScoreRow, network)},
    {"target", CSV_WORD, .offset = offsetof(ScoreRow, target), .words = pair_target_names},
    {"optimizer", CSV_WORD, .offset = offsetof(ScoreRow, optimizer), .words = paper_optimizer_words},
    {"iteration", CSV_NUMBER, .offset = offsetof(ScoreRow, iteration), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(ScoreRow, test), .maximum = ERROR_MOST},
    {"train", CSV_OPTIONAL, .offset = offsetof(ScoreRow, train), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(ScoreRow, constant), .maximum = ERROR_MOST},
};

static const CsvColumn trained_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(TrainedRow, network)},
    {"factor", CSV_NAME, .offset = offsetof(TrainedRow, factor)},
    {"value", CSV_NAME, .offset = offsetof(TrainedRow, value), .quoted = true},
    {"inputs", CSV_NAME, .offset = offsetof(TrainedRow, inputs)},
    {"data", CSV_NAME, .offset = offsetof(TrainedRow, data)},
    {"labels", CSV_NAME, .offset = offsetof(TrainedRow, labels)},
    {"target", CSV_WORD, .offset = offsetof(TrainedRow, target), .words = pair_target_names},
    {"layers", CSV_NAME, .offset = offsetof(TrainedRow, layers)},
    {"hidden", CSV_NAME, .offset = offsetof(TrainedRow, hidden)},
    {"output", CSV_NAME, .offset = offsetof(TrainedRow, output)},
    {"scale", CSV_NAME, .offset = offsetof(TrainedRow, scale)},
    {"optimizer", CSV_NAME, .offset = offsetof(TrainedRow, optimizer)},
    {"loss", CSV_NAME, .offset = offsetof(TrainedRow, loss)},
    {"iterations", CSV_OPTIONAL, .offset = offsetof(TrainedRow, iterations), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"parameters", CSV_OPTIONAL, .offset = offsetof(TrainedRow, parameters), .maximum = 1e9, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(TrainedRow, test), .maximum = ERROR_MOST},
    {"train", CSV_OPTIONAL, .offset = offsetof(TrainedRow, train), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(TrainedRow, constant), .maximum = ERROR_MOST},
    {"ratio", CSV_OPTIONAL, .offset = offsetof(TrainedRow, ratio), .maximum = ERROR_MOST},
    {"accuracy", CSV_OPTIONAL, .offset = offsetof(TrainedRow, accuracy), .maximum = 1},
};

static const CsvColumn rate_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(RateRow, network)},
    {"scene", CSV_WORD, .offset = offsetof(RateRow, scene), .words = paper_scene_names},
    {"definition", CSV_WORD, .offset = offsetof(RateRow, definition), .words = rate_definition_names},
    {"phase", CSV_WORD, .offset = offsetof(RateRow, phase), .words = paper_phase_words},
    {"rate", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_NETWORK]), .maximum = 1},
    {"constant", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_CONSTANT]), .maximum = 1},
    {"engine1", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE1]), .maximum = 1},
    {"engine4", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE4]), .maximum = 1},
    {"engine10", CSV_OPTIONAL, .offset = offsetof(RateRow, share[RATE_ENGINE10]), .maximum = 1},
};

static const CsvColumn closed_loop_columns[] = {
    {"network", CSV_NAME, .offset = offsetof(ClosedLoopRow, network)},
    {"scene", CSV_WORD, .offset = offsetof(ClosedLoopRow, scene), .words = paper_scene_names},
    {"frames_until_apart", CSV_NUMBER, .offset = offsetof(ClosedLoopRow, frames_until_apart),
     .maximum = CLOSED_LOOP_FRAMES},
    {"penetration_max", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, penetration_max), .maximum = ERROR_MOST},
    {"momentum_error", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, momentum_error), .maximum = ERROR_MOST},
    {"energy_ratio", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, energy_ratio), .maximum = ERROR_MOST},
    {"us_step", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, us_step), .maximum = TIME_MOST},
    {"us_step_engine", CSV_OPTIONAL, .offset = offsetof(ClosedLoopRow, us_step_engine), .minimum = 1e-6,
     .maximum = TIME_MOST},
};

static const CsvColumn law_columns[] = {
    {"laws", CSV_WORD, .offset = offsetof(LawRow, laws), .words = paper_law_words},
    {"weight", CSV_OPTIONAL, .offset = offsetof(LawRow, weight), .maximum = 1e12},
    {"seed", CSV_OPTIONAL, .offset = offsetof(LawRow, seed), .maximum = SEED_MOST, .digits = INTEGER_DIGITS},
    {"test", CSV_OPTIONAL, .offset = offsetof(LawRow, test), .maximum = ERROR_MOST},
    {"constant", CSV_OPTIONAL, .offset = offsetof(LawRow, constant), .minimum = 1e-30, .maximum = ERROR_MOST},
    {"momentum", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_MOMENTUM]), .maximum = ERROR_MOST},
    {"energy", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_ENERGY]), .maximum = ERROR_MOST},
    {"approach", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_APPROACH]), .maximum = ERROR_MOST},
    {"cone", CSV_OPTIONAL, .offset = offsetof(LawRow, violation[LAW_CONE]), .maximum = ERROR_MOST},
};

static const CsvColumn transfer_columns[] = {
    {"start", CSV_WORD, .offset = offsetof(TransferRow, transfer), .words = start_words},
    {"seed", CSV_NUMBER, .offset = offsetof(TransferRow, seed), .maximum = SEED_MOST, .digits = INTEGER_DIGITS},
    {"launches", CSV_NUMBER, .offset = offsetof(TransferRow, launches), .minimum = 1, .maximum = PAPER_MAX_LAUNCHES,
     .digits = INTEGER_DIGITS},
    {"error", CSV_OPTIONAL, .offset = offsetof(TransferRow, error), .maximum = 1e6},
    {"constant", CSV_OPTIONAL, .offset = offsetof(TransferRow, constant), .maximum = 1e6},
};

static const CsvColumn fact_columns[] = {
    {"key", CSV_TEXT, .offset = offsetof(FactRow, key), .maximum = VALUE_SIZE},
    {"value", CSV_TEXT, .offset = offsetof(FactRow, value), .maximum = VALUE_SIZE},
};

#define LAYOUT(name, columns, Row, most) CSV_LAYOUT(name, columns, Row, .min_rows = 1, .max_rows = most)

const CsvLayout paper_score_layout = LAYOUT("table1", score_columns, ScoreRow, PAPER_MAX_ROWS);
const CsvLayout paper_trained_layout = LAYOUT("networks", trained_columns, TrainedRow, PAPER_MAX_NETWORKS);
const CsvLayout paper_rate_layout = LAYOUT("rates", rate_columns, RateRow, PAPER_MAX_ROWS);
const CsvLayout paper_closed_loop_layout = LAYOUT("closed_loop", closed_loop_columns, ClosedLoopRow, PAPER_MAX_LOOPS);
const CsvLayout paper_law_layout = LAYOUT("laws", law_columns, LawRow, PAPER_MAX_ROWS);
const CsvLayout paper_transfer_layout = LAYOUT("transfer", transfer_columns, TransferRow, PAPER_MAX_ROWS);
const CsvLayout paper_fact_layout = LAYOUT("study", fact_columns, FactRow, PAPER_MAX_ROWS);
