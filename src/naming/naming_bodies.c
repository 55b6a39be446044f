/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "naming/naming_bodies.h"

#include "naming/naming_panel.h"

#include <math.h>
#include <stdlib.h>

static const double SEEN = 0.01;  /* pixels; the states of a body that moved less explain no pixel */
static const double AROUND = 1.5; /* pixels beyond its edge that a body may change */
enum { FITS = 4, CANDIDATES = 4, SINGLE = 6 };

static Change change_of(const Panel *panel, const Drawn *body, ChangeKind kind) {
    const Trajectory *run = panel->runs[0];
    BodyLayer at = panel_layer(run, body->index);
    int fixed = 0;
    for (int i = 0; i < run->bodies && fixed < 2; i++) fixed += run->fixed[i] != 0;
    ChangeSubject subject = at == LAYER_BOMB      ? SUBJECT_BOMB
                            : at == LAYER_DYNAMIC ? SUBJECT_BODY
                            : fixed == 1          ? SUBJECT_GROUND
                                                  : SUBJECT_FIXED;
    return (Change){.subject = subject, .kind = kind, .panel = panel->number + 1, .body = body->index};
}

static int by_movement(const void *a, const void *b) {
    const Drawn *x = *(const Drawn *const *)a, *y = *(const Drawn *const *)b;
    if (x->moved != y->moved) return x->moved > y->moved ? -1 : 1;
    return x->index < y->index ? -1 : 1;
}

static int64_t take_body(Panel *panel, const Drawn *body, int change) {
    int64_t taken = 0;
    for (int side = 0; side < 2; side++)
        if (body->exists[side])
            taken += naming_take_box(panel->naming, panel->view->rect, &body->box[side], AROUND, change);
    return taken;
}

/* Removes the last change if it has no pixels. */
static void drop_empty(Naming *naming, int change) {
    if (change >= 0 && naming->changes->list[change].pixels == 0) naming->changes->count--;
}

static int add_moved(Panel *panel, const Drawn *body) {
    ChangeKind kind = !body->exists[0] ? CHANGE_APPEARED : !body->exists[1] ? CHANGE_DISAPPEARED : CHANGE_MOVED;
    Change change = change_of(panel, body, kind);
    change.by_states = true;
    if (kind == CHANGE_MOVED) {
        const BoxModel *a = &body->box[0], *b = &body->box[1];
        change.right = b->x - a->x, change.up = a->y - b->y;
        change.turn = atan2(a->cosine * b->sine - a->sine * b->cosine, a->cosine * b->cosine + a->sine * b->sine);
    }
    return naming_add(panel->naming, &change);
}

/* Those that moved farthest get names, and the others their number. */
static bool name_moved(Panel *panel, Error *error) {
    const Drawn **moved = malloc(((size_t)panel->count + 1) * sizeof *moved);
    int count = 0, rest = -1;
    if (moved == NULL) return error_memory(error, "regions");
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].moved >= SEEN) moved[count++] = &panel->bodies[i];
    qsort(moved, (size_t)count, sizeof *moved, by_movement);
    for (int i = 0; i < count; i++) {
        if (i < SINGLE) {
            int change = add_moved(panel, moved[i]);
            if (change >= 0) take_body(panel, moved[i], change);
            drop_empty(panel->naming, change);
            continue;
        }
        Change others = change_of(panel, moved[i], CHANGE_MOVED);
        others.subject = SUBJECT_BODIES, others.by_states = true, others.body = count - SINGLE;
        if (i == SINGLE) rest = naming_add(panel->naming, &others);
        if (rest >= 0) take_body(panel, moved[i], rest);
    }
    drop_empty(panel->naming, rest);
    free(moved);
    return true;
}

static void count_unknown(Panel *panel) {
    const ViewRect rect = panel->view->rect;
    for (int i = 0; i < panel->count; i++) panel->bodies[i].pixels = 0;
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            size_t at = panel_pixel(panel, x, y);
            int top = panel->naming->tops[at];
            if (panel->naming->owners[at] == OWNER_UNKNOWN && top >= 0 && top < panel->count)
                panel->bodies[top].pixels++;
        }
}

/* The body not yet tried with the most unknown pixels, or -1. */
static int next_candidate(const Panel *panel) {
    int best = -1;
    for (int i = 0; i < panel->count; i++) {
        if (panel->bodies[i].tried || panel->bodies[i].pixels == 0) continue;
        if (best < 0 || panel->bodies[i].pixels > panel->bodies[best].pixels) best = i;
    }
    return best;
}

/* Names the body whose change explains most. False if no body has unknown pixels. */
static bool name_best(Panel *panel) {
    BodyFit best = {.explained = -1};
    int body = -1;
    const ViewRect changed = panel_unknown(panel);
    count_unknown(panel);
    for (int i = 0; i < panel->count; i++) panel->bodies[i].tried = false;
    for (int tried = 0, at; tried < CANDIDATES && (at = next_candidate(panel)) >= 0; tried++) {
        panel->bodies[at].tried = true;
        BodyFit found = panel_fit(panel, at, changed);
        if (body >= 0 && found.explained <= best.explained) continue;
        best = found, body = at;
    }
    if (body < 0) return false;
    Drawn drawn = panel->bodies[body];
    Change change = change_of(panel, &drawn, best.kind);
    change.right = best.right, change.up = best.up, change.turn = best.turn;
    /* Changes that the fit does not see are inside the body: its colours, or a bomb's target. */
    if (best.total <= 0) change.kind = CHANGE_COLOUR;
    drawn.exists[1] = true;
    drawn.box[1] = drawn.box[0];
    drawn.box[1].x += best.right, drawn.box[1].y -= best.up;
    drawn.box[1].cosine = cos(best.turn) * drawn.box[0].cosine - sin(best.turn) * drawn.box[0].sine;
    drawn.box[1].sine = sin(best.turn) * drawn.box[0].cosine + cos(best.turn) * drawn.box[0].sine;
    int added = naming_add(panel->naming, &change);
    bool took = added >= 0 && take_body(panel, &drawn, added) > 0;
    drop_empty(panel->naming, added);
    return took;
}

/* Bodies that still have unknown pixels: their number, or the only one. */
static void name_others(Panel *panel) {
    int count = 0, last = -1, change;
    count_unknown(panel);
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].pixels > 0) count++, last = i;
    if (count == 0) return;
    Change others = change_of(panel, &panel->bodies[last], CHANGE_OTHER);
    if (count > 1) others.subject = SUBJECT_BODIES, others.body = count;
    if ((change = naming_add(panel->naming, &others)) < 0) return;
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].pixels > 0)
            naming_take_box(panel->naming, panel->view->rect, &panel->bodies[i].box[0], AROUND, change);
    drop_empty(panel->naming, change);
}

bool naming_bodies(Naming *naming, int number, Error *error) {
    Panel panel;
    bool usable = false,
         ok = panel_open(&panel, naming, number, &usable, error) && (!usable || name_moved(&panel, error));
    if (ok && usable) {
        for (int i = 0; i < FITS && name_best(&panel); i++) {
        }
        name_others(&panel);
    }
    panel_close(&panel);
    return ok;
}
