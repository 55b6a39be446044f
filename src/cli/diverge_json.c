/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/divergence.h"
#include "cli/json_output.h"

#include <math.h>

static void write_run(JsonWriter *json, const char *path, const Trajectory *run) {
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "path", path);
    json_put_text(json, "scene", run->scene);
    json_put_hash(json, "scene_hash", run->scene_hash);
    json_put_text(json, "method", run->method);
    json_put_int(json, "frames", run->frames);
    json_put_int(json, "bodies", run->bodies);
    json_end(json);
}

/* The number of a frame; negative: no frame. */
static void put_frame(JsonWriter *json, const char *key, int frame) {
    if (frame >= 0)
        json_put_int(json, key, frame);
    else
        json_put_text(json, key, NULL);
}

/* The only run that has it. */
static void write_only_in(JsonWriter *json, bool in_first, bool in_second) {
    put_frame(json, "only_in_run", in_first && in_second ? -1 : in_first ? 1 : 2);
}

static void write_parted(JsonWriter *json, const char *key, const Divergence *d, const PartedBody *parted) {
    const Trajectory *a = d->runs[0];
    if (parted->frame < 0) {
        json_put_text(json, key, NULL);
        return;
    }
    const bool both = parted->by.in_a && parted->by.in_b, moves = both && !d->parting.poses_only;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "frame", parted->frame);
    json_put_int(json, "body", parted->body);
    json_put_bool(json, "bomb", parted->body == a->bomb);
    json_put_int(json, "bodies", parted->bodies);
    write_only_in(json, parted->by.in_a, parted->by.in_b);
    json_put_number(json, "distance", both ? parted->by.distance : NAN);
    json_put_number(json, "angle", both ? parted->by.angle : NAN);
    json_put_number(json, "speed", moves ? parted->by.speed : NAN);
    json_put_number(json, "spin", moves ? parted->by.spin : NAN);
    json_end(json);
}

static void write_contact(JsonWriter *json, const ContactDifference *contacts) {
    const bool only = contacts->only_a + contacts->only_b > 0;
    if (!only && contacts->changed == 0) {
        json_put_text(json, "contact", NULL);
        return;
    }
    const TrajectoryContact *a = only ? &contacts->only : &contacts->largest_a;
    const TrajectoryContact *b = only ? &contacts->only : &contacts->largest_b;
    const bool in_first = !only || contacts->only_first_a, in_second = !only || !contacts->only_first_a;
    json_begin_object(json, "contact", JSON_ONE_LINE);
    json_put_int(json, "a", a->a);
    json_put_int(json, "b", a->b);
    json_put_int(json, "feature", a->feature);
    json_output_pair(json, "point", (double)a->point.x, (double)a->point.y);
    write_only_in(json, in_first, in_second);
    json_output_pair(json, "normal_impulse", in_first ? (double)a->normal_impulse : 0,
                     in_second ? (double)b->normal_impulse : 0);
    json_output_pair(json, "tangent_impulse", in_first ? (double)a->tangent_impulse : 0,
                     in_second ? (double)b->tangent_impulse : 0);
    json_end(json);
}

static void write_contacts(JsonWriter *json, const char *key, int step, const ContactDifference *contacts) {
    if (step < 0) {
        json_put_text(json, key, NULL);
        return;
    }
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "step", step);
    json_put_int(json, "changed", contacts->changed);
    json_put_int(json, "moved", contacts->moved);
    json_put_int(json, "only_in_run_1", contacts->only_a);
    json_put_int(json, "only_in_run_2", contacts->only_b);
    write_contact(json, contacts);
    json_end(json);
}

static void write_growth(JsonWriter *json, const char *key, const Growth *growth, double dt) {
    const bool rate = growth->count >= GROWTH_MIN_FRAMES;
    json_begin_object(json, key, JSON_ONE_LINE);
    put_frame(json, "first", growth->first);
    put_frame(json, "last", growth->last);
    json_put_int(json, "count", growth->count);
    json_put_bool(json, "saturated", growth->saturated);
    json_put_number(json, "from", growth->count > 0 ? growth->from : NAN);
    json_put_number(json, "to", growth->count > 0 ? growth->to : NAN);
    json_put_number(json, "rate", rate ? growth->rate : NAN);
    json_put_number(json, "doubling_frames", rate ? growth_doubling(growth, dt) : NAN);
    json_put_number(json, "scatter_factor", rate ? exp(growth->scatter) : NAN);
    json_end(json);
}

static void write_chaos(JsonWriter *json, const Divergence *d, double dt) {
    static const char *const verdicts[] = {[GROWTH_UNKNOWN] = "unknown",
                                           [GROWTH_NEITHER] = "neither doubles",
                                           [GROWTH_SAME] = "chaos",
                                           [GROWTH_FASTER] = "faster",
                                           [GROWTH_SLOWER] = "slower"};
    json_begin_object(json, "shifted", JSON_LINES);
    json_put_int(json, "body", d->chaos.body);
    json_put_number(json, "shift", d->chaos.shift);
    put_frame(json, "rerun_differs", d->chaos.rerun_differs);
    write_growth(json, "growth", &d->shifted, dt);
    json_put_text(json, "verdict", verdicts[growth_compare(&d->growth, &d->shifted, dt)]);
    json_end(json);
}

static void write_divergence(JsonWriter *json, const void *context) {
    static const char *const causes[] = {[PART_NONE] = "none",
                                         [PART_START] = "initial state",
                                         [PART_LAUNCH] = "launch",
                                         [PART_HIDDEN] = "warm start",
                                         [PART_CONTACTS] = "collision detection",
                                         [PART_SOLVER] = "solver",
                                         [PART_ELSEWHERE] = "not the contacts",
                                         [PART_UNKNOWN] = "unknown"};
    const Divergence *d = context;
    const TrajectoryParting *parting = &d->parting;
    const Trajectory *a = d->runs[0];
    const bool differ = parting->first.frame >= 0, contacts = !a->no_contacts && !d->runs[1]->no_contacts,
               beyond = contacts && d->tolerance > 0 && parting->beyond.frame > 0;
    json_begin_array(json, "runs", JSON_LINES);
    for (int i = 0; i < 2; i++) write_run(json, d->paths[i], d->runs[i]);
    json_end(json);
    json_put_int(json, "frames", parting->frames);
    json_put_number(json, "tolerance", d->tolerance);
    json_put_bool(json, "poses_only", parting->poses_only);
    json_put_bool(json, "diverge", parting->beyond.frame >= 0);
    write_parted(json, "first", d, &parting->first);
    json_put_text(json, "cause", causes[parting->cause]);
    write_contacts(json, "contacts", parting->step, &parting->contacts);
    write_parted(json, "beyond", d, &parting->beyond);
    write_contacts(json, "beyond_contacts", beyond ? parting->beyond.frame : -1, &parting->beyond_contacts);
    if (differ)
        write_growth(json, "growth", &d->growth, (double)a->dt);
    else
        json_put_text(json, "growth", NULL);
    if (differ && d->chaos.distance != NULL)
        write_chaos(json, d, (double)a->dt);
    else
        json_put_text(json, "shifted", NULL);
}

bool diverge_print_json(const Divergence *divergence, Error *error) {
    return json_output("twinbox diverge 1", write_divergence, divergence, error);
}
