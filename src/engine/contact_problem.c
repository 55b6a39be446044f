/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of all float operations is fixed: reference trajectories are compared bit by bit. */
#include "base/base.h"
#include "engine/contact_set.h"
#include "engine/engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void contact_set_free(ContactSet *set) {
    free(set->arbiters);
    free(set->contacts);
    free(set->impulses);
    free(set->before);
    free(set->partners);
    *set = (ContactSet){0};
}

/* Reserves two points for every candidate pair. */
static bool reserve(ContactSet *set, size_t pairs) {
    return array_reserve((void **)&set->arbiters, &set->arbiter_capacity, pairs, sizeof *set->arbiters) &&
           array_reserve((void **)&set->contacts, &set->contact_capacity, 2 * pairs, sizeof *set->contacts) &&
           array_reserve((void **)&set->impulses, &set->impulse_capacity, 2 * pairs, sizeof *set->impulses) &&
           array_reserve((void **)&set->before, &set->before_capacity, 2 * pairs, sizeof *set->before);
}

bool contact_set_copy(ContactSet *to, const ContactSet *from) {
    size_t arbiters = (size_t)from->arbiter_count, contacts = (size_t)from->contact_count;
    if (!reserve(to, arbiters)) return false;
    to->arbiter_count = from->arbiter_count;
    to->contact_count = from->contact_count;
    if (arbiters == 0) return true;
    memcpy(to->arbiters, from->arbiters, arbiters * sizeof *to->arbiters);
    memcpy(to->contacts, from->contacts, contacts * sizeof *to->contacts);
    memcpy(to->impulses, from->impulses, contacts * sizeof *to->impulses);
    return true;
}

/* Writes an arbiter and its points, from set->contacts[first] on. */
static void write_arbiter(ContactSet *set, Arbiter *arbiter, BodyPair pair, int first, const Manifold *manifold,
                          float rest, const Box *boxes) {
    const Box *a = &boxes[pair.a], *b = &boxes[pair.b];
    *arbiter = (Arbiter){
        pair.a,
        pair.b,
        first,
        manifold->count,
        rest,
        false,
        {vec2_sub(b->position, a->position), a->rotation.column1, b->rotation.column1, {0, 0}},
    };
    for (int k = 0; k < manifold->count; k++) {
        const ManifoldPoint *point = &manifold->points[k];
        ContactPoint *contact = &set->contacts[first + k];
        contact->a = pair.a;
        contact->b = pair.b;
        contact->position = point->position;
        contact->normal = manifold->normal;
        contact->arm_a = vec2_sub(point->position, a->position);
        contact->arm_b = vec2_sub(point->position, b->position);
        contact->separation = arbiter->found.separation[k] = point->separation;
        contact->feature = point->feature;
        contact->warm_normal = contact->warm_tangent = 0;
    }
}

/* (cos, sin) of the rotation from one unit vector to another. */
static Vec2 turn_from(Vec2 from, Vec2 to) { return vec2(vec2_dot(from, to), vec2_cross(from, to)); }

/* By how much the rotation moves the end of a lever arm. */
static Vec2 moved_by(Vec2 turn, Vec2 arm) {
    return vec2_sub(vec2(turn.x * arm.x - turn.y * arm.y, turn.y * arm.x + turn.x * arm.y), arm);
}

/* Unlike fminf(), which is a call. */
static float smaller(float x, float y) { return x < y ? x : y; }

static float smallest_half(const Box *a, const Box *b) {
    return smaller(smaller(a->half.x, a->half.y), smaller(b->half.x, b->half.y));
}

static float radius(const Box *box) { return sqrtf(vec2_dot(box->half, box->half)); }

/* The gap at which boxes touch, and the step between two that is none, of half of the smallest side. At 1 m that is the
   overlap that contacts leave, CONTACT_SLOP, by which sweeps that end early let neighbours sink unequally. */
static const float gap_share = 0.02f;

static const float mended_slop =
    0.005f; /* m, the least; that of Box2D v3. With none, what sweeps leave shakes stacks */

static const float least_cosine = 0.98f; /* of the angle up to which directions count as one, as in Box2D */

/* Adds the arbiter of the last step with the points that it had; false if it must be found again. A single point is: a
   corner that another may soon join. */
static bool keep_arbiter(ContactSet *set, const ContactSet *last, const Arbiter *old, const Box *boxes, float keep) {
    if (old->count < 2) return false;
    const Box *a = &boxes[old->a], *b = &boxes[old->b];
    const Vec2 shift = vec2_sub(vec2_sub(b->position, a->position), old->found.between);
    const Vec2 turn_a = turn_from(old->found.axis_a, a->rotation.column1);
    const Vec2 turn_b = turn_from(old->found.axis_b, b->rotation.column1);
    const Vec2 normal = last->contacts[old->first].normal;
    const float most = keep * 2.0f * smallest_half(a, b), reach = smaller(radius(a), radius(b));
    const float drift = fabsf(vec2_cross(shift, normal)) + reach * fabsf(vec2_cross(turn_a, turn_b));
    if (!(turn_a.x > least_cosine && turn_b.x > least_cosine && drift < most && vec2_dot(shift, normal) < most))
        return false;

    Arbiter *arbiter = &set->arbiters[set->arbiter_count++];
    *arbiter = *old;
    arbiter->first = set->contact_count;
    for (int k = 0; k < old->count; k++) {
        ContactPoint *contact = &set->contacts[set->contact_count++];
        *contact = last->contacts[old->first + k];
        const Vec2 apart = vec2_sub(moved_by(turn_b, contact->arm_b), moved_by(turn_a, contact->arm_a));
        contact->position = vec2_add(a->position, contact->arm_a);
        contact->separation = old->found.separation[k] + vec2_dot(vec2_add(shift, apart), contact->normal);
        contact->warm_normal = contact->warm_tangent = 0;
    }
    return true;
}

static bool before(int a, int b, int of_a, int of_b) { return a < of_a || (a == of_a && b < of_b); }

/* Ghosts at seams. A box that slides from a tile onto the next overlaps this one along the way by less, at first, than
   it has sunk into both. So separating axes find the side of the tile, which stops the box, although the tile before
   covers it. A box that has not sunk at all is not stopped, because its overlap of such a side is empty: so converged
   steps, which start on the floor, slide over seams, and others do not.

   Here the pair takes the faces across instead, if a support, which is another pair of one of the two boxes with that
   normal, is beside it and the box overlaps the tile no deeper than it overlaps the support, up to the gap at which
   boxes touch: then the tile does not stick out. Jolt Physics drops such contacts, too, of the triangles of a mesh
   ("enhanced internal edge removal"). */

/* For each body a list of its arbiters: heads [bodies], then for each arbiter the next one of a and of b; -1 ends it.
   An entry is 2 * arbiter + (0: the body is a, 1: it is b). */
static bool list_partners(ContactSet *set, int body_count) {
    const size_t size = (size_t)body_count + 2 * (size_t)set->arbiter_count;
    if (!array_reserve((void **)&set->partners, &set->partner_capacity, size, sizeof *set->partners)) return false;
    int *next = set->partners + body_count;
    for (int i = 0; i < body_count; i++) set->partners[i] = -1;
    for (int i = set->arbiter_count - 1; i >= 0; i--) {
        const int bodies[] = {set->arbiters[i].a, set->arbiters[i].b};
        for (int side = 0; side < 2; side++) {
            next[2 * i + side] = set->partners[bodies[side]];
            set->partners[bodies[side]] = 2 * i + side;
        }
    }
    return true;
}

/* A pair that may touch at a side that is covered. */
typedef struct Side {
    int arbiter;
    float least;     /* m, half of the smallest side of both boxes */
    Manifold across; /* its points by the faces across */
    float depth;     /* m, along them */
} Side;

/* Whether the tile does not stick out of the support, compared where their points are nearest. A box that only just
   touches the tile has no point across. */
static bool is_flush(const Side *side, const ContactSet *set, const Arbiter *support) {
    const float tolerance = gap_share * side->least;
    const ManifoldPoint touch = {set->contacts[set->arbiters[side->arbiter].first].position, -side->depth, 0};
    const ManifoldPoint *points = side->across.count > 0 ? side->across.points : &touch;
    const Vec2 tangent = vec2_cross_scalar(side->across.normal, 1.0f);
    float nearest = side->least, step = INFINITY;
    for (int i = 0; i < (side->across.count > 0 ? side->across.count : 1); i++)
        for (int k = support->first; k < support->first + support->count; k++) {
            const float way = fabsf(vec2_dot(tangent, vec2_sub(points[i].position, set->contacts[k].position)));
            if (way >= nearest) continue;
            nearest = way;
            step = set->contacts[k].separation - points[i].separation;
        }
    return step <= tolerance;
}

static bool is_covered(const Side *side, const ContactSet *set, int body_count) {
    const int bodies[] = {set->arbiters[side->arbiter].a, set->arbiters[side->arbiter].b};
    for (int end = 0; end < 2; end++)
        for (int i = set->partners[bodies[end]]; i >= 0; i = set->partners[body_count + i]) {
            const Arbiter *support = &set->arbiters[i / 2];
            if (i / 2 == side->arbiter || support->count == 0) continue;
            const float cosine = vec2_dot(set->contacts[support->first].normal, side->across.normal);
            if ((i % 2 == end ? cosine : -cosine) > least_cosine && is_flush(side, set, support)) return true;
        }
    return false;
}

static bool mend_seams(ContactSet *set, const Box *boxes) {
    int body_count = 0; /* until partners are listed */
    for (int i = 0; i < set->arbiter_count; i++) {
        Arbiter *arbiter = &set->arbiters[i];
        if (!arbiter->narrow) continue;
        const Box *a = &boxes[arbiter->a], *b = &boxes[arbiter->b];
        Side side = {.arbiter = i, .least = smallest_half(a, b)};
        side.depth =
            -manifold_compute_across(&side.across, a, b, gap_share * side.least, set->contacts[arbiter->first].normal);
        if (!(side.depth < side.least)) continue; /* the box is on the tile more than in it */
        if (body_count == 0) {
            for (int k = 0; k < set->arbiter_count; k++)
                if (set->arbiters[k].b >= body_count) body_count = set->arbiters[k].b + 1;
            if (!list_partners(set, body_count)) return false;
        }
        if (!is_covered(&side, set, body_count)) continue;
        /* Its points are replaced, and those behind them move. */
        const int first = arbiter->first, end = first + arbiter->count, more = side.across.count - arbiter->count;
        memmove(&set->contacts[end + more], &set->contacts[end],
                (size_t)(set->contact_count - end) * sizeof *set->contacts);
        for (int k = i + 1; k < set->arbiter_count; k++) set->arbiters[k].first += more;
        set->contact_count += more;
        write_arbiter(set, arbiter, (BodyPair){arbiter->a, arbiter->b}, first, &side.across, arbiter->rest, boxes);
    }
    return true;
}

Bounds contact_bounds(const Box *box, ContactRules rules) {
    Bounds bounds = bounds_of_box(box);
    if (!rules.mend) return bounds;
    const float reach = 0.5f * gap_share * smallest_half(box, box);
    bounds.low = vec2_sub(bounds.low, vec2(reach, reach));
    bounds.high = vec2_add(bounds.high, vec2(reach, reach));
    return bounds;
}

/* Adds the arbiter of a pair, if it touches. old: that of the last step, or NULL.

   Box2D-Lite's contacts are left with the slop, or they would be lost whenever boxes part a little. Mended ones are not
   lost, and are left with the overlap with which the boxes met, if that is less. So boxes that are put on one another
   stay where they are, and what leans is pushed back before it has sunk on one side by the slop. */
static void find_arbiter(ContactSet *set, BodyPair pair, const Box *boxes, bool mend, const Arbiter *old,
                         const ContactSet *last) {
    const Box *a = &boxes[pair.a], *b = &boxes[pair.b];
    const float least = smallest_half(a, b);
    Manifold manifold;
    if (mend)
        manifold_compute_within(&manifold, a, b, gap_share * least,
                                old != NULL ? &last->contacts[old->first].normal : NULL);
    else
        manifold_compute(&manifold, a, b);
    if (manifold.count == 0) return;
    float rest = !mend ? CONTACT_SLOP : old != NULL ? old->rest : mended_slop;
    for (int k = 0; mend && old == NULL && k < manifold.count; k++) rest = fmaxf(rest, -manifold.points[k].separation);
    rest = smaller(rest, CONTACT_SLOP);
    Arbiter *arbiter = &set->arbiters[set->arbiter_count++];
    write_arbiter(set, arbiter, pair, set->contact_count, &manifold, rest, boxes);
    /* Whether the way along which they touch is short beside their sides, as a covered side is touched. */
    arbiter->narrow = mend;
    if (manifold.count == 2) {
        const Vec2 way = vec2_sub(manifold.points[1].position, manifold.points[0].position);
        arbiter->narrow = mend && vec2_dot(way, way) < least * least;
    }
    set->contact_count += manifold.count;
}

bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes, const ContactSet *last,
                         ContactRules rules) {
    const Arbiter *old = last->arbiters, *end = old + (rules.keep > 0 || rules.mend ? last->arbiter_count : 0);
    const BodyPair *pair = pairs->pairs, *pairs_end = pair + pairs->count;
    set->arbiter_count = set->contact_count = 0;
    if (!reserve(set, pairs->count + (size_t)(end - old))) return false;
    /* Both lists rise by (a, b). */
    while (pair < pairs_end || old < end) {
        const bool is_old = old < end && (pair == pairs_end || !before(pair->a, pair->b, old->a, old->b));
        const bool may_touch = !is_old || (pair < pairs_end && pair->a == old->a && pair->b == old->b);
        if (!(is_old && rules.keep > 0 && keep_arbiter(set, last, old, boxes, rules.keep)) && may_touch)
            find_arbiter(set, *pair, boxes, rules.mend, is_old && old->count > 0 ? old : NULL, last);
        old += is_old;
        pair += may_touch;
    }
    return !rules.mend || mend_seams(set, boxes);
}

static void match_features(ContactSet *set, const Arbiter *arbiter, const ContactSet *last, const Arbiter *old) {
    for (int k = arbiter->first; k < arbiter->first + arbiter->count; k++)
        for (int j = old->first; j < old->first + old->count && set->before[k] < 0; j++)
            if (last->contacts[j].feature == set->contacts[k].feature) set->before[k] = j;
}

/* By how much a point has moved over both boxes. */
static float moved_over_boxes(const ContactPoint *now, const ContactPoint *then) {
    const Vec2 over_a = vec2_sub(now->arm_a, then->arm_a), over_b = vec2_sub(now->arm_b, then->arm_b);
    return sqrtf(vec2_dot(over_a, over_a)) + sqrtf(vec2_dot(over_b, over_b));
}

/* Of the points now and then, the two that are nearest are the same point; so are the other two. Feature ids cannot
   tell: where corners meet corners, as between the bricks of a wall, rounding decides in each step which edges make a
   point. */
static void match_places(ContactSet *set, const Arbiter *arbiter, const ContactSet *last, const Arbiter *old) {
    if (old->count == 0 ||
        vec2_dot(set->contacts[arbiter->first].normal, last->contacts[old->first].normal) <= least_cosine)
        return;
    int now = 0, then = 0;
    float least = INFINITY;
    for (int k = 0; k < arbiter->count; k++)
        for (int j = 0; j < old->count; j++) {
            const float moved = moved_over_boxes(&set->contacts[arbiter->first + k], &last->contacts[old->first + j]);
            if (moved < least) now = k, then = j, least = moved;
        }
    set->before[arbiter->first + now] = old->first + then;
    if (arbiter->count == 2 && old->count == 2) set->before[arbiter->first + 1 - now] = old->first + 1 - then;
}

void contact_set_match(ContactSet *set, const ContactSet *last, ContactRules rules, bool warm_starting) {
    const Arbiter *old = last->arbiters, *end = old + last->arbiter_count;
    for (int i = 0; i < set->contact_count; i++) set->before[i] = -1;
    for (int i = 0; i < set->arbiter_count; i++) {
        const Arbiter *arbiter = &set->arbiters[i];
        while (old < end && before(old->a, old->b, arbiter->a, arbiter->b)) old++;
        if (old == end) return;
        if (arbiter->count == 0 || before(arbiter->a, arbiter->b, old->a, old->b)) continue;
        (rules.mend ? match_places : match_features)(set, arbiter, last, old);
        for (int k = arbiter->first; warm_starting && k < arbiter->first + arbiter->count; k++) {
            if (set->before[k] < 0) continue;
            set->contacts[k].warm_normal = last->impulses[set->before[k]].normal;
            set->contacts[k].warm_tangent = last->impulses[set->before[k]].tangent;
        }
    }
}

void contact_set_forget(ContactSet *set, int body) {
    for (int i = 0; i < set->arbiter_count; i++)
        if (set->arbiters[i].a == body || set->arbiters[i].b == body) set->arbiters[i].count = 0;
}

/* The effective mass of a contact along the unit vector `axis`. */
static float effective_mass(const ProblemBody *a, const ProblemBody *b, Vec2 arm_a, Vec2 arm_b, Vec2 axis) {
    float along_a = vec2_dot(arm_a, axis), along_b = vec2_dot(arm_b, axis);
    float inverse = a->inv_mass + b->inv_mass;
    inverse += a->inv_inertia * (vec2_dot(arm_a, arm_a) - along_a * along_a) +
               b->inv_inertia * (vec2_dot(arm_b, arm_b) - along_b * along_b);
    return 1.0f / inverse;
}

/* Only overlap beyond `rest` is corrected; otherwise resting contacts jitter between touching and apart
   (Catto 2006). */
static float correction(float separation, float rest, float inverse_dt) {
    const float bias_factor = 0.2f;
    float depth = separation + rest;
    return -bias_factor * inverse_dt * (depth < 0.0f ? depth : 0.0f);
}

/* m, what rounding may do to the distance between two boxes there: two units in the last place of the larger
   coordinate. Most contacts overlap, and need not be compared with it. */
static float rounding(Vec2 position) { return 0x1p-22f * fmaxf(fabsf(position.x), fabsf(position.y)); }

void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction) {
    float inverse_dt = 1.0f / dt;
    for (int i = 0; i < set->arbiter_count; i++) {
        const Arbiter *arbiter = &set->arbiters[i];
        for (int k = arbiter->first; k < arbiter->first + arbiter->count; k++) {
            ContactPoint *contact = &set->contacts[k];
            const ProblemBody *a = &bodies[contact->a], *b = &bodies[contact->b];
            contact->mass_normal = effective_mass(a, b, contact->arm_a, contact->arm_b, contact->normal);
            Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
            contact->mass_tangent = effective_mass(a, b, contact->arm_a, contact->arm_b, tangent);
            contact->bias = position_correction ? correction(contact->separation, arbiter->rest, inverse_dt) : 0;
            if (contact->separation > 0 && contact->separation > rounding(contact->position))
                contact->bias = -contact->separation * inverse_dt;
            contact->friction = sqrtf(friction[contact->a] * friction[contact->b]);
        }
    }
}

void contact_solution_begin(const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
}
