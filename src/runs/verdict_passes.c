/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether bodies pass through each other: through static boxes by their centres, through moving ones by their sides. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/runs_internal.h"
#include "runs/verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Static boxes. */

/* Clips the interval `part` of t to -half < start + t step < half. */
static void verdict_passes_clip(double part[2], double start, double step, double half) {
    if (step == 0) {
        if (fabs(start) >= half) part[1] = part[0];
        return;
    }
    double in = (-half - start) / step, out = (half - start) / step;
    const double first = in < out ? in : out, last = in < out ? out : in;
    if (first > part[0]) part[0] = first;
    if (last < part[1]) part[1] = last;
}

/* Whether a step from `start` stays on one side of -half .. half. Decides most steps without a division. */
static bool stays_beside(double start, double step, double half) {
    return (start >= half && start + step >= half) || (start <= -half && start + step <= -half);
}

/* Whether the segment between two points (or the point, if they are equal) intersects the interior of the box. In the
   box's axes and in double, so that it is exact far from the origin too. */
static bool passes(const WatchedStatic *fixed, const Body *box, Vec2 from, Vec2 to) {
    const double c = fixed->cosine, s = fixed->sine;
    double x = (double)from.x - box->position.x, y = (double)from.y - box->position.y;
    double step_x = (double)to.x - from.x, step_y = (double)to.y - from.y;
    const double along = c * x + s * y, step_along = c * step_x + s * step_y, half_along = 0.5 * (double)box->size.x;
    const double up = c * y - s * x, step_up = c * step_y - s * step_x, half_up = 0.5 * (double)box->size.y;
    if (stays_beside(up, step_up, half_up) || stays_beside(along, step_along, half_along)) return false;
    double part[2] = {0, 1};
    verdict_passes_clip(part, along, step_along, half_along);
    verdict_passes_clip(part, up, step_up, half_up);
    return part[0] < part[1];
}

static bool passes_any(const VerdictWatch *watch, const VerdictStep *step, Vec2 from, Vec2 to) {
    for (int i = 0; i < watch->static_count; i++)
        if (passes(&watch->statics[i], &step->bodies[watch->statics[i].body], from, to)) return true;
    return false;
}

static void check_tunnels(VerdictWatch *watch, const VerdictStep *step) {
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        const Vec2 now = step->bodies[i].position;
        if (step->bodies[i].inv_mass == 0) continue;
        if (passes_any(watch, step, watched->outside, now)) {
            if (passes_any(watch, step, now, now)) continue;
            verdict_note(watch, VERDICT_TUNNELS, i, vec2_distance(watched->last, now) / (double)watch->run.dt, "m/s");
        }
        watched->outside = now;
    }
}

/* Moving boxes. Two that are not deep in each other are apart along some sides, and those of the next step tell whether
   they have changed places. */

/* A box for the test, in double. */
typedef struct PassPose {
    double x, y, cosine, sine, half_x, half_y;
} PassPose;

static PassPose pose_of(const Body *body) {
    return (PassPose){body->position.x,         body->position.y,           cos((double)body->angle),
                      sin((double)body->angle), 0.5 * (double)body->size.x, 0.5 * (double)body->size.y};
}

/* m: how far the box reaches from its centre along an axis. */
static double verdict_passes_reach(const PassPose *box, double x, double y) {
    return box->half_x * fabs(box->cosine * x + box->sine * y) + box->half_y * fabs(box->cosine * y - box->sine * x);
}

/* The sides of both boxes (two bits for each axis of a, then of b) along which b is beside a, overlapping by less than
   `depth`. None: they are deep in each other. */
static unsigned sides_between(const PassPose *a, const PassPose *b, double depth) {
    const double x = b->x - a->x, y = b->y - a->y;
    const double axes[][2] = {{a->cosine, a->sine}, {-a->sine, a->cosine}, {b->cosine, b->sine}, {-b->sine, b->cosine}};
    unsigned sides = 0;
    for (int i = 0; i < 4; i++) {
        const double along = x * axes[i][0] + y * axes[i][1];
        const double touching =
            verdict_passes_reach(a, axes[i][0], axes[i][1]) + verdict_passes_reach(b, axes[i][0], axes[i][1]) - depth;
        if (along > touching) sides |= 1u << (2 * i);
        if (-along > touching) sides |= 2u << (2 * i);
    }
    return sides;
}

/* b was on one side of a, and is on the opposite one, and no side stayed, as seen from one of them: the sides of one
   that rotates fast are others after a step. */
static bool changes_places(unsigned before, unsigned after) {
    const unsigned opposite = (before & 0x55u) << 1 | (before >> 1 & 0x55u), stayed = before & after;
    const unsigned of_a = 0x0fu, of_b = 0xf0u;
    return ((stayed & of_a) == 0 && (opposite & after & of_a) != 0) ||
           ((stayed & of_b) == 0 && (opposite & after & of_b) != 0);
}

static double verdict_passes_between(double from, double to, double part) { return from + part * (to - from); }

static PassPose pose_between(const WatchedBody *last, const Body *now, double part) {
    const double angle = verdict_passes_between(last->last_angle, now->angle, part);
    return (PassPose){verdict_passes_between(last->last.x, now->position.x, part),
                      verdict_passes_between(last->last.y, now->position.y, part),
                      cos(angle),
                      sin(angle),
                      0.5 * (double)now->size.x,
                      0.5 * (double)now->size.y};
}

/* Two bodies and their movement in this step. */
typedef struct Passage {
    const WatchedBody *last_a, *last_b;
    const Body *a, *b;
    double depth;      /* m: half the smallest side */
    double way, turns; /* m, rad: relative movement */
} Passage;

static Passage passage_of(const VerdictWatch *watch, const VerdictStep *step, BodyPair pair) {
    Passage passage = {&watch->bodies[pair.a], &watch->bodies[pair.b], &step->bodies[pair.a], &step->bodies[pair.b],
                       .depth = 0.5 * fmin(smaller_side(&step->bodies[pair.a]), smaller_side(&step->bodies[pair.b]))};
    const Vec2 before = vec2_sub(passage.last_b->last, passage.last_a->last),
               now = vec2_sub(passage.b->position, passage.a->position);
    passage.way = vec2_distance(before, now);
    passage.turns = fabs((double)passage.a->angle - passage.last_a->last_angle) +
                    fabs((double)passage.b->angle - passage.last_b->last_angle);
    return passage;
}

/* Whether the bodies are deep in each other on the straight way of this step, and not only beside each other. */
static bool meets(const Passage *passage) {
    enum { MOST = 10000 };
    const double small_turn = 0.1, wanted = ceil(passage->way / passage->depth + passage->turns / small_turn);
    const int parts = wanted < MOST ? (int)wanted : MOST;
    for (int i = 1; i < parts; i++) {
        const double part = (double)i / parts;
        const PassPose a = pose_between(passage->last_a, passage->a, part),
                       b = pose_between(passage->last_b, passage->b, part);
        if (sides_between(&a, &b, passage->depth) == 0) return true;
    }
    return false;
}

/* Moves by less than half a side change no places in one step: the bodies would be deep in each other after it. */
static bool is_slow(const Passage *passage) {
    const double small_turn = 0.5;
    return passage->way < passage->depth && passage->turns < small_turn;
}

/* `known`: the sides before the bodies were deep in each other, or NULL. Returns the sides that are to be kept, if they
   are deep. */
static bool check_pair(VerdictWatch *watch, const VerdictStep *step, BodyPair pair, const DeepPair *known,
                       DeepPair *deep) {
    const Passage passage = passage_of(watch, step, pair);
    const PassPose a = pose_of(passage.a), b = pose_of(passage.b);
    const unsigned after = sides_between(&a, &b, passage.depth);
    if (after != 0 && known == NULL && is_slow(&passage)) return false;
    const PassPose last_a = pose_between(passage.last_a, passage.a, 0),
                   last_b = pose_between(passage.last_b, passage.b, 0);
    const unsigned before = known != NULL ? known->sides : sides_between(&last_a, &last_b, passage.depth);
    *deep = (DeepPair){pair, before};
    if (after == 0) return true;
    if (changes_places(before, after) && (known != NULL || meets(&passage)) &&
        verdict_note(watch, VERDICT_TUNNELS, pair.b, passage.way / (double)watch->run.dt, "m/s"))
        watch->worst.other = pair.a;
    return false;
}

/* Bounds of the circles around a body in the last frame and in this one. */
static Bounds swept_bounds(const WatchedBody *last, const Body *now) {
    const float radius = (float)(0.5 * vec2_distance(now->size, vec2(0, 0)));
    const Vec2 a = last->last, b = now->position;
    return (Bounds){{fminf(a.x, b.x) - radius, fminf(a.y, b.y) - radius},
                    {fmaxf(a.x, b.x) + radius, fmaxf(a.y, b.y) + radius}};
}

static bool find_near(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    PassFinder *passes = &watch->passes;
    const int count = step->body_count;
    if (!array_reserve((void **)&passes->bounds, &passes->bound_capacity, (size_t)count + 1, sizeof *passes->bounds) ||
        !array_reserve((void **)&passes->fixed, &passes->fixed_capacity, (size_t)count + 1, sizeof *passes->fixed))
        return error_memory(error, "verdict");
    for (int i = 0; i < count; i++) {
        passes->bounds[i] = swept_bounds(&watch->bodies[i], &step->bodies[i]);
        passes->fixed[i] = step->bodies[i].inv_mass == 0;
    }
    return sort_and_sweep_find(&passes->broad_phase, &passes->near, passes->bounds, passes->fixed, count) ||
           passes->broad_phase.too_many || error_memory(error, "verdict");
}

static int by_pair(BodyPair a, BodyPair b) { return a.a != b.a ? a.a - b.a : a.b - b.b; }

/* Both lists are in the order of their pairs; the deep ones of this step are appended to the others, then take their
   place. */
static bool check_near(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    PassFinder *passes = &watch->passes;
    const int old = passes->deep_count;
    int count = old, next = 0;
    for (size_t i = 0; i < passes->near.count; i++) {
        const BodyPair pair = passes->near.pairs[i];
        DeepPair deep;
        if (passes->fixed[pair.a] || passes->fixed[pair.b]) continue;
        while (next < old && by_pair(passes->deep[next].pair, pair) < 0) next++;
        const bool known = next < old && by_pair(passes->deep[next].pair, pair) == 0;
        if (!check_pair(watch, step, pair, known ? &passes->deep[next] : NULL, &deep)) continue;
        if (!array_reserve((void **)&passes->deep, &passes->deep_capacity, (size_t)count + 1, sizeof *passes->deep))
            return error_memory(error, "verdict");
        passes->deep[count++] = deep;
    }
    passes->deep_count = count - old;
    if (count > old) memmove(passes->deep, passes->deep + old, (size_t)(count - old) * sizeof *passes->deep);
    return true;
}

bool check_passes(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    check_tunnels(watch, step);
    return find_near(watch, step, error) && check_near(watch, step, error);
}

void pass_finder_free(PassFinder *passes) {
    sort_and_sweep_free(&passes->broad_phase);
    free(passes->near.pairs);
    free(passes->bounds);
    free(passes->fixed);
    free(passes->deep);
    *passes = (PassFinder){.deep_count = 0};
}
