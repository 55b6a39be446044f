/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Traces of other programs: ten planted differences are found at their frame and body, and named by their kind; what is
   not equal is never called so. */
#include "made.h"

#include "runs/run_files.h"

enum { FRAMES = 200, BODIES = 5, PARTS = 137 };

typedef enum Plant { NOTHING, BIT, FUSED, HEAVIER, LONGER, NOT_A_NUMBER, LOST, WRAPPED, LATER, MIRRORED } Plant;

/* A small engine: bodies that are thrown, turn and are slowed. */
static const char *engine_trace(const char *name, Plant plant) {
    const char *path = temporary_path(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "frame,body,x,y,angle\n");
    double x[BODIES], y[BODIES], vx[BODIES], vy[BODIES], angle[BODIES];
    for (int i = 0; i < BODIES; i++) x[i] = i + 0.1, y[i] = 10, vx[i] = vy[i] = 0, angle[i] = 0;
    for (int frame = 0; frame < FRAMES; frame++)
        for (int i = 0; i < BODIES; i++) {
            const bool parts = frame >= PARTS && i == 3;
            const double dt = plant == LONGER && frame >= PARTS ? 1.0 / 50 : 1.0 / 60,
                         mass = plant == HEAVIER && parts ? 3 : 2;
            if (frame > 0) {
                vx[i] += (1.5 - vx[i]) / mass * dt, vy[i] += (-9.81 - vy[i] / mass) * dt;
                x[i] = plant == FUSED && frame >= PARTS ? fma(vx[i], dt, x[i]) : x[i] + vx[i] * dt;
                y[i] = plant == FUSED && frame >= PARTS ? fma(vy[i], dt, y[i]) : y[i] + vy[i] * dt;
                angle[i] += 0.03 * (i + 1);
            }
            double shown = x[i];
            if (plant == BIT && parts && frame == PARTS) shown = nextafter(shown, INFINITY);
            if (plant == NOT_A_NUMBER && parts) shown = NAN;
            if (plant == MIRRORED) shown = -shown;
            if (plant == LOST && parts) continue;
            fprintf(file, "%d,%d,%.17g,%.17g,%.17g\n", plant == LATER ? frame + 1 : frame, i, shown, y[i],
                    plant == WRAPPED    ? remainder(angle[i], 2 * acos(-1))
                    : plant == MIRRORED ? -angle[i]
                                        : angle[i]);
        }
    fclose(file);
    return path;
}

static TrajectoryParting parting;

static const char *kind_of(const Trajectory *a, const Trajectory *b) {
    Error error = {0};
    static PartingKind kind;
    assert_ok(trajectory_part(a, b, &(PoseTolerance){0}, &parting, &error), error);
    kind = trajectory_part_kind(a, b, &parting);
    return kind.text;
}

static Trajectory *trace_of(const char *path) {
    Error error = {0};
    Trajectory *run = csv_trace_read(path, &error);
    assert_ok(run != NULL, error);
    return run;
}

/* Those that a trace can show; a contact's order and a stated mass follow. */
TEST(planted_differences_are_named) {
    static const struct {
        Plant plant;
        int frame, body;
        const char *kind;
    } planted[] = {{BIT, PARTS, 3, "roundings: at most 1 unit in the last place"},
                   {FUSED, 160, 3, "roundings: at most "},
                   {HEAVIER, PARTS, 3, "motion: more than roundings, in 1 body"},
                   {LONGER, PARTS, 0, "a step: every body moves 1.20"},
                   {NOT_A_NUMBER, PARTS, 3, "not finite: nan in run 2"},
                   {LOST, PARTS, 3, "a body: run 2 does not have it"},
                   {WRAPPED, 21, 4, "whole turns: angles by 1 turn,"},
                   {LATER, 0, 0, "frames: run 2 has the states of run 1 1 frame later"},
                   {MIRRORED, 0, 0, "x mirrored, angle mirrored"}};
    OWN(Trajectory) *a = trace_of(engine_trace("a.csv", NOTHING));
    for (size_t i = 0; i < sizeof planted / sizeof *planted; i++) {
        OWN(Trajectory) *b = trace_of(engine_trace("b.csv", planted[i].plant));
        const char *kind = kind_of(a, b);
        if (strncmp(kind, planted[i].kind, strlen(planted[i].kind)) != 0 || parting.first.frame != planted[i].frame ||
            parting.first.body != planted[i].body)
            fail_msg("%zu: frame %d, body %d: %s", i, parting.first.frame, parting.first.body, kind);
    }
    OWN(Trajectory) *same = trace_of(engine_trace("b.csv", NOTHING));
    assert_string_equal(kind_of(a, same), "");
    assert_true(parting.first.frame < 0 && parting.equal == FRAMES);
}

/* Contacts of one step in another order, and what the sweeps then round otherwise. */
TEST(the_order_of_contacts_and_a_mass_are_named) {
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = PARTS + 3;
    OWN(Trajectory) *a = run_by(scene, "engine"), *b = run_by(scene, "engine");
    TrajectoryContact *contacts = &b->contacts[b->contact_start[PARTS]], first = contacts[0];
    contacts[0] = contacts[1];
    contacts[1] = first;
    contacts[0].normal_impulse = nextafterf(contacts[0].normal_impulse, INFINITY);
    const size_t at = trajectory_at(b, PARTS, contacts[0].b);
    b->position[at].x = nextafterf(b->position[at].x, INFINITY);
    assert_string_equal(kind_of(a, b), "an order: the contacts of step 137 come in another one");
    assert_true(parting.first.frame == PARTS && parting.first.body == contacts[0].b);
    scene->bodies[4].mass *= 1.5F;
    OWN(Trajectory) *heavier = run_by(scene, "engine");
    assert_string_equal(kind_of(a, heavier), "a mass: body 4 has 1 and 1.5 kg");
    assert_true(parting.first.frame > 0 && parting.cause == PART_SOLVER);
}

/* Two texts: equal, with a difference, or refused. */
#define HEAD "frame,body,x,y,angle\n"
#define ROW "0,1,0.5,2,3\n1,1,0.5,2,3\n"
static const struct {
    const char *a, *b;
    char result; /* '=', '!'; 'R': the second is refused */
} pairs[] = {
    {HEAD ROW, HEAD ROW, '='},
    {HEAD ROW, HEAD "1,1,0.5,2,3\r\n0,1,5e-1,0x1p1,+3.0", '='}, /* reordered, CRLF, other forms, no last line end */
    {HEAD ROW, "body,angle,y,x,frame\n1,3,2,0.5,0\n1,3,2,0.5,1\n", '='},
    {HEAD ROW, HEAD "0,1,0.5,2,3\n1,1,0.50000000000000011,2,3\n", '!'},
    {"# dt: 1/60\n# size: 1,1,1\n" HEAD "0,1,0.50000001,2,3\n",
     "# dt: 1/60\n# size: 1,1,1\n" HEAD "0,1,0.50000000,2,3\n", '!'},
    {"# dt: 1/60\n" HEAD ROW, "# dt: 1/50\n" HEAD ROW, '!'},
    {HEAD "0,1,0,2,3\n", HEAD "0,1,-0,2,3\n", '!'},
    {HEAD "0,1,0,2,0\n", HEAD "0,1,0,2,6.283185307179586\n", '!'},
    {HEAD "0,1,nan,2,3\n", HEAD "0,1,-NaN,2,3\n", '='},
    {HEAD "0,1,nan,2,3\n", HEAD "0,1,0,2,3\n", '!'},
    {HEAD "0,1,nan,nan,nan\n0,2,0,0,0\n", HEAD "0,2,0,0,0\n", '!'},
    {HEAD "0,1,nan,2,3\n", HEAD "0,1,inf,2,3\n", '!'},
    {HEAD "0,1,1e39,2,3\n", HEAD "0,1,2e39,2,3\n", '!'},
    {HEAD ROW, HEAD "0,1,0.5,2,3\n", '!'},          /* cut between lines */
    {HEAD ROW, HEAD "0,1,0.5,2,3\n1,1,0.5\n", 'R'}, /* and within one */
    {HEAD ROW, HEAD ROW "1,2,0,0,0\n", '!'},
    {HEAD ROW, HEAD "0,2,0.5,2,3\n1,2,0.5,2,3\n", '!'},
    {HEAD ROW, HEAD ROW "1,1,0.5,2,3\n", 'R'},
    {HEAD ROW, HEAD "0,1,0,5,2,3\n", 'R'},
    {HEAD ROW, "frame;body;x;y;angle\n0;1;0,5;2;3\n", 'R'},
    {HEAD ROW, "", 'R'},
    {HEAD ROW, HEAD, 'R'},
    {HEAD ROW, "frame,body,hash\n0,1,ab\n1,1,ab\n", '!'},
    {"frame,body,hash\n0,1,0x00ab\n", "frame,body,hash\n0,1,AB\n", '='},
    {"frame,body,hash\n0,1,ab\n", "frame,body,hash\n0,1,aa\n", '!'},
    {"frame,body,hash\n0,1,ab\n0,2,ab\n", "frame,body,hash\n0,1,ab\n", '!'},
    {"frame,body,x,y,angle,hash\n0,1,0,0,0,ab\n", "frame,body,hash\n0,1,ab\n", '='},
    {"frame,body,x,y,angle,hash\n0,1,0,0,0,ab\n", "frame,body,x,y,angle,hash\n0,1,0,0,0,ac\n", '!'},
    {"frame,body,hash\n0,1,ab\n", "frame,body,hash\n0,1,12345678901234567890\n", 'R'},
    {"frame,body,hash\n0,1,ab\n", "frame,body,hash\n0,1,-1\n", 'R'},
    {"frame,body,hash\n0,1,ab\n", "frame,body,x\n0,1,1\n", 'R'},
};

TEST(what_is_not_equal_is_not_called_so) {
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        error = (Error){0};
        OWN(Trajectory) *a = trace_of(write_bytes(temporary_path("a.csv"), pairs[i].a, strlen(pairs[i].a)));
        OWN(Trajectory) *b =
            csv_trace_read(write_bytes(temporary_path("b.csv"), pairs[i].b, strlen(pairs[i].b)), &error);
        TrajectoryDifference there = {0}, back = {0};
        if (b != NULL) trajectory_compare(a, b, &there), trajectory_compare(b, a, &back);
        const char result = b == NULL ? 'R' : there.equal ? '=' : '!';
        if (result != pairs[i].result || there.equal != back.equal) fail_msg("%zu: %c: %s", i, result, pairs[i].b);
    }
}

/* No tolerance lets a NaN or a missing body pass. */
TEST(nan_is_within_no_tolerance) {
    static const Plant plants[] = {NOT_A_NUMBER, LOST};
    OWN(Trajectory) *a = trace_of(engine_trace("a.csv", NOTHING));
    for (int i = 0; i < 2; i++) {
        OWN(Trajectory) *b = trace_of(engine_trace("b.csv", plants[i]));
        const PoseTolerance most = {.given = true, .distance = INFINITY, .angle = INFINITY};
        assert_ok(trajectory_part(a, b, &most, &parting, &error), error);
        assert_true(parting.beyond.frame == PARTS && parting.beyond.body == 3 && parting.within == 0);
    }
}

/* A run of float32 and what a program prints of it as float64 are compared as float32, and this is said. */
TEST(the_narrower_type_is_compared) {
    const char *path = temporary_path("run.csv");
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 20;
    OWN(Trajectory) *run = run_by(scene, "engine");
    assert_ok(csv_run_write(run, path, &error), error);
    OWN(Trajectory) *single = trace_of(path);
    assert_true(single->exact == NULL);
    assert_same_run(run, single);
    assert_string_equal(trajectory_compared(run, single).text, "every bit of float32 poses and velocities");
    OWN(Trajectory) *wide = trace_of(engine_trace("a.csv", NOTHING));
    assert_string_equal(trajectory_compared(wide, wide).text, "every bit of float64 poses");
}

RUN_TESTS(NULL, NULL)
