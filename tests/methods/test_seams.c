/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Boxes that slide over tiles, and stacks of plates, by the methods whose contacts are mended. */
#include "made.h"
#include "sanitized.h"

enum { TILES = 60, PLATES = 40 };

static const char *const mended[] = {"interior",
                                     "momentum",
                                     "nncg",
                                     "soft-step",
                                     "avbd",
                                     "reference",
                                     "admm:k=50",
                                     "engine:keep=0.05",
                                     "momentum:keep=0.05",
                                     "interior:keep=0.05",
                                     "soft-step:keep=0.05"};

enum { MENDED = sizeof mended / sizeof mended[0] };

typedef struct Slide {
    double x;    /* m, from the start to the end */
    double high; /* m, of the highest of its poses above the first */
} Slide;

/* A box of 0.8 m at the left end of the second of many tiles in a row, or of one floor (width 0), slides for 3 s. */
static Slide slide(const char *method, float width, float speed, float friction, float sunk) {
    const int tiles = width > 0 ? TILES : 1, frames = 180;
    BodyDef bodies[TILES + 1];
    const float size = width > 0 ? width : 100;
    for (int i = 0; i < tiles; i++)
        bodies[i] = (BodyDef){
            .size = {size, 1}, .fixed = true, .position = {((float)i + 0.5f) * size, -0.5f}, .friction = friction};
    const Vec2 start = vec2(size * (width > 0 ? 1 : 0.1f) + 0.4f, 0.4f - sunk);
    bodies[tiles] =
        (BodyDef){.size = {0.8f, 0.8f}, .mass = 1, .position = start, .velocity = {speed, 0}, .friction = friction};
    const Scene scene = scene_of_bodies(bodies, tiles + 1, frames);
    OWN(Trajectory) *run = run_by(&scene, method);
    Slide found = {0, 0};
    for (int frame = 0; frame <= frames; frame++) {
        const Vec2 position = run->position[frame * (tiles + 1) + tiles];
        found.x = (double)position.x - (double)start.x;
        found.high = fmax(found.high, (double)position.y - (double)start.y);
    }
    return found;
}

/* x = v t, however the floor is cut and however deep the box has sunk within the slop. */
TEST(without_friction_a_box_slides_over_seams) {
    static const float widths[] = {0.4f, 1, 1.37f}, sinks[] = {0, 0.005f};
    for (int i = 0; i < MENDED; i++)
        for (int k = 0; k < 6; k += sampled(5)) {
            const Slide found = slide(mended[i], widths[k % 3], 3, 0, sinks[k / 3]);
            if (fabs(found.x - 9) > 0.001 || found.high > 0.006)
                fail_msg("%s, tiles of %g m, sunk by %g m: %.5f m, %.4f m high", mended[i], (double)widths[k % 3],
                         (double)sinks[k / 3], found.x, found.high);
        }
}

/* As far as on one floor. */
TEST(friction_stops_a_box_on_tiles_as_on_one_floor) {
    static const char *const accurate[] = {"reference", "interior", "nncg", "engine:keep=0.05"};
    for (int i = 0; i < 4; i++)
        for (int speed = 1; speed <= 9; speed += 4) {
            const Slide whole = slide(accurate[i], 0, (float)speed, 0.3f, 0.005f),
                        cut = slide(accurate[i], 1, (float)speed, 0.3f, 0.005f);
            if (fabs(cut.x - whole.x) > 0.003)
                fail_msg("%s, %d m/s: %.5f m, on one floor %.5f m", accurate[i], speed, cut.x, whole.x);
        }
}

/* Box2D-Lite's contacts catch: the engine has its bits. */
TEST(the_engine_catches_at_seams) {
    assert_near(slide("engine", 0, 3, 0, 0.005f).x, 9, 0.001);
    assert_true(slide("engine", 1, 3, 0, 0.005f).x < 8);
}

/* Plates of 3 cm, placed one on another, stay in their order and hardly sink. */
TEST(thin_plates_stay_in_their_places) {
    static const char *const converging[] = {"reference", "interior", "admm"};
    BodyDef bodies[PLATES + 1] = {{.size = {200, 20}, .fixed = true, .position = {0, -10}, .friction = 0.5f}};
    for (int i = 1; i <= PLATES; i++)
        bodies[i] =
            (BodyDef){.size = {2, 0.03f}, .mass = 1, .position = {0, 0.03f * ((float)i - 0.5f)}, .friction = 0.5f};
    const Scene scene = scene_of_bodies(bodies, PLATES + 1, 120);
    for (int m = 0; m < 3; m++) {
        OWN(Trajectory) *run = run_by(&scene, converging[m]);
        const Vec2 *last = &run->position[scene.frames * (PLATES + 1)];
        for (int i = 1; i <= PLATES; i++)
            if (fabs((double)last[i].y - 0.03 * (i - 0.5)) > 0.01)
                fail_msg("%s: plate %d at %g m", converging[m], i, (double)last[i].y);
    }
}

RUN_TESTS(NULL, NULL)
