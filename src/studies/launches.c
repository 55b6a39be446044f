/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a chart: the launch that is worst for a method, launches scored by all methods, the tables that pieces make,
   and the times of a scene. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/pieces.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_internal.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Phases with points: impact and after. */
static const char *const phase_words[] = {"impact", "after", NULL};

#define TEXT(member, size) CSV_MEMBER(LaunchPage, member, CSV_TEXT, .maximum = (size)-1)
#define COUNT(member, least) CSV_MEMBER(LaunchPage, member, CSV_INTEGER, .minimum = least, .maximum = INT_MAX)
#define NUMBER(member, kind) \
    CSV_MEMBER(LaunchPage, member, kind, .minimum = -INFINITY, .maximum = INFINITY, .digits = 9)
#define ERROR(member) CSV_MEMBER(LaunchPage, member, CSV_NUMBER, .maximum = INFINITY)

static const CsvColumn columns[] = {
    TEXT(scene, CHART_NAME_SIZE),
    TEXT(method, CHART_NAME_SIZE),
    TEXT(setting, CHART_SETTING_SIZE),
    CSV_MEMBER(LaunchPage, phase, CSV_WORD, .words = phase_words),
    COUNT(launch, 1),
    NUMBER(x, CSV_FLOAT),
    NUMBER(rotation, CSV_FLOAT),
    NUMBER(spin, CSV_FLOAT),
    NUMBER(mass, CSV_FLOAT),
    COUNT(launch_frame, 0),
    ERROR(error_worst),
    ERROR(error),
    NUMBER(time, CSV_NUMBER),
    COUNT(frame, 0),
    COUNT(body, -1),
    TEXT(page, CSV_PATH_SIZE),
    COUNT(bytes, 0),
};

const CsvLayout launch_page_layout =
    CSV_LAYOUT("chart_pages", columns, LaunchPage, .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);

typedef struct Search {
    const SceneStudy *study;
    const Method *method;
    WorstLaunch (*of)[PHASES]; /* [launches] */
} Search;

static WorstLaunch worst_launch_measure(const StepScores *scores, const RunLog *log, int launch) {
    WorstLaunch worst = {.launch = -1, .frame = -1, .body = -1, .touch = log->touch, .frames = log->frames};
    for (int i = 0; i < scores->count; i++) {
        if (worst.launch >= 0 && scores->error[i] <= worst.error) continue;
        worst.launch = launch;
        worst.error = scores->error[i];
        worst.frame = scores->place[i].frame;
        worst.body = scores->place[i].body;
    }
    if (scores->count > 0) worst.mean = statistics_mean(scores->error, scores->count);
    return worst;
}

static bool search_launch(void *context, int i, Error *error) {
    const Search *search = context;
    const Sampling sampling = {.after = search->study->size.closed.after, .rest = INT_MAX};
    const Scene scene = scene_study_launch(search->study, i), *launched = &scene;
    Rollout rollout = {0};
    StepScores scores[PHASES] = {0};
    Stepper *stepper = stepper_create(search->method, launched, error);
    const bool ok = stepper != NULL && rollout_run(&rollout, stepper, launched, &sampling, scores, error);
    for (int phase = 0; phase < PHASES; phase++) {
        if (ok) search->of[i][phase] = worst_launch_measure(&scores[phase], &rollout.log, i);
        step_scores_free(&scores[phase]);
    }
    stepper_destroy(stepper);
    rollout_free(&rollout);
    return ok;
}

bool worst_launch_find(const SceneStudy *study, const Method *method, WorstLaunch worst[PHASES],
                       const Progress *progress, Error *error) {
    Search search = {study, method, calloc((size_t)study->launch_count, sizeof *search.of)};
    if (search.of == NULL) return error_memory(error, "worst launch");
    const ParallelWork work = {search_launch, &search};
    const bool ok = parallel_for(&work, study->launch_count, study->scene->name, progress, error);
    for (int phase = 0; ok && phase < PHASES; phase++) {
        worst[phase] = (WorstLaunch){.launch = -1};
        for (int i = 0; i < study->launch_count; i++) {
            const WorstLaunch *found = &search.of[i][phase];
            if (found->launch >= 0 && (worst[phase].launch < 0 || found->mean > worst[phase].mean))
                worst[phase] = *found;
        }
    }
    free(search.of);
    return ok;
}

/* About the share of a piece that its converged run takes. */
static const double converged_share = 0.2;

typedef struct LaunchPiece {
    SceneStudy *study;
    Scene launched;
    RunLog converged;
    SnapshotList snapshots;
    int first;            /* contender that is tried first */
    bool *chosen;         /* [contenders] */
    LaunchScores *scores; /* [contenders] */
} LaunchPiece;

static bool launch_piece_begin(LaunchPiece *piece, SceneStudy *study, int launch, Error *error) {
    const size_t count = (size_t)study->contender_count + 1;
    const double golden = 0.6180339887498949; /* neighbouring launches, which run at once, begin far apart */
    *piece = (LaunchPiece){.study = study,
                           .launched = scene_study_launch(study, launch),
                           .snapshots = {.no_push_out = study->no_push_out},
                           .first = (int)(fmod(launch * golden, 1) * study->contender_count),
                           .chosen = calloc(count, sizeof *piece->chosen),
                           .scores = calloc(count, sizeof *piece->scores)};
    return (piece->chosen != NULL && piece->scores != NULL) || error_memory(error, "study");
}

static void launch_piece_end(LaunchPiece *piece) {
    for (int i = 0; piece->scores != NULL && i < piece->study->contender_count; i++)
        launch_scores_free(&piece->scores[i]);
    run_log_free(&piece->converged);
    snapshots_free(&piece->snapshots);
    free(piece->chosen);
    free(piece->scores);
}

static bool prepare(LaunchPiece *piece, Error *error) {
    Method method;
    Rollout rollout = {0};
    Stepper *stepper =
        method_parse(&method, "reference", error) ? stepper_create(&method, &piece->launched, error) : NULL;
    const bool ok = stepper != NULL && rollout_run(&rollout, stepper, &piece->launched, NULL, NULL, error) &&
                    snapshots_add(&piece->snapshots, &piece->launched, &piece->study->size.frozen, error);
    piece->converged = rollout.log;
    rollout.log = (RunLog){0};
    rollout_free(&rollout);
    stepper_destroy(stepper);
    return ok;
}

static bool score_with(LaunchPiece *piece, Stepper *stepper, LaunchScores *scores, Error *error) {
    Rollout rollout = {0};
    bool ok = rollout_run(&rollout, stepper, &piece->launched, &piece->study->size.closed,
                          scores->steps[PROTOCOL_CLOSED], error);
    if (ok) scores->measures = run_measures(&rollout.log, &piece->converged, &piece->launched);
    const bool frozen = !stepper_describe(stepper)->whole_scenes;
    ok = ok &&
         (!frozen || snapshots_score(&piece->snapshots, stepper, rollout.world, scores->steps[PROTOCOL_FROZEN], error));
    scores->unconverged = rollout.unconverged;
    rollout_free(&rollout);
    return ok;
}

/* Scores a contender, whichever is free. */
static bool score(void *context, int i, Error *error) {
    (void)i;
    LaunchPiece *piece = context;
    SceneStudy *study = piece->study;
    const int contender = stepper_pool_take(&study->steppers, piece->chosen, piece->first);
    Stepper *stepper =
        stepper_pool_stepper(&study->steppers, contender, &study->contenders[contender]->method, study->scene, error);
    const bool ok = stepper != NULL && score_with(piece, stepper, &piece->scores[contender], error);
    stepper_pool_give(&study->steppers, contender);
    return ok;
}

bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error) {
    LaunchPiece piece;
    ProgressStage stage = {progress, converged_share, 1 - converged_share, false};
    const ParallelWork work = {score, &piece};
    const bool ok =
        launch_piece_begin(&piece, study, launch, error) && prepare(&piece, error) &&
        parallel_for(&work, study->contender_count, study->scene->name, &(Progress){progress_stage, &stage}, error);
    if (ok)
        launch_scores_write(results, piece.scores, study->contender_count, piece.snapshots.unconverged,
                            piece.converged.unconverged);
    launch_piece_end(&piece);
    return ok;
}

bool piece_tables_print(FILE *results, const CsvLayout *layout, int section, const void *row, Error *error) {
    if (section < 0)
        fprintf(results, "%s:", layout->name);
    else
        fprintf(results, "%s/%d:", layout->name, section);
    return csv_row_print(results, layout, row, error);
}

/* The results of all pieces, while tables are made of them. */
typedef struct Tables {
    const CsvLayout *const *layouts; /* [layout_count] */
    const PieceGroup *groups;        /* [group_count] */
    int layout_count, group_count;
    char **texts; /* [pieces] */
} Tables;

/* Whether a line is a row of one of the tables, or a note. Other lines are a fault of the study's. */
static bool check_line(const Tables *tables, const char *line, int sections, Error *error) {
    const size_t length = strcspn(line, ":/\n");
    if (*line == '#') return true;
    for (int i = 0; i < tables->layout_count; i++) {
        const char *name = tables->layouts[i]->name;
        if (strncmp(line, name, length) != 0 || name[length] != '\0') continue;
        char *end = (char *)line + length;
        const long section = *end == '/' ? strtol(end + 1, &end, 10) : -1;
        if (*end == ':' && section >= -1 && section < sections) return true;
    }
    return error_system(error, "tables", "a piece has the line '%.*s', which belongs to no table",
                        (int)strcspn(line, "\n"), line);
}

static bool read_piece(const Tables *tables, const Pieces *pieces, int64_t piece, int sections, Error *error) {
    size_t size;
    char *text = tables->texts[piece] = pieces_read(pieces, piece, &size, NULL, error);
    if (text == NULL) return false;
    if (size != strlen(text) || (size > 0 && text[size - 1] != '\n'))
        return error_system(error, "tables", "a piece is not made of lines");
    for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1)
        if (!check_line(tables, line, sections, error)) return false;
    return true;
}

static bool read_pieces(const Tables *tables, const Pieces *pieces, Error *error) {
    for (int g = 0; g < tables->group_count; g++) {
        const PieceGroup *group = &tables->groups[g];
        for (int64_t i = group->first; i < group->first + group->count; i++)
            if (!read_piece(tables, pieces, i, group->sections, error)) return false;
    }
    return true;
}

/* The rows of a group in a section; -1: those without one. */
static void print_section(FILE *out, const Tables *tables, const CsvLayout *layout, const PieceGroup *group,
                          int section) {
    char tag[CSV_NAME_SIZE + 16] = "";
    text_add(tag, sizeof tag, "%s", layout->name);
    if (section >= 0) text_add(tag, sizeof tag, "/%d", section);
    text_add(tag, sizeof tag, ":");
    const size_t length = strlen(tag);
    for (int64_t i = group->first; i < group->first + group->count; i++)
        for (const char *line = tables->texts[i]; *line != '\0'; line += strcspn(line, "\n") + 1)
            if (strncmp(line, tag, length) == 0) fwrite(line + length, 1, strcspn(line, "\n") + 1 - length, out);
}

typedef struct Table {
    const Tables *tables;
    const CsvLayout *layout;
} Table;

static void print_table(FILE *out, const void *context) {
    const Table *table = context;
    csv_header_print(out, table->layout);
    for (int g = 0; g < table->tables->group_count; g++)
        for (int section = -1; section < table->tables->groups[g].sections; section++)
            print_section(out, table->tables, table->layout, &table->tables->groups[g], section);
}

bool piece_tables_write(const Pieces *pieces, const char *folder, const CsvLayout *const *layouts, int layout_count,
                        const PieceGroup *groups, int group_count, Error *error) {
    const int64_t count = pieces->plan->count;
    const PieceGroup all = {0, count, 0};
    const Tables tables = {layouts, groups != NULL ? groups : &all, layout_count, groups != NULL ? group_count : 1,
                           calloc((size_t)count + 1, sizeof *tables.texts)};
    bool done = (tables.texts != NULL || error_memory(error, folder)) && read_pieces(&tables, pieces, error);
    for (int i = 0; done && i < layout_count; i++) {
        char path[CSV_PATH_SIZE];
        done = csv_table_path(path, folder, layouts[i], error) &&
               file_write_text(path, print_table, &(Table){&tables, layouts[i]}, error);
    }
    for (int64_t i = 0; tables.texts != NULL && i < count; i++) free(tables.texts[i]);
    free(tables.texts);
    return done;
}

/* About the share of the time that preparations take. */
static const double prepared_share = 0.1;

/* Frames of a run behind the phase "after", so that all three phases are timed. */
enum { FRAMES_BEHIND = 20 };

typedef struct Timed {
    SnapshotList snapshots;
    int touch; /* of the converged run */
} Timed;

typedef struct SceneTimes {
    const SceneStudy *study;
    int count;
    Timed *timed;    /* [count] */
    Scene *launches; /* [count] */
    SnapshotList snapshots;
    StepCost (*costs[PROTOCOLS])[PHASES]; /* [contenders] */
} SceneTimes;

static bool prepare_launch(void *context, int i, Error *error) {
    SceneTimes *times = context;
    Timed *timed = &times->timed[i];
    const SceneStudy *study = times->study;
    Scene *launched = &times->launches[i];
    const int spread = (2 * i + 1) * study->striking_count / (2 * times->count);
    *launched = scene_study_launch(study, study->striking[spread]);
    return launch_find_touch(launched, "reference", &timed->touch, error) &&
           snapshots_add(&timed->snapshots, launched, &study->size.frozen, error);
}

/* Moves the frozen steps of all launches into one list. */
static bool gather_snapshots(SceneTimes *times, Error *error) {
    SnapshotList *all = &times->snapshots;
    for (int i = 0; i < times->count; i++) {
        SnapshotList *list = &times->timed[i].snapshots;
        if (!array_reserve((void **)&all->items, &all->capacity, (size_t)(all->count + list->count) + 1,
                           sizeof *all->items))
            return error_memory(error, "study");
        if (list->count > 0) memcpy(all->items + all->count, list->items, (size_t)list->count * sizeof *all->items);
        all->count += list->count;
        list->count = 0;
    }
    return true;
}

static int last_frame(const SceneTimes *times) {
    const Scene *scene = times->study->scene;
    int last = 0;
    for (int i = 0; i < times->count; i++) {
        const int frame = times->timed[i].touch + scene->bomb.impact_frames + AFTER_FRAMES + FRAMES_BEHIND;
        if (frame > last) last = frame;
    }
    return last < scene->frames ? last : scene->frames;
}

static bool scene_times_begin(SceneTimes *times, const SceneStudy *study, Error *error) {
    const size_t contenders = (size_t)study->contender_count + 1;
    *times = (SceneTimes){.study = study, .count = scene_study_timed(study)};
    times->timed = calloc((size_t)times->count, sizeof *times->timed);
    times->launches = calloc((size_t)times->count, sizeof *times->launches);
    bool ok = times->timed != NULL && times->launches != NULL;
    for (int p = 0; p < PROTOCOLS; p++) {
        times->costs[p] = calloc(contenders, sizeof *times->costs[p]);
        ok = ok && times->costs[p] != NULL;
    }
    return ok || error_memory(error, "study");
}

static void scene_times_end(SceneTimes *times) {
    for (int i = 0; times->timed != NULL && i < times->count; i++) snapshots_free(&times->timed[i].snapshots);
    snapshots_free(&times->snapshots);
    for (int p = 0; p < PROTOCOLS; p++) free(times->costs[p]);
    free(times->timed);
    free(times->launches);
}

static bool scene_times_measure(SceneTimes *times, const Progress *progress, Error *error) {
    const SceneStudy *study = times->study;
    ProgressStage before = {progress, 0, prepared_share, false},
                  then = {progress, prepared_share, 1 - prepared_share, false};
    const ParallelWork work = {prepare_launch, times};
    if (!parallel_for(&work, times->count, study->scene->name, &(Progress){progress_stage, &before}, error) ||
        !gather_snapshots(times, error))
        return false;
    const TimingOptions options = {.launches = times->launches,
                                   .launch_count = times->count,
                                   .repetitions = study->size.repetitions,
                                   .last_frame = last_frame(times)};
    return timing_measure(study->contenders, study->contender_count, &options, &times->snapshots,
                          times->costs[PROTOCOL_CLOSED], times->costs[PROTOCOL_FROZEN],
                          &(Progress){progress_stage, &then}, error);
}

bool scene_times_write(const SceneStudy *study, FILE *results, const Progress *progress, Error *error) {
    SceneTimes times;
    const bool ok = scene_times_begin(&times, study, error) && scene_times_measure(&times, progress, error);
    for (int i = 0; ok && i < study->contender_count; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++) {
                const StepCost *cost = &times.costs[p][i][phase];
                const double stored[] = {cost->solver,       cost->solver_q1, cost->solver_q3, cost->step,
                                         cost->instructions, cost->engine,    cost->varies};
                fwrite(stored, sizeof stored, 1, results);
            }
    scene_times_end(&times);
    return ok;
}

static bool is_time(double value) { return !(value < 0); }

/* What chart.csv can have. */
static bool is_cost(const StepCost *cost) {
    return is_time(cost->solver_q1) && !(cost->solver_q1 > cost->solver) && !(cost->solver > cost->solver_q3) &&
           is_time(cost->step) && is_time(cost->instructions) && is_time(cost->engine);
}

MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error) {
    double stored[7];
    const size_t count = (size_t)study->contender_count;
    MethodTimes *times = calloc(count + 1, sizeof *times);
    if (times == NULL) return error_memory(error, path), NULL;
    bool whole = size == count * PROTOCOLS * PHASES * sizeof stored;
    for (size_t i = 0; whole && i < count * PROTOCOLS * PHASES; i++) {
        memcpy(stored, bytes + i * sizeof stored, sizeof stored);
        StepCost *cost = &times[i / (PROTOCOLS * PHASES)].costs[i / PHASES % PROTOCOLS][i % PHASES];
        *cost = (StepCost){stored[0],
                           stored[1],
                           stored[2],
                           stored[3],
                           .instructions = stored[4],
                           .engine = stored[5],
                           .varies = stored[6] == 1};
        whole = is_cost(cost) && (stored[6] == 0 || stored[6] == 1);
    }
    if (whole) return times;
    error_input(error, path, "is no result of times; delete it, and its shard does it again");
    free(times);
    return NULL;
}
