/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/csv_import.h"

#include <inttypes.h>
#include <string.h>

/* A body that is declared static, or has one row at the start of a run that declares none, stays where it is. */
static bool stays(const CsvImport *import, int body) {
    const Trajectory *run = import->run;
    if (import->head.states_static) return import->head.bodies[body].fixed;
    return run->frames > 1 && import->row_counts[body] == 1 && trajectory_has(run, 0, body);
}

static void carry_on(Trajectory *run, int body) {
    for (int frame = 1; frame < run->frames; frame++) {
        const size_t i = csv_import_place(run, frame, body), before = csv_import_place(run, frame - 1, body);
        if (trajectory_has(run, frame, body)) continue;
        run->position[i] = run->position[before];
        run->angle[i] = run->angle[before];
        run->velocity[i] = run->velocity[before];
        run->angular_velocity[i] = run->angular_velocity[before];
    }
}

/* A body may come and go once. */
static bool check_body(CsvImport *import, int body, Error *error) {
    const Trajectory *run = import->run;
    const int64_t number = import->head.bodies[body].number;
    int last = -1;
    for (int frame = 0; frame < run->frames; frame++) {
        if (!trajectory_has(run, frame, body)) continue;
        const int gap = last + 1, before = last;
        last = frame;
        if (before < 0 || gap == frame) continue;
        const int line = csv_rows_find(&import->rows, import->first + frame, number);
        return csv_rows_error(&import->rows, line, error,
                              "body %" PRId64 " is in frame %" PRId64 " and in frame %" PRId64
                              ", but not in frame %" PRId64,
                              number, import->first + before, import->first + frame, import->first + gap);
    }
    return true;
}

static void note_static(const CsvImport *import) {
    const Trajectory *run = import->run;
    char list[96] = "";
    int count = 0;
    for (int body = 0; body < run->bodies; body++) {
        size_t used = strlen(list);
        if (!run->fixed[body]) continue;
        if (count++ < 8)
            snprintf(list + used, sizeof list - used, "%s%" PRId64, used > 0 ? ", " : "",
                     import->head.bodies[body].number);
    }
    if (import->head.states_static) return;
    if (count == 0)
        csv_import_note(import->notes, "no body is static: each of them moves");
    else
        csv_import_note(import->notes, "%d static: %s%s never move%s", count, list, count > 8 ? ", ..." : "",
                        count == 1 ? "s" : "");
}

bool csv_import_finish_bodies(CsvImport *import, Error *error) {
    Trajectory *run = import->run;
    for (int body = 0; body < run->bodies; body++) {
        run->size[body] = import->head.bodies[body].size;
        run->fixed[body] = import->head.bodies[body].fixed;
        if (stays(import, body))
            carry_on(run, body);
        else if (!check_body(import, body, error))
            return false;
    }
    if (!import->head.states_static) trajectory_guess_fixed(run);
    note_static(import);
    return true;
}
