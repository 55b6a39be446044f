/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed-accuracy study: its scenes, their pieces, and chart.csv from what the pieces stored. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "pictures/page.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/launch_scores.h"
#include "studies/piece_tables.h"
#include "studies/scene_study.h"
#include "studies/study_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The speed-accuracy study in pieces (runs/pieces.h): the launches of a scene, then the times of its methods; scene
   after scene. */

/* A scene and its pieces: a launch each, the last one is of the times. */
typedef struct ChartScene {
    SceneStudy study;
    int64_t first;
    double launch_weight, times_weight; /* of pieces */
    int working;                        /* launches that are being scored */
} ChartScene;

typedef struct ChartPlan {
    ChartScene *scenes; /* [count] */
    int count;
    PiecePlan plan;
} ChartPlan;

/* Seconds of one core per step of one body by a method: with the solution that it is scored against, and for each
   repetition of its time, during which another core waits. More bodies take more iterations, and so longer by their
   number to the power of 1.5. */
static const double scored_seconds = 7e-7, timed_seconds = 2.8e-7;

static ChartScene *scene_of(const ChartPlan *plan, int64_t piece) {
    int i = 0;
    while (i + 1 < plan->count && plan->scenes[i + 1].first <= piece) i++;
    return &plan->scenes[i];
}

/* The last piece of a scene. */
static bool is_times(const ChartScene *scene, int64_t piece) {
    return piece == scene->first + scene->study.launch_count;
}

static void describe_chart(void *context, int64_t piece, PieceInfo *info) {
    const ChartScene *scene = scene_of(context, piece);
    const char *name = scene->study.scene->name;
    if (is_times(scene, piece)) {
        snprintf(info->name, sizeof info->name, "times of %.100s", name);
        info->weight = scene->times_weight;
        info->alone = info->timed = true;
        return;
    }
    snprintf(info->name, sizeof info->name, "launch %d of %.100s", (int)(piece - scene->first) + 1, name);
    info->weight = scene->launch_weight;
}

/* Destroys the steppers of scenes that no piece works on. */
static void rest_others(const ChartPlan *plan) {
    for (int i = 0; i < plan->count; i++)
        if (plan->scenes[i].working == 0) scene_study_rest(&plan->scenes[i].study);
}

static bool chart_work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    ChartScene *scene = scene_of(context, piece);
    /* Pieces come scene by scene: the steppers of a scene go when work on another begins. */
#pragma omp critical(chart_plan)
    {
        scene->working++;
        rest_others(context);
    }
    const bool ok = is_times(scene, piece)
                        ? scene_times_write(&scene->study, results, progress, error)
                        : launch_piece_write(&scene->study, (int)(piece - scene->first), results, progress, error);
#pragma omp critical(chart_plan)
    scene->working--;
    return ok;
}

/* Reads the scenes. ERROR_INPUT also if two have the same name. The contenders must outlive the plan. */
static bool chart_plan_make(ChartPlan *plan, const char *const *paths, int count, const ContenderList *contenders,
                            const LaunchChoice *launches, const StudySize *size, Error *error) {
    *plan = (ChartPlan){.scenes = calloc((size_t)count + 1, sizeof *plan->scenes),
                        .plan = {.describe = describe_chart, .work = chart_work, .context = plan}};
    if (plan->scenes == NULL) return error_memory(error, "study");
    for (int i = 0; i < count; i++) {
        ChartScene *scene = &plan->scenes[i];
        if (!scene_study_begin(&scene->study, paths[i], contenders, launches, size, error)) return false;
        plan->count++;
        const SceneStudy *study = &scene->study;
        for (int k = 0; k < i; k++)
            if (strcmp(plan->scenes[k].study.scene->name, study->scene->name) == 0)
                return error_input(error, paths[i], "another scene has the same name (%s)", study->scene->name);
        const double steps = study->scene->frames * pow(study->scene->body_count + 1, 1.5) * study->contender_count;
        scene->launch_weight = scored_seconds * steps;
        scene->times_weight = timed_seconds * steps * scene_study_timed(study) * study->size.repetitions;
        scene->first = plan->plan.count;
        plan->plan.count += study->launch_count + 1;
    }
    return true;
}

/* chart.csv from the pieces. */

enum { ROWS_EACH = PROTOCOLS * PHASES };

/* Methods are put together in groups that take about this much, so that a launch is read a few times only. */
enum { GROUP_BYTES = 64 << 20 };

typedef struct Assembly {
    const Pieces *pieces;
    const ChartScene *scene;
    SceneSolves *solves;
    MethodScores *scores;       /* [contenders] */
    FloorSum (*floors)[PHASES]; /* [PROTOCOLS] of all launches */
} Assembly;

static void fill_rows(const Assembly *assembly, int contender, ChartRow *rows) {
    const SceneStudy *study = &assembly->scene->study;
    MethodScores *scores = &assembly->scores[contender];
    int64_t steps[PROTOCOLS] = {0};
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            ChartRow *row = &rows[protocol * PHASES + phase];
            *row = scene_row(study->scene->name, study->launch_count, study->contenders[contender], protocol, phase);
            scene_row_errors(row, &scores->steps[protocol][phase]);
            const FloorSum *floors = &assembly->floors[protocol][phase];
            if (floors->steps > 0) row->floor = floors->sum / (double)floors->steps;
            steps[protocol] += scores->steps[protocol][phase].count;
            if (protocol != PROTOCOL_CLOSED) continue;
            row->error_worst = scores->worst[phase];
            row->worst_launch = scores->worst_launch[phase];
            scene_row_measures(row, scores->measures, study->launch_count);
        }
    /* The same of all, but of programs that fail or run whole scenes. */
    const int64_t frozen = steps[PROTOCOL_FROZEN] + assembly->solves->frozen_unconverged;
    if (frozen > assembly->solves->frozen) assembly->solves->frozen = frozen;
    assembly->solves->closed += steps[PROTOCOL_CLOSED] + scores->unconverged;
    assembly->solves->closed_unconverged += scores->unconverged;
    method_scores_free(scores);
}

static bool add_scores(const Assembly *assembly, ChartRow *rows, Error *error) {
    const SceneStudy *study = &assembly->scene->study;
    int group = study->contender_count;
    for (int first = 0; first < study->contender_count; first += group) {
        for (int launch = 0; launch < study->launch_count; launch++) {
            const int64_t piece = assembly->scene->first + launch;
            char path[PIECES_PATH_SIZE];
            size_t size;
            StoredScores stored;
            if (!pieces_path(assembly->pieces, piece, path, error)) return false;
            char *text = pieces_read(assembly->pieces, piece, &size, NULL, error);
            bool ok = text != NULL && stored_scores_open(&stored, path, text, size, study->contender_count, error);
            if (ok && first == 0 && launch == 0) {
                /* As many methods as fit into GROUP_BYTES, by the size of a launch. */
                const double all = (double)stored.size * study->launch_count;
                if (all > GROUP_BYTES) group = (int)fmax(1, study->contender_count * GROUP_BYTES / all);
            }
            if (ok && first == 0) {
                assembly->solves->frozen_unconverged += stored.steps.unconverged;
                assembly->solves->runs_unconverged += stored.steps.run_unconverged;
                for (int i = 0; i < ROWS_EACH; i++) {
                    const FloorSum *floor = &stored.steps.floors[i / PHASES][i % PHASES];
                    assembly->floors[i / PHASES][i % PHASES].sum += floor->sum;
                    assembly->floors[i / PHASES][i % PHASES].steps += floor->steps;
                }
            }
            for (int i = first; ok && i < first + group && i < study->contender_count; i++)
                ok = method_scores_add(&assembly->scores[i], &stored, i, error);
            free(text);
            if (!ok) return false;
        }
        for (int i = first; i < first + group && i < study->contender_count; i++)
            fill_rows(assembly, i, rows + (size_t)i * ROWS_EACH);
    }
    return true;
}

static bool add_times(const Assembly *assembly, ChartRow *rows, char cpu[CPU_NAME_SIZE], Error *error) {
    const SceneStudy *study = &assembly->scene->study;
    const int64_t piece = assembly->scene->first + study->launch_count;
    char path[PIECES_PATH_SIZE];
    size_t size;
    if (!pieces_path(assembly->pieces, piece, path, error)) return false;
    char *text = pieces_read(assembly->pieces, piece, &size, cpu, error);
    MethodTimes *times = text != NULL ? scene_times_read(study, path, text, size, error) : NULL;
    for (int i = 0; times != NULL && i < study->contender_count; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++)
                scene_row_cost(&rows[i * ROWS_EACH + p * PHASES + phase], &times[i].costs[p][phase], cpu);
    const bool ok = times != NULL;
    free(times);
    free(text);
    return ok;
}

/* On two cores, the full study of three scenes takes some minutes, the quick one less than one. */
static const StudySize full_size = {.launches = 40,
                                    .closed = {.after = 6, .rest = 30},
                                    .frozen = {.after = 6, .rest = 60},
                                    .timed_launches = 20,
                                    .repetitions = 2};
static const StudySize quick_size = {.launches = 5,
                                     .closed = {.after = 20, .rest = 120},
                                     .frozen = {.after = 20, .rest = 120},
                                     .timed_launches = 1,
                                     .repetitions = 2};

typedef struct Run {
    const SpeedAccuracyOptions *options;
    ContenderList contenders;
    ChartPlan plan;
    SpeedAccuracyScene *scenes; /* [scenes of the plan] */
    ChartRow *rows;             /* of all scenes */
    int row_count;
    char (*cpus)[CPU_NAME_SIZE]; /* [scenes of the plan] */
    StudyPage *pages;            /* the same */
} Run;

/* Hashes everything that determines the result: the program, the options and the files. */
static bool find_key(const SpeedAccuracyOptions *options, const ContenderList *contenders, StudyKey *key,
                     Error *error) {
    if (!study_key_begin(key, error) || !contenders_add_to_key(contenders, key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    const LaunchChoice *launches = &options->launches;
    study_key_add(key, &launches->count, sizeof launches->count);
    study_key_add(key, &launches->bomb_x.count, sizeof launches->bomb_x.count);
    study_key_add(key, &launches->bomb_x.first, sizeof launches->bomb_x.first);
    study_key_add(key, &launches->bomb_x.step, sizeof launches->bomb_x.step);
    if (launches->table != NULL && !study_key_add_file(key, launches->table, error)) return false;
    for (int i = 0; i < options->scene_count; i++)
        if (!study_key_add_scene(key, options->scenes[i], error)) return false;
    return true;
}

static SpeedAccuracyScene summarise(const Run *run, const SceneStudy *study) {
    SpeedAccuracyScene summary = {.contenders = study->contender_count,
                                  .launches = study->launch_count,
                                  .striking = study->striking_count,
                                  .without_network = contenders_without_network(&run->contenders, study->scene)};
    snprintf(summary.name, sizeof summary.name, "%s", study->scene->name);
    return summary;
}

static bool assemble_chart(Run *run, const Pieces *pieces, Error *error) {
    size_t count = 0;
    for (int i = 0; i < run->plan.count; i++) count += (size_t)run->plan.scenes[i].study.contender_count * ROWS_EACH;
    run->rows = malloc((count + 1) * sizeof *run->rows);
    run->cpus = calloc((size_t)run->plan.count + 1, sizeof *run->cpus);
    if (run->rows == NULL || run->cpus == NULL) return error_memory(error, "study");
    for (int i = 0; i < run->plan.count; i++) {
        const ChartScene *scene = &run->plan.scenes[i];
        SpeedAccuracyScene *summary = &run->scenes[i];
        *summary = summarise(run, &scene->study);
        /* Memory: of some methods on all launches, and of one piece. */
        const size_t contenders = (size_t)scene->study.contender_count;
        FloorSum floors[PROTOCOLS][PHASES] = {0};
        const Assembly assembly = {pieces, scene, &summary->solves, calloc(contenders + 1, sizeof(MethodScores)),
                                   floors};
        ChartRow *rows = run->rows + run->row_count;
        const bool ok = (assembly.scores != NULL || error_memory(error, "study")) &&
                        add_scores(&assembly, rows, error) && add_times(&assembly, rows, run->cpus[i], error);
        for (size_t k = 0; assembly.scores != NULL && k < contenders; k++) method_scores_free(&assembly.scores[k]);
        free(assembly.scores);
        if (!ok) return false;
        run->row_count += summary->contenders * ROWS_EACH;
    }
    return true;
}

static void put_method(FILE *out, const SceneStudy *study, const StudyPage *page, const ChartRow *rows) {
    html_print(out, "<tr><td>%s</td><td>%s</td>", rows->method, rows->setting);
    for (int phase = PHASE_IMPACT; phase <= PHASE_AFTER; phase++) {
        const ChartRow *row = &rows[PROTOCOL_CLOSED * PHASES + phase];
        char set[64] = "", error[32];
        if (isnan(row->us_solver))
            fputs("<td></td><td>", out);
        else
            fprintf(out, "<td>%.3g</td><td>", row->us_solver);
        snprintf(error, sizeof error, "%.3g", row->error_mean);
        if (!isnan(row->error_worst)) {
            /* What the page sets to play the launch; nothing where that has another rotation, spin or frame than the
               scene's. */
            const Launch own = launch_of(study->scene), *other = &study->launches[row->worst_launch];
            if (other->rotation == own.rotation && other->spin == own.spin && other->frame == own.frame) {
                text_add(set, sizeof set, "bomb_x=%.9g", (double)other->x);
                if (other->mass != own.mass) text_add(set, sizeof set, ",bomb_mass=%.9g", (double)other->mass);
            }
            study_link_put(out, page, set, row->method, row->setting, error);
        }
        fputs("</td>", out);
    }
    fputs("</tr>\n", out);
}

/* chart.html: the points of the charts as tables. */
static void print_html(FILE *out, const void *context) {
    const Run *run = context;
    const ChartRow *rows = run->rows;
    house_page_begin(out, "Speed and accuracy", "figure { margin: 0; background: #fff; } img { width: 100%; }\n");
    fputs(
        "<h1>Speed and accuracy</h1>\n<p class=\"soft\">An error opens the scene with the launch that was worst for "
        "the method, stepped in the browser with the same bits, beside interior. A launch with another rotation, spin "
        "or frame than the scene's is not set there: then the launch is the scene's.</p>\n",
        out);
    for (int i = 0; i < run->plan.count; i++) {
        const SceneStudy *study = &run->plan.scenes[i].study;
        html_print(out, "<h2>%s</h2>\n<figure><img alt=\"The table as a chart\" src=\"chart-", study->scene->name);
        html_put_address(out, study->scene->name);
        fputs(".svg\"></figure>\n<div class=\"scroll\"><table>\n<tr><th>method</th><th>setting</th>"
              "<th>time at the impact, µs</th><th>error, m/s</th><th>time after it, µs</th><th>error, m/s</th></tr>\n",
              out);
        for (int k = 0; k < study->contender_count; k++, rows += ROWS_EACH)
            put_method(out, study, &run->pages[i], rows);
        fputs("</table></div>\n", out);
    }
    house_page_end(out);
}

/* What follows from the pieces, once all are there: the table, what is drawn of it, pages. */
static bool finish(Run *run, const Pieces *pieces, Error *error) {
    const SpeedAccuracyOptions *options = run->options;
    char path[CSV_PATH_SIZE], html[CSV_PATH_SIZE];
    if (!csv_table_path(path, options->folder, &chart_layout, error) ||
        !file_path(html, sizeof html, error, "%s/chart.html", options->folder) || !assemble_chart(run, pieces, error) ||
        !csv_table_write(path, &chart_layout, run->rows, run->row_count, error) ||
        !options->draw(options, run->scenes, error))
        return false;
    run->pages = calloc((size_t)run->plan.count + 1, sizeof *run->pages);
    if (run->pages == NULL) return error_memory(error, "study");
    for (int i = 0; i < run->plan.count; i++)
        if (!study_page_write(&run->pages[i], options->scenes[i], &run->contenders, options->folder, error))
            return false;
    return file_write_text(html, print_html, run, error) && pieces_end(pieces, error);
}

bool speed_accuracy_run(const SpeedAccuracyOptions *options, Pieces *pieces, const Progress *progress,
                        SpeedAccuracyScene *scenes, Error *error) {
    Run run = {.options = options, .scenes = scenes};
    StudyKey key = {0};
    if (!contenders_parse(&run.contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    bool ok = chart_plan_make(&run.plan, options->scenes, options->scene_count, &run.contenders, &options->launches,
                              options->quick ? &quick_size : &full_size, error);
    for (int i = 0; ok && options->begin != NULL && i < run.plan.count; i++) {
        const SpeedAccuracyScene summary = summarise(&run, &run.plan.scenes[i].study);
        options->begin(&summary);
    }
    ok = ok && find_key(options, &run.contenders, &key, error) &&
         pieces_open(pieces, options->folder, &key, &options->shard, error) &&
         pieces_do(pieces, &run.plan.plan, progress, error) &&
         (options->shard.count > 0 || finish(&run, pieces, error));
    pieces->plan = NULL;
    for (int i = 0; i < run.plan.count; i++) scene_study_end(&run.plan.scenes[i].study);
    free(run.plan.scenes);
    contenders_free(&run.contenders);
    free(run.rows);
    free(run.cpus);
    free(run.pages);
    return ok;
}
