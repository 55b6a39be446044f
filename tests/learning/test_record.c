/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is recorded, for each target: laws that tie them together. */
#include "made.h"

#include "learning/dataset.h"
#include "methods/reference.h"

static const char *const single[] = {SOURCE_DIR "/scenes/single.yaml"};
static const char *const both[] = {SOURCE_DIR "/scenes/single.yaml", SOURCE_DIR "/scenes/stack.yaml"};

static Dataset *record(DatasetOptions options) {
    Error error = {0};
    if (options.scenes == NULL) {
        options.scenes = single;
        options.scene_count = 1;
    }
    if (options.random == 0) assert_true(parse_range("-5:5:2.5", 10, &options.bomb_x));
    Dataset *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    return dataset;
}

/* The visits of a pair in all sweeps of a step, and its warm start, are what its impulses changed in the step. */
TEST(visits_add_up_to_the_pairs_change) {
    OWN(Dataset) *pair = record((DatasetOptions){.target = TARGET_PAIR});
    OWN(Dataset) *visits = record((DatasetOptions){.target = TARGET_IMPULSE});
    assert_true(visits->rows == 10 * pair->rows);
    int first_touches = 0;
    for (int64_t r = 0, v = 0; r < pair->rows; r++) {
        bool fresh = r == 0 || pair->launch[r] != pair->launch[r - 1] || pair->frame[r] > pair->frame[r - 1] + 1;
        int pairs_in_step = 0;
        while (r + pairs_in_step < pair->rows && pair->launch[r + pairs_in_step] == pair->launch[r] &&
               pair->frame[r + pairs_in_step] == pair->frame[r])
            pairs_in_step++;
        /* The first contact of all: one pair, and no warm start. */
        if (fresh && pairs_in_step == 1) {
            double sum = 0;
            for (int sweep = 0; sweep < 10; sweep++) sum += visits->changes[(v + sweep) * PAIR_CHANGES + 4];
            assert_near(sum, pair->changes[r * PAIR_CHANGES + 4], 1e-4);
            first_touches++;
        }
        for (int i = 1; i < pairs_in_step; i++) r++;
        v += 10 * pairs_in_step;
    }
    assert_true(first_touches >= 5);
}

/* Rows of a thinned launch are every third of the whole one, and not the first of each: the first blow of a launch is
   in a third of them. */
TEST(thinned_rows_are_rows_of_the_whole) {
    OWN(Dataset) *all = record((DatasetOptions){.target = TARGET_IMPULSE, .view = PAIR_CONTACT});
    OWN(Dataset) *some = record((DatasetOptions){.target = TARGET_IMPULSE, .view = PAIR_CONTACT, .every = 3});
    const size_t in = 20 * sizeof(float), out = PAIR_CHANGES * sizeof(float);
    int64_t row = 0, first = 0;
    for (int64_t i = 0; i < all->rows; i++) {
        if (i > 0 && all->launch[i] != all->launch[i - 1]) first = i;
        if ((i - first) % 3 != all->launch[i] % 3) continue;
        assert_true(row < some->rows);
        assert_int_equal(some->launch[row], all->launch[i]);
        assert_int_equal(some->frame[row], all->frame[i]);
        assert_memory_equal(some->inputs + 20 * row, all->inputs + 20 * i, in);
        assert_memory_equal(some->changes + PAIR_CHANGES * row, all->changes + PAIR_CHANGES * i, out);
        row++;
    }
    assert_true(row == some->rows && row > 100);
}

/* Where a body is in one pair only, what all impulses changed of it is what that pair's did. */
TEST(net_is_pair_where_there_is_one_pair) {
    OWN(Dataset) *pair = record((DatasetOptions){.target = TARGET_PAIR});
    OWN(Dataset) *net = record((DatasetOptions){.target = TARGET_NET});
    assert_true(pair->rows == net->rows);
    int compared = 0, different = 0;
    for (int64_t r = 0; r < pair->rows; r++) {
        bool before = r > 0 && pair->frame[r - 1] == pair->frame[r];
        bool after = r + 1 < pair->rows && pair->frame[r + 1] == pair->frame[r];
        for (int k = 0; k < PAIR_CHANGES; k++) {
            double gap = fabs((double)pair->changes[r * PAIR_CHANGES + k] - (double)net->changes[r * PAIR_CHANGES + k]);
            if (before || after)
                different += gap > 0.01;
            else
                assert_true(gap < 1e-3);
        }
        compared += !before && !after;
    }
    assert_true(compared > 100 && different > 10);
}

/* At rest the engine has converged and equals the reference; at impacts it does not. */
TEST(the_reference_labels_what_the_engine_met) {
    OWN(Dataset) *engine = record((DatasetOptions){.scenes = both, .scene_count = 2, .target = TARGET_NET});
    OWN(Dataset) *reference = record(
        (DatasetOptions){.scenes = both, .scene_count = 2, .target = TARGET_NET, .labels = DATASET_BY_REFERENCE});
    assert_true(engine->rows == reference->rows);
    int64_t near = 0, far = 0;
    for (int64_t r = 0; r < engine->rows; r++) {
        float gap = fabsf(engine->changes[r * PAIR_CHANGES + 4] - reference->changes[r * PAIR_CHANGES + 4]);
        near += gap < 1e-3f;
        far += gap > 0.5f;
    }
    assert_true(near > engine->rows / 2);
    assert_true(far > 10);
    assert_memory_equal(engine->inputs, reference->inputs, (size_t)engine->rows * PAIR_INPUTS * sizeof(float));
}

typedef struct Steps {
    Reference reference;
    bool touching[61], unsolved[61]; /* of a launch, by frame */
} Steps;

static bool solve_again(void *context, int frame, const World *world, Error *error) {
    Steps *steps = context;
    const ContactProblem *problem = world_problem(world);
    if (!reference_solve(&steps->reference, problem, NULL, error)) return false;
    steps->touching[frame] = problem->contact_count > 0;
    steps->unsolved[frame] = steps->reference.residual > 1e-9;
    return true;
}

TEST(steps_without_a_solution_have_no_rows_and_are_counted) {
    const char *path = SOURCE_DIR "/tests/methods/scenes/wedge_launches.yaml";
    DatasetOptions options = {.scenes = &path, .scene_count = 1, .target = TARGET_NET, .labels = DATASET_BY_REFERENCE};
    assert_true(parse_range("20:40:4", 10, &options.bomb_x));
    OWN(Dataset) *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    OWN(Scene) *scene = scene_from(path);
    const Method engine = method_named("engine");
    int64_t unsolved = 0, row = 0;
    for (int launch = 0; launch < dataset->launches; launch++) {
        Steps steps = {.reference = {0}};
        Launch own = launch_of(scene);
        own.x = dataset->launch_x[launch];
        own.rotation = dataset->launch_rotation[launch];
        own.spin = dataset->launch_spin[launch];
        const Scene launched = launch_scene(scene, &own);
        assert_ok(simulate_observed(&launched, &engine, &(StepObserver){solve_again, &steps}, &error), error);
        for (int frame = 1; frame <= 60; frame++) {
            const int64_t first = row;
            while (row < dataset->rows && dataset->launch[row] == launch && dataset->frame[row] == frame) row++;
            assert_true((row > first) == (steps.touching[frame] && !steps.unsolved[frame]));
            unsolved += steps.unsolved[frame];
        }
        reference_free(&steps.reference);
    }
    assert_int_equal(row, dataset->rows);
    assert_true(unsolved > 6 * 10);
    assert_int_equal(dataset->unconverged, unsolved);
}

/* The ground is static, the box has 200 kg, the bomb 50. What an impulse at the middle of the points does to a body is
   what it did, but for how it was shared among the points. */
TEST(contexts_tell_what_made_the_changes) {
    OWN(Dataset) *plain = record((DatasetOptions){0}), *dataset = record((DatasetOptions){.context = true});
    assert_null(plain->context);
    assert_non_null(dataset->context);
    assert_memory_equal(plain->changes, dataset->changes, (size_t)plain->rows * PAIR_CHANGES * sizeof(float));
    static const float inverse_masses[] = {0, 1.0f / 200, 1.0f / 50};
    int struck = 0;
    for (int64_t r = 0; r < dataset->rows; r++) {
        const float *context = dataset->context + r * PAIR_CONTEXT, *inputs = dataset->inputs + r * PAIR_INPUTS;
        const float *change = dataset->changes + r * PAIR_CHANGES;
        assert_null(pair_context_fault(context));
        assert_near(context[CONTEXT_INV_MASS_A], inverse_masses[dataset->bodies[2 * r]], 1e-7);
        assert_near(context[CONTEXT_INV_MASS_B], inverse_masses[dataset->bodies[2 * r + 1]], 1e-7);
        /* Velocities as the relative view has them: vxa vya vxb vyb wa wb. */
        static const int place[] = {2, 3, 6, 4, 5, 7};
        for (int k = 0; k < PAIR_CHANGES; k++) assert_true(context[CONTEXT_VELOCITIES + k] == inputs[place[k]]);
        /* Both arms end in the same point. */
        for (int i = 0; i < 2; i++)
            assert_near(context[CONTEXT_ARM_A + i], inputs[i] + context[CONTEXT_ARM_B + i], 0.05);
        if (context[CONTEXT_INV_MASS_A] == 0) continue;
        for (int i = 0; i < 2; i++)
            assert_near(change[i] / context[CONTEXT_INV_MASS_A], -change[3 + i] / context[CONTEXT_INV_MASS_B], 0.01);
        struck++;
    }
    assert_true(struck > 5);
}

TEST(random_launches_lie_in_their_ranges) {
    OWN(Dataset) *a = record((DatasetOptions){.random = 50, .seed = 3}),
                 *b = record((DatasetOptions){.random = 50, .seed = 3});
    OWN(Dataset) *c = record((DatasetOptions){.random = 50, .seed = 4});
    float least = 0, most = 0;
    for (int i = 0; i < 50; i++) {
        assert_true(fabsf(a->launch_x[i]) <= 15 && fabsf(a->launch_rotation[i]) <= 1.5f &&
                    fabsf(a->launch_spin[i]) <= 20);
        least = fminf(least, a->launch_x[i]);
        most = fmaxf(most, a->launch_x[i]);
    }
    assert_true(least < -10 && most > 10);
    assert_memory_equal(a->launch_x, b->launch_x, 50 * sizeof(float));
    assert_memory_equal(a->changes, b->changes, (size_t)a->rows * PAIR_CHANGES * sizeof(float));
    assert_memory_not_equal(a->launch_x, c->launch_x, 50 * sizeof(float));
}

/* Whether the pair of this row is one with the ground, and the two boxes of single.yaml do not touch in its step. */
static bool is_on_the_ground_alone(const Dataset *dataset, int64_t row) {
    for (int64_t r = row > 2 ? row - 2 : 0; r < dataset->rows && r <= row + 2; r++)
        if (dataset->launch[r] == dataset->launch[row] && dataset->frame[r] == dataset->frame[row] &&
            dataset->bodies[2 * r] != 0)
            return false;
    return dataset->bodies[2 * row] == 0;
}

/* At the end of the run: what the warm start brings is what gravity takes, g dt of both points together, so that
   nothing approaches and next to nothing is left to do. */
TEST(a_box_at_rest_shows_its_warm_start) {
    enum { WIDTH = 20, POINT = 9 }; /* numbers of a point: vn vt bias pn pt and arms */
    OWN(Dataset) *dataset = record((DatasetOptions){.view = PAIR_CONTACT, .target = TARGET_POINTS});
    assert_int_equal(dataset_inputs(dataset), WIDTH);
    int at_rest = 0;
    for (int64_t r = 0; r < dataset->rows; r++) {
        const float *in = dataset->inputs + r * WIDTH, *changes = dataset->changes + r * PAIR_POINT_CHANGES;
        const bool flat = in[WIDTH - 1] == 1;
        if (dataset->frame[r] < 200 || !flat || !is_on_the_ground_alone(dataset, r)) continue;
        assert_near(in[WIDTH - 2], 0, 0); /* the ground has no inverse mass */
        assert_near(in[3] + in[POINT + 3], 10.0 / 60, 1e-5);
        assert_near(in[0], in[2], 1e-5);
        assert_near(in[POINT], in[POINT + 2], 1e-5);
        for (int k = 0; k < PAIR_POINT_CHANGES; k++) assert_near(changes[k], 0, 1e-5);
        at_rest++;
    }
    assert_true(at_rest > 500);
}

/* The neighbours' view is the contact's, and twelve numbers more, of which six are 0 where there are no neighbours. */
TEST(neighbours_are_seen_beside_the_contact) {
    OWN(Dataset) *contact = record((DatasetOptions){.view = PAIR_CONTACT, .target = TARGET_NET});
    OWN(Dataset) *wide = record((DatasetOptions){.view = PAIR_NEIGHBOURS, .target = TARGET_NET});
    assert_true(contact->rows == wide->rows && dataset_inputs(wide) == 32);
    int pushed = 0, alone = 0;
    for (int64_t r = 0; r < wide->rows; r++) {
        const float *next = wide->inputs + r * 32 + 20;
        assert_memory_equal(next - 20, contact->inputs + r * 20, 20 * sizeof(float));
        const bool neighbour = (r > 0 && wide->frame[r - 1] == wide->frame[r]) ||
                               (r + 1 < wide->rows && wide->frame[r + 1] == wide->frame[r]);
        double most = 0;
        for (int k = 0; k < 6; k++) most = fmax(most, fabs(next[k]));
        pushed += neighbour && most > 0.1;
        alone += !neighbour;
        assert_true(neighbour || most < 1e-5);
    }
    assert_true(pushed > 10 && alone > 100);
}

RUN_TESTS(NULL, NULL)
