/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/first_round.h"

#include "interior_training/recording.h"
#include "solvers/solvers.h"

#include <inttypes.h>
#include <stdlib.h>

/* HELD_OUT_PART: a fifth as many scenes. */
enum { HELD_OUT_SEED = 7919, HELD_OUT_PART = 5 };

/* Scenes of a piece, and about the time of one. */
enum { PIECE_SCENES = 10 };
static const double scene_seconds = 0.3;

/* Every second scene is run by interior, the others by momentum. */
static bool make_solver(void *context, int number, ContactSolver *solver, Error *error) {
    (void)context;
    const ContactSolverKind *kind = number % 2 == 0 ? &solver_interior : &solver_momentum;
    Settings settings;
    if (!settings_parse(&settings, kind == &solver_momentum ? "k=30" : "", kind->description.settings,
                        kind->description.name, error))
        return false;
    void *state = kind->create(&settings, error);
    if (state != NULL) *solver = (ContactSolver){kind, state};
    return state != NULL;
}

/* Scenes first to end - 1, numbered through all sets. */
static bool run(const FirstRound *round, FirstSet set, int64_t first, int64_t end, ImpactProblems *problems,
                const Progress *progress, Error *error) {
    const uint64_t seed = round->training->seed + (set == FIRST_HELD_OUT ? HELD_OUT_SEED : 0);
    const int64_t begin = round->ranges.first_item[set];
    const Recording recording = {seed, (int)(first - begin), (int)(end - first), make_solver, NULL};
    return recording_run(&recording, problems, progress, error);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    static const char *const names[FIRST_SETS] = {"held-out scenes", "scenes"};
    const FirstRound *round = context;
    int64_t first, end;
    const int set = piece_ranges_find(&round->ranges, piece, &first, &end);
    const int64_t begin = round->ranges.first_item[set];
    snprintf(info->name, sizeof info->name, "%s %" PRId64 "-%" PRId64, names[set], first - begin + 1, end - begin);
    info->weight = scene_seconds * (double)(end - first);
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const FirstRound *round = context;
    int64_t first, end;
    const FirstSet set = (FirstSet)piece_ranges_find(&round->ranges, piece, &first, &end);
    ImpactProblems problems = {0};
    const bool ok = run(round, set, first, end, &problems, progress, error);
    if (ok) impact_problems_write(&problems, results);
    impact_problems_free(&problems);
    return ok;
}

static bool read_piece(const FirstRound *round, int64_t piece, ImpactProblems *problems, Error *error) {
    char path[PIECES_PATH_SIZE];
    size_t size;
    if (!pieces_path(round->training->recorded, piece, path, error)) return false;
    char *results = pieces_read(round->training->recorded, piece, &size, NULL, error);
    const bool ok = results != NULL && impact_problems_read(problems, results, size, path, error);
    free(results);
    return ok;
}

bool first_round_take(const FirstRound *round, FirstSet set, ImpactProblems *problems, const Progress *progress,
                      Error *error) {
    if (round->training->recorded == NULL)
        return run(round, set, round->ranges.first_item[set], round->ranges.first_item[set + 1], problems, progress,
                   error);
    const int64_t first = round->ranges.first_piece[set], end = round->ranges.first_piece[set + 1];
    for (int64_t piece = first; piece < end; piece++) {
        if (!read_piece(round, piece, problems, error)) return false;
        if (!progress_report(progress, (double)(piece - first + 1), (double)(end - first)))
            return error_interrupted(error, "interior-net", "stopped");
    }
    return true;
}

void first_round_make(FirstRound *round, const NetTraining *training) {
    const int counts[FIRST_SETS] = {training->scenes / HELD_OUT_PART + 1, training->scenes};
    *round = (FirstRound){.training = training};
    for (int set = 0; set < FIRST_SETS; set++)
        piece_ranges_add(&round->ranges, counts[set], (double)counts[set] / PIECE_SCENES);
    round->plan =
        (PiecePlan){.count = piece_ranges_count(&round->ranges), .describe = describe, .work = work, .context = round};
}
