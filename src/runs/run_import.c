/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a run of the rows of a CSV file, which run_csv.c reads. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/run_files.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"

#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Bodies of a run are numbered from 0 on, those of a trace as in the file. */
static int body_index(const CsvImport *import, int64_t number) {
    return import->options->as_trace ? (int)number : csv_head_body(&import->head, number);
}

static int64_t body_number(const CsvImport *import, int body) {
    return import->options->as_trace ? body : import->head.bodies[body].number;
}

static void set_numbers(Trajectory *run, size_t i, const double state[STATE_COLUMNS]) {
    if (run->no_poses) return;
    run->position[i] = vec2((float)state[0], (float)state[1]);
    run->angle[i] = (float)state[2];
    for (int column = 0; run->exact != NULL && column < (run->no_velocities ? 3 : STATE_COLUMNS); column++)
        run->exact[trajectory_exact_at(run, i, column)] = state[column];
    if (run->no_velocities) return;
    run->velocity[i] = vec2((float)state[3], (float)state[4]);
    run->angular_velocity[i] = (float)state[5];
}

/* A body may come and go once. */
static bool check_body(CsvImport *import, int body, Error *error) {
    const Trajectory *run = import->run;
    const int64_t number = body_number(import, body);
    int last = -1;
    for (int frame = 0; frame < run->frames; frame++) {
        if (!trajectory_has(run, frame, body)) continue;
        const int gap = last + 1, before = last;
        last = frame;
        if (before < 0 || gap == frame) continue;
        const int line = csv_rows_find(&import->rows, import->origin + frame, number);
        return csv_fail(import->path, line, 0, error,
                        "body %" PRId64 " is in frame %" PRId64 " and in frame %" PRId64 ", but not in frame %" PRId64,
                        number, import->first + before, import->first + frame, import->first + gap);
    }
    return true;
}

PRINTF_LIKE(2, 3) static void add_note(CsvRunNotes *notes, const char *format, ...) {
    if (notes->count == CSV_RUN_NOTES_MAX) return;
    PRINT_ARGUMENTS(notes->lines[notes->count++], CSV_RUN_NOTE_SIZE, format);
}

/* Completes the bodies once all rows are read: sizes, which are static, poses of static bodies in frames without their
   row. False with error set if a body is missing between two of its frames. */
static bool finish_bodies(CsvImport *import, Error *error) {
    Trajectory *run = import->run;
    const bool stated = import->head.states_static;
    run->fixed_guessed = !stated;
    for (size_t k = 0; k < import->head.count; k++) {
        const int body = body_index(import, import->head.bodies[k].number);
        run->size[body] = import->head.bodies[k].size;
        run->fixed[body] = import->head.bodies[k].fixed;
    }
    for (int body = 0; body < run->bodies; body++) {
        /* A body that is declared static, or has one row at the start of a run that declares none, stays. */
        if (import->options->as_trace && !(stated && run->fixed[body])) continue;
        if (stated ? !run->fixed[body]
                   : run->frames == 1 || import->row_counts[body] != 1 || !trajectory_has(run, 0, body)) {
            if (!check_body(import, body, error)) return false;
            continue;
        }
        for (int frame = 1; frame < run->frames; frame++) {
            const size_t i = trajectory_at(run, frame, body), before = trajectory_at(run, frame - 1, body);
            if (trajectory_there(run, frame, body)) continue;
            double state[STATE_COLUMNS];
            for (int column = 0; column < (run->no_poses ? 0 : run->no_velocities ? 3 : STATE_COLUMNS); column++)
                state[column] = trajectory_number(run, before, column);
            set_numbers(run, i, state);
            if (run->there != NULL) run->there[i] = run->there[before];
            if (run->hash != NULL) run->hash[i] = run->hash[before];
        }
        int begins = 0;
        while (begins < run->frames - 1 && !trajectory_has(run, begins, body)) begins++;
        for (int frame = begins + 1; stated && frame < run->frames; frame++) {
            const size_t i = trajectory_at(run, frame, body), first = trajectory_at(run, begins, body);
            const int64_t number = body_number(import, body);
            if (run->position[i].x != run->position[first].x || run->position[i].y != run->position[first].y ||
                run->angle[i] != run->angle[first])
                return csv_fail(import->path, csv_rows_find(&import->rows, import->origin + frame, number), 0, error,
                                "body %" PRId64 " is static, but moves", number);
        }
    }
    if (stated || import->options->as_trace) return true;
    trajectory_guess_fixed(run);
    char list[96] = "";
    int count = 0;
    for (int body = 0; body < run->bodies; body++)
        if (run->fixed[body] && count++ < 8)
            text_join(list, sizeof list, ", ", "%" PRId64, import->head.bodies[body].number);
    if (count == 0)
        add_note(import->notes, "no body is static: each of them moves");
    else
        add_note(import->notes, "%d static: %s%s never move%s", count, list, count > 8 ? ", ..." : "",
                 count == 1 ? "s" : "");
    return true;
}

/* Reads a run from CSV in two passes: the first finds how many frames there are, the second fills them. */

static const size_t MAX_SIZE = (size_t)1 << 30;
static const double TIME_TOLERANCE = 0.01;  /* of a step */
static const double WHOLE_TOLERANCE = 1e-4; /* relative: 1/dt this near a whole number is that number */

static bool count_rows(CsvImport *import, Error *error) {
    const CsvHead *head = &import->head;
    const bool as_trace = import->options->as_trace;
    CsvRow row;
    import->first = INT64_MAX;
    import->last = -1;
    import->count = 0;
    if (head->count > 0) memset(import->row_counts, 0, head->count * sizeof *import->row_counts);
    csv_rows_rewind(&import->rows, as_trace);
    while (csv_rows_next(&import->rows, &row, error)) {
        const int body = body_index(import, row.body);
        if (body < 0) return csv_fail(import->path, row.line, 0, error, "body %" PRId64 " has no size", row.body);
        if (as_trace && body >= import->bodies) import->bodies = body + 1;
        /* A run may end in NaN, from which no body comes back: it is read up to there. In a trace, NaN is a state. */
        int64_t *end = as_trace ? NULL : &import->ends[body];
        if (end != NULL && row.not_finite && row.frame < *end) *end = row.frame;
        if (end != NULL && *end < import->end) import->end = *end, import->ended = body;
        if (end != NULL && !row.not_finite && row.frame > *end)
            return csv_fail(import->path, row.line, 0, error,
                            "body %" PRId64 " is finite in frame %" PRId64 ", but not in frame %" PRId64, row.body,
                            row.frame, *end);
        if (row.frame >= import->end) continue;
        if (!as_trace) import->row_counts[body]++;
        import->count++;
        if (row.frame < import->first) import->first = row.frame, import->first_time = row.time;
        if (row.frame > import->last) import->last = row.frame, import->last_time = row.time;
    }
    return error->kind == ERROR_NONE;
}

/* The first pass; if the run ends in NaN once more, as rows of its last frame were counted before that was known. */
static bool survey(CsvImport *import, Error *error) {
    const CsvHead *head = &import->head;
    if (!count_rows(import, error) || (import->end < INT64_MAX && !count_rows(import, error))) return false;
    if (import->count == 0 && import->end < INT64_MAX)
        return error_input(error, import->path, "body %" PRId64 ": a number of its first frame is NaN or infinite",
                           head->bodies[import->ended].number);
    if (import->count == 0) return error_input(error, import->path, "has no rows");
    for (size_t i = 0; i < head->count && !import->options->as_trace; i++)
        if (import->row_counts[i] == 0 && import->end == INT64_MAX)
            return error_input(error, import->path, "body %" PRId64 " has a size but no row", head->bodies[i].number);
    return true;
}

/* What a run takes must be in proportion to its text, as in .npz files. */
static bool check_frames_and_size(CsvImport *import, Error *error) {
    const uint64_t frames = (uint64_t)(import->last - import->origin) + 1, bodies = (uint64_t)import->bodies;
    const uint64_t pose = 3 * (2 * sizeof(Vec2) + 2 * sizeof(float)), budget = npz_budget(import->size);
    CsvRow row;
    if (!import->options->as_trace &&
        import->last - import->first >= import->count) { /* a frame number far away: a huge run of few rows */
        csv_rows_rewind(&import->rows, false);
        while (csv_rows_next(&import->rows, &row, error) && row.frame != import->last) continue;
        return csv_fail(import->path, row.line, 0, error,
                        "frame %" PRId64 " cannot follow from frame %" PRId64 ": %" PRId64
                        " rows are too few for the frames between",
                        import->last, import->first, import->count);
    }
    /* Frames that have one body each, of many. */
    return frames * bodies <= budget / pose ||
           error_input(error, import->path,
                       "%" PRIu64 " frames of %" PRIu64 " bodies take %" PRIu64 " bytes; expected at most %" PRIu64
                       " (%d MiB and %d times the size of the file); leave out the bodies that are seldom there",
                       frames, bodies, frames * bodies * pose, budget, (int)(NPZ_ALWAYS >> 20), (int)NPZ_RATIO);
}

static bool has_times(const CsvImport *import) { return import->rows.field[COL_TIME] >= 0; }

static bool choose_step(CsvImport *import, float *dt, Error *error) {
    const float stated = import->head.dt, given = import->options->dt;
    const int64_t steps = import->last - import->first;
    const bool timed = has_times(import) && steps > 0;
    double step = timed ? (import->last_time - import->first_time) / (double)steps : 0;
    if (timed && !(step > 0)) return error_input(error, import->path, "the times do not rise");
    const double rate = rint(1 / step);
    const bool whole = fabs(rate * step - 1) < WHOLE_TOLERANCE;
    if (whole) step = 1 / rate;
    import->step = step;
    if (given > 0 || stated > 0) {
        *dt = given > 0 ? given : stated;
        if (given > 0 && stated > 0 && given != stated)
            add_note(import->notes, "dt is %g s, as given; the file states %g s", (double)given, (double)stated);
        else if (given > 0 && timed && fabs(step - (double)given) > TIME_TOLERANCE * step)
            add_note(import->notes, "dt is %g s, as given; the times of the file rise by %g s", (double)given, step);
        if (!(given > 0)) import->step = (double)stated;
        return true;
    }
    if (!timed && import->options->as_trace) return true; /* unknown */
    if (!timed)
        return error_input(
            error, import->path,
            "the time step is missing: give --dt S, a line '# dt: S' above the header, or a column time%s",
            has_times(import) ? " with more than one frame" : "");
    if (whole)
        add_note(import->notes, "dt is 1/%.0f s, from the column time", rate);
    else
        add_note(import->notes, "dt is %.9g s, from the column time", step);
    *dt = (float)step;
    return true;
}

static void set_state(CsvImport *import, const CsvRow *row, int body) {
    Trajectory *run = import->run;
    const size_t i = trajectory_at(run, row->frame - import->origin, body);
    double state[STATE_COLUMNS];
    memcpy(state, row->state, sizeof state);
    for (int column = 2; import->options->degrees && column < STATE_COLUMNS; column += 3)
        state[column] *= acos(-1) / 180;
    set_numbers(run, i, state);
    if (run->there != NULL) run->there[i] = 1;
    if (run->hash != NULL) run->hash[i] = row->hash;
}

/* The second pass. */
static bool fill(CsvImport *import, Error *error) {
    Trajectory *run = import->run;
    CsvRow row;
    /* Steps are float32, and times have some digits. */
    static const double FLOAT_TOLERANCE = 1e-7;
    const double dt = import->step;
    csv_rows_rewind(&import->rows, false);
    while (csv_rows_next(&import->rows, &row, error)) {
        const int body = body_index(import, row.body);
        if (row.frame >= import->end) continue;
        const double due = import->first_time + dt * (double)(row.frame - import->first);
        if (trajectory_there(run, (int)(row.frame - import->origin), body)) {
            const int line = row.line, before = csv_rows_find(&import->rows, row.frame, row.body);
            return csv_fail(import->path, line, 0, error,
                            "body %" PRId64 " is twice in frame %" PRId64 ": also in line %d", row.body, row.frame,
                            before);
        }
        const double most = TIME_TOLERANCE * dt + row.time_digit / 2 + FLOAT_TOLERANCE * fabs(due - import->first_time);
        if (has_times(import) && !(fabs(row.time - due) <= most))
            return csv_fail(import->path, row.line, 0, error,
                            "time %g s does not fit to equal steps of %g s: frame %" PRId64 " is due at %g s", row.time,
                            dt, row.frame, due);
        set_state(import, &row, body);
    }
    return error->kind == ERROR_NONE;
}

static bool has_rows(const Trajectory *run, int frame) {
    for (int body = 0; body < run->bodies; body++)
        if (trajectory_has(run, frame, body)) return true;
    return false;
}

static bool check_frames(CsvImport *import, Error *error) {
    const Trajectory *run = import->run;
    for (int frame = 0; frame < run->frames; frame++) {
        CsvRow row;
        int next = frame;
        if (has_rows(run, frame)) continue;
        while (!has_rows(run, next)) next++;
        csv_rows_rewind(&import->rows, false);
        while (csv_rows_next(&import->rows, &row, error) && row.frame != import->first + next) continue;
        return csv_fail(import->path, row.line, 0, error,
                        "frame %" PRId64 " comes here, but frame %" PRId64 " has no rows", row.frame,
                        import->first + frame);
    }
    return true;
}

static bool finish_head(CsvImport *import, Error *error) {
    Trajectory *run = import->run;
    const CsvHead *head = &import->head;
    const char *name = import->options->name;
    snprintf(run->scene, sizeof run->scene, "%s", head->scene[0] != '\0' ? head->scene : name);
    snprintf(run->method, sizeof run->method, "%s", head->method[0] != '\0' ? head->method : name);
    run->scene_hash = head->scene_hash;
    run->iterations = (int)head->iterations;
    run->bomb = head->bomb < 0 ? -1 : body_index(import, head->bomb);
    run->camera_center = head->camera[0];
    run->camera_size = head->camera[1];
    return head->bomb < 0 || run->bomb >= 0 ||
           error_input(error, import->path, "the bomb is body %" PRId64 ", which has no size", head->bomb);
}

static void note_numbers(const CsvImport *import) {
    const CsvHead *head = &import->head;
    const int64_t least = head->bodies[0].number, most = head->bodies[head->count - 1].number;
    CsvRunNotes *notes = import->notes;
    if (import->first != 0) add_note(notes, "frame %" PRId64 " of the file becomes frame 0", import->first);
    if (least != 0 || most >= (int64_t)head->count)
        add_note(notes, "bodies %" PRId64 " to %" PRId64 " of the file become bodies 0 to %zu", least, most,
                 head->count - 1);
    if (head->scene[0] == '\0') add_note(notes, "the scene is called '%s'", import->run->scene);
    if (head->method[0] == '\0') add_note(notes, "the method is called '%s'", import->run->method);
    if (import->run->no_velocities) add_note(notes, "velocities are unknown: there are no columns vx, vy and omega");
    if (import->rows.ignored[0] != '\0') add_note(notes, "unknown columns are left out: %s", import->rows.ignored);
    add_note(notes, "units are m, s and %s; y points up", import->options->degrees ? "degrees" : "rad");
}

static bool make_run(CsvImport *import, const char *text, Error *error) {
    CsvHead *head = &import->head;
    const bool as_trace = import->options->as_trace;
    float dt = 0;
    int line;
    if (!csv_head_read(head, import->path, &text, &line, import->options, error) ||
        !csv_rows_begin(&import->rows, import->path, text, line, as_trace, error))
        return false;
    import->row_counts = calloc(head->count + 1, sizeof *import->row_counts);
    import->ends = malloc((head->count + 1) * sizeof *import->ends);
    if (import->row_counts == NULL || import->ends == NULL) return error_memory(error, import->path);
    for (size_t i = 0; i < head->count; i++) import->ends[i] = INT64_MAX;
    import->bodies = !as_trace ? (int)head->count : head->count > 0 ? (int)head->bodies[head->count - 1].number + 1 : 0;
    if (!survey(import, error)) return false;
    import->origin = as_trace ? 0 : import->first; /* frames of a trace have the numbers of the file, too */
    if (!check_frames_and_size(import, error) || !choose_step(import, &dt, error)) return false;
    Trajectory *run = import->run = trajectory_create((int)(import->last - import->origin + 1), import->bodies, error);
    if (run == NULL) return false;
    run->dt = dt;
    run->no_contacts = true;
    run->no_velocities = import->rows.field[COL_VX] < 0;
    run->no_poses = import->rows.field[COL_X] < 0;
    const size_t states = (size_t)run->frames * (size_t)run->bodies,
                 numbers = (size_t)(run->no_poses        ? 0
                                    : run->no_velocities ? 3
                                                         : STATE_COLUMNS) *
                           states;
    if ((!head->single && (run->exact = malloc(numbers * sizeof *run->exact + 1)) == NULL) ||
        (as_trace && (run->there = calloc(states, 1)) == NULL) ||
        (import->rows.field[COL_HASH] >= 0 && as_trace && (run->hash = calloc(states, sizeof *run->hash)) == NULL))
        return error_memory(error, import->path);
    for (size_t i = 0; run->exact != NULL && i < numbers; i++) run->exact[i] = NAN;
    if (!fill(import, error) || (!as_trace && !check_frames(import, error)) || !finish_bodies(import, error) ||
        !finish_head(import, error))
        return false;
    if (as_trace) return true;
    note_numbers(import);
    if (import->end < INT64_MAX) {
        add_note(import->notes, "the run ends before frame %" PRId64 ", in which body %" PRId64 " is NaN or infinite",
                 import->end, head->bodies[import->ended].number);
        trajectory_judge(run, verdict_name(VERDICT_NON_FINITE), run->frames - 1, import->ended);
    }
    return trajectory_check(run, import->path, error);
}

Trajectory *csv_run_read(const char *path, const CsvRunOptions *options, CsvRunNotes *notes, Error *error) {
    CsvImport import = {.path = path, .options = options, .notes = notes, .end = INT64_MAX};
    notes->count = 0;
    const bool input = strcmp(path, "-") == 0;
    if (input) import.path = path = "standard input";
    char *text =
        input ? file_read_input(MAX_SIZE, &import.size, error) : file_read(path, MAX_SIZE, &import.size, error);
    static const struct {
        const char *begin, *kind;
    } others[] = {{"\x89HDF", "HDF5"},
                  {"PK\3\4", "a zip archive, as .npz and .xlsx are"},
                  {"\x1f\x8b", "compressed"},
                  {"\x93NUMPY", ".npy of NumPy"},
                  {"PAR1", "Parquet"}};
    for (size_t i = 0; text != NULL && i < sizeof others / sizeof *others; i++)
        if (strncmp(text, others[i].begin, strlen(others[i].begin)) == 0) {
            free(text);
            return error_input(error, path, "is %s; only CSV can be imported", others[i].kind), NULL;
        }
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), previous = c != (locale_t)0 ? uselocale(c) : c;
    bool done = text != NULL && (c != (locale_t)0 || error_memory(error, path)) &&
                (import.size > 0 || error_input(error, path, "the file is empty")) &&
                (strlen(text) == import.size || error_input(error, path, "has a NUL byte: not a CSV file")) &&
                make_run(&import, text, error);
    if (c != (locale_t)0) uselocale(previous), freelocale(c);
    free(text);
    free(import.row_counts);
    free(import.ends);
    free(import.head.bodies);
    if (done) return import.run;
    trajectory_destroy(import.run);
    return NULL;
}

Trajectory *csv_trace_read(const char *path, Error *error) {
    char name[TRAJECTORY_NAME_SIZE];
    CsvRunNotes notes;
    trajectory_name_from_path(path, name);
    return csv_run_read(path, &(CsvRunOptions){.name = name, .as_trace = true}, &notes, error);
}
