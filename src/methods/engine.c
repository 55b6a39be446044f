/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The physics engine: sequential impulses (projected Gauss-Seidel) with warm starting, as in Box2D-Lite.

   Each sweep visits every contact in turn: first the normal impulse that brings the normal velocity to its bias,
   clamped so that the accumulated impulse is not negative; then the tangent impulse that stops the sliding, clamped so
   that the accumulated impulse stays in the friction cone |Pt| <= mu Pn:

       Pn' = max(Pn + mass_n (bias - vn), 0),   Pt' = clamp(Pt - mass_t vt, -mu Pn', mu Pn')

   Accumulated impulses start from the last step's (warm start). Source: Catto, "Iterative Dynamics with Temporal
   Coherence" (2005); "Fast and Simple Physics using Sequential Impulses" (GDC 2006). Fails by slow convergence: against
   the order of visits an impulse propagates by one contact per sweep, so high stacks and heavy boxes on light ones stay
   soft.

   The engine also has Box2D-Lite's contacts, bit for bit, and so fails where they do: a box that slides over flush
   tiles catches at seams once it has sunk a little, and thin plates that lie on one another change places. With `keep`,
   and in other methods, contacts are mended (ContactRules).

   A visit is here twice, with the same operations in the same order, so the same bits: of a contact of the problem, the
   scalar reference implementation; and of a packed pair (methods/sweeps.h), which sweeps one by one use.
   sweeps_lanes.c has it once more, for many pairs at once. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <stdlib.h>
#include <string.h>

/* One visit of a contact of the problem: the normal impulse, then friction. */
static void solve_contact(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                          ContactImpulse *sum, bool accumulate) {
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];

    const float normal_velocity = vec2_dot(contact_relative_velocity(a, b, contact), contact->normal);
    const float pushed = accumulate ? sum->normal : 0.0f;
    float total = pushed + contact->mass_normal * (contact->bias - normal_velocity);
    total = total > 0.0f ? total : 0.0f;
    const float normal = total - pushed;
    sum->normal = accumulate ? total : sum->normal + normal;
    contact_apply(a, b, contact, bodies, vec2_scale(normal, contact->normal));

    const Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    const float tangent_velocity = vec2_dot(contact_relative_velocity(a, b, contact), direction);
    const float dragged = accumulate ? sum->tangent : 0.0f;
    const float limit = contact->friction * (accumulate ? sum->normal : normal);
    total = contact_clamp(dragged - contact->mass_tangent * tangent_velocity, -limit, limit);
    const float tangent = total - dragged;
    sum->tangent = accumulate ? total : sum->tangent + tangent;
    contact_apply(a, b, contact, bodies, vec2_scale(tangent, direction));
}

void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    contact_solution_begin(problem, solution);
    for (int i = 0; options->accumulate && i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        solution->impulses[i] =
            (ContactImpulse){options->warm ? contact->warm_normal : 0.0f, options->warm ? contact->warm_tangent : 0.0f};
        contact_push(solution->velocities, contact, problem->bodies, solution->impulses[i]);
    }
}

void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution) {
    for (int i = first; i < first + count; i++)
        solve_contact(&problem->contacts[i], problem->bodies, solution->velocities, &solution->impulses[i],
                      options->accumulate);
}

void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    sequential_impulses_visit(problem, options, 0, problem->contact_count, solution);
}

void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution) {
    sequential_impulses_begin(problem, options, solution);
    for (int sweep = 0; sweep < count; sweep++) sequential_impulses_sweep(problem, options, solution);
}

/* Sweeps over packed pairs, one by one: for few contacts, and for every processor. */

static Vec2 relative_velocity(const SweepBody *a, const SweepBody *b, const SweepPoint *point) {
    return vec2(((b->x - b->spin * point->arm_b.y) - a->x) + a->spin * point->arm_a.y,
                ((b->y + b->spin * point->arm_b.x) - a->y) - a->spin * point->arm_a.x);
}

static void apply(SweepBody *a, SweepBody *b, const SweepPair *pair, const SweepPoint *point, Vec2 impulse) {
    a->x -= a->inv_mass * impulse.x;
    a->y -= a->inv_mass * impulse.y;
    a->spin -= pair->inv_inertia_a * vec2_cross(point->arm_a, impulse);
    b->x += b->inv_mass * impulse.x;
    b->y += b->inv_mass * impulse.y;
    b->spin += pair->points[0].extra * vec2_cross(point->arm_b, impulse);
}

/* One visit of a point of a pair: the normal impulse, then friction. */
static void solve_point(SweepBody *a, SweepBody *b, const SweepPair *pair, const SweepPoint *point,
                        ContactImpulse *sum) {
    float normal_velocity = vec2_dot(relative_velocity(a, b, point), pair->normal);
    float total = sum->normal + point->mass_normal * (point->bias - normal_velocity);
    total = total > 0.0f ? total : 0.0f;
    float normal = total - sum->normal;
    sum->normal = total;
    apply(a, b, pair, point, vec2_scale(normal, pair->normal));

    Vec2 direction = vec2_cross_scalar(pair->normal, 1.0f);
    float tangent_velocity = vec2_dot(relative_velocity(a, b, point), direction);
    float limit = pair->friction * sum->normal;
    total = sum->tangent - point->mass_tangent * tangent_velocity;
    total = total < limit ? total : limit;
    total = -limit > total ? -limit : total;
    float tangent = total - sum->tangent;
    sum->tangent = total;
    apply(a, b, pair, point, vec2_scale(tangent, direction));
}

static void push_pair(Sweeps *sweeps, int i, const ContactImpulse impulses[2]) {
    const SweepPair *pair = &sweeps->pairs[i];
    SweepEnds ends = sweeps->ends[i];
    SweepBody a = sweeps->bodies[sweep_body_at(ends.a)], b = sweeps->bodies[sweep_body_at(ends.b)];
    const Vec2 tangent = vec2_cross_scalar(pair->normal, 1.0f);
    for (int k = 0; k < sweep_pair_points(pair); k++) {
        const Vec2 along = vec2_scale(impulses[k].tangent, tangent);
        apply(&a, &b, pair, &pair->points[k], vec2_add(vec2_scale(impulses[k].normal, pair->normal), along));
    }
    if (ends.a >= 0) sweeps->bodies[ends.a] = a;
    if (ends.b >= 0) sweeps->bodies[ends.b] = b;
}

void sweeps_push_sums(Sweeps *sweeps, const bool *chosen) {
    for (int i = 0; i < sweeps->pair_count; i++)
        if (chosen == NULL || chosen[sweeps->group[i]]) push_pair(sweeps, i, sweeps->pairs[i].sums);
}

void sweeps_push(Sweeps *sweeps, const ContactImpulse *impulses) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        SweepPair *pair = &sweeps->pairs[i];
        const ContactImpulse *by = &impulses[sweeps->first[i]];
        push_pair(sweeps, i, by);
        for (int k = 0; k < sweep_pair_points(pair); k++) {
            pair->sums[k].normal += by[k].normal;
            pair->sums[k].tangent += by[k].tangent;
        }
    }
}

/* Not 0 if the bits differ; those of 0 and -0 do. */
static uint32_t difference(float x, float y) {
    uint32_t bits_x, bits_y;
    memcpy(&bits_x, &x, sizeof x);
    memcpy(&bits_y, &y, sizeof y);
    return bits_x ^ bits_y;
}

/* Stores a body's velocity; returns not 0 if it has changed. By components, because the next visit reads components. */
static uint32_t put_back(SweepBody *body, const SweepBody *after) {
    uint32_t changed =
        difference(body->x, after->x) | difference(body->y, after->y) | difference(body->spin, after->spin);
    body->x = after->x;
    body->y = after->y;
    body->spin = after->spin;
    return changed;
}

/* Visits the points of a pair. Not 0 if that changed anything. */
static inline uint32_t visit(SweepBody *bodies, const SweepPair *pair, ContactImpulse *sums, SweepEnds ends) {
    SweepBody *body_a = &bodies[sweep_body_at(ends.a)], *body_b = &bodies[sweep_body_at(ends.b)];
    SweepBody a = *body_a, b = *body_b;
    uint32_t changed = 0;
    for (int k = 0; k < sweep_pair_points(pair); k++) {
        ContactImpulse sum = sums[k];
        solve_point(&a, &b, pair, &pair->points[k], &sum);
        changed |= difference(sums[k].normal, sum.normal) | difference(sums[k].tangent, sum.tangent);
        sums[k].normal = sum.normal;
        sums[k].tangent = sum.tangent;
    }
    if (ends.a >= 0) changed |= put_back(body_a, &a);
    if (ends.b >= 0) changed |= put_back(body_b, &b);
    return changed;
}

/* True for a pair whose last visit changed nothing, if no visit has changed its bodies since: it is skipped. */
static bool may_rest(const Sweeps *sweeps, int pair) {
    int64_t quiet = sweeps->quiet_since[pair];
    SweepEnds ends = sweeps->ends[pair];
    return quiet > sweeps->changed_at[sweep_body_at(ends.a)] && quiet > sweeps->changed_at[sweep_body_at(ends.b)];
}

/* Records the changes by visit number `now`. */
static bool note_visit(Sweeps *sweeps, int pair, bool changed, int64_t now) {
    SweepEnds ends = sweeps->ends[pair];
    sweeps->quiet_since[pair] = changed ? 0 : now;
    if (changed && ends.a >= 0) sweeps->changed_at[ends.a] = now;
    if (changed && ends.b >= 0) sweeps->changed_at[ends.b] = now;
    return changed;
}

/* Extrapolates `now` by the change since `before`; returns not 0 if the result differs from `now`. */
static uint32_t extrapolate(float *before, float now, float factor) {
    float next = now - (factor * (*before - now) + 0.0f);
    *before = next;
    return difference(next, now);
}

/* One sweep in the current half of bodies and sums; the other half has the results of the previous sweep.
   factors[groups]. True if it changed anything. */
static bool sweep_in_turn(Sweeps *sweeps, int half, const float *factors, int64_t *now) {
    SweepBody *halves[2] = {sweeps->bodies, sweeps->bodies + sweeps->body_count + 1};
    ContactImpulse *sums[2] = {sweeps->sums, sweeps->sums + 2 * (sweeps->pair_count + 1)};
    bool changed = false;
    /* The velocities of two sweeps ago are replaced by those that this sweep starts from; */
    ++*now;
    for (int i = 0; i < sweeps->body_count; i++) {
        SweepBody *to = &halves[half][i];
        const SweepBody *from = &halves[1 - half][i];
        const float factor = factors[sweeps->group_of_body[i]];
        if (extrapolate(&to->x, from->x, factor) | extrapolate(&to->y, from->y, factor) |
            extrapolate(&to->spin, from->spin, factor)) {
            sweeps->changed_at[i] = *now;
            changed = true;
        }
    }
    /* so are the sums, before each visit. */
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (may_rest(sweeps, i)) continue;
        const float factor = factors[sweeps->group[i]];
        uint32_t moved = 0;
        for (int k = 2 * i; k < 2 * i + 2; k++)
            moved |= extrapolate(&sums[half][k].normal, sums[1 - half][k].normal, factor) |
                     extrapolate(&sums[half][k].tangent, sums[1 - half][k].tangent, factor);
        moved |= visit(halves[half], &sweeps->pairs[i], &sums[half][2 * i], sweeps->ends[i]);
        changed |= note_visit(sweeps, i, moved != 0, ++*now);
    }
    return changed;
}

static bool sweep_in_place(Sweeps *sweeps, int64_t *now) {
    bool changed = false;
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (may_rest(sweeps, i)) continue;
        SweepPair *pair = &sweeps->pairs[i];
        changed |= note_visit(sweeps, i, visit(sweeps->bodies, pair, pair->sums, sweeps->ends[i]) != 0, ++*now);
    }
    return changed;
}

void sweeps_run_one_by_one(Sweeps *sweeps, const float *factors, int count) {
    memset(sweeps->quiet_since, 0, (size_t)sweeps->pair_count * sizeof *sweeps->quiet_since);
    memset(sweeps->changed_at, 0, (size_t)sweeps->body_count * sizeof *sweeps->changed_at);
    bool changed = true;
    int64_t now = 0;
    for (int sweep = 0; changed && sweep < count; sweep++)
        changed = factors != NULL ? sweep_in_turn(sweeps, sweep % 2, factors + sweep * sweeps->groups, &now)
                                  : sweep_in_place(sweeps, &now);
}

/* The method. */

typedef struct State {
    StoppingRule rule;
    SequentialOptions options;
    Sweeps sweeps;
} State;

static const SettingSpec settings[] = {
    SWEEPS_SETTING,
    {"accumulate", "on|off: clamp accumulated impulses, not each increment (default: the scene's, else on)",
     SETTING_BOOL(State, options.accumulate)},
    {"warm", "on|off: warm start from the previous step's impulses (default: on)", SETTING_BOOL(State, options.warm)},
    STOPPING_SETTINGS("sweeps"),
    KEEP_SETTING(SETTING_OWN),
    {0}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.rule.k = 10, .options = {.accumulate = true, .warm = true}};
    return stopping_make(chosen, settings, &standard, sizeof standard, "engine", error);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    const SequentialOptions *options = &solver->options;
    const StoppingRule *rule = &solver->rule;
    Sweeps *sweeps = &solver->sweeps;
    if (options->accumulate) {
        if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, options->warm)) return error_memory(error, "engine");
        sweeps->block = rule->more > 0 ? STOPPING_BLOCK : 0;
        bool swept = sweeps_run(sweeps, rule->k);
        for (int done = 0; swept && stopping_needs_more(rule, done, sweeps, problem); done += STOPPING_BLOCK)
            swept = sweeps_run(sweeps, STOPPING_BLOCK);
        if (!swept) return error_memory(error, "engine");
        if (sweeps_end(sweeps, solution)) return true;
    }
    /* Without accumulated impulses, and where a number is NaN or infinite. */
    sequential_impulses_solve(problem, options, rule->k, solution);
    for (int done = 0; stopping_needs_more_scalar(rule, done, problem, solution); done += STOPPING_BLOCK)
        for (int i = 0; i < STOPPING_BLOCK; i++) sequential_impulses_sweep(problem, options, solution);
    return true;
}

const ContactSolverKind solver_engine = {
    .description = {.name = "engine",
                    .summary = "sequential impulses with warm starting: the physics engine",
                    .caption = "physics engine, sequential impulses",
                    .settings = settings,
                    .baseline = true,
                    .converges = "k=20000,warm=off",
                    .lite_contacts = true,
                    .chart =
                        METHOD_RUNS("k=5", "", "k=50", "k=100", "k=1,near=0.1,more=10000", "k=1,near=0.001,more=10000"),
                    .chart_quick = METHOD_RUNS("k=4", "", "k=50"),
                    .stability = METHOD_RUNS("k=4", "", "k=50"),
                    .stability_place = 1},
    .create = create,
    .solve = solve,
    .destroy = destroy};
