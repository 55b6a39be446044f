/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slot_networks.h"

#include "python.h"

#include <math.h>

static SlotNetwork *example(void) {
    uint32_t seed = 1;
    SlotNetwork *network = make_slot_network(&five_shape, five_slots, &seed);
    network->gate = 0.1f;
    network->bomb_inv_mass = 0.02f;
    network->sweeps = 3;
    network->factors[0] = 0, network->factors[1] = 0.7f, network->factors[2] = 2;
    network->cap[2] = 0;
    strcpy(network->scene, "pyramid \xc3\xa4");
    strcpy(network->command, "twinbox train pyramid.yaml -o net.npz");
    return network;
}

static void assert_same_packed(const PackedRows *a, const PackedRows *b) {
    assert_true(a->count == b->count && a->width == b->width);
    assert_memory_equal(a->numbers, b->numbers, (size_t)a->count * (size_t)a->width);
    assert_memory_equal(a->units, b->units, (size_t)a->count * sizeof(float));
}

static void assert_same_projection(const Projection *a, const Projection *b) {
    assert_same_packed(&a->packed, &b->packed);
    assert_true(a->from == b->from && a->to == b->to);
    assert_memory_equal(a->rows, b->rows, (size_t)a->from * (size_t)a->to * sizeof(float));
    assert_memory_equal(a->centre, b->centre, (size_t)a->to * sizeof(float));
}

static void assert_same(const SlotNetwork *a, const SlotNetwork *b) {
    const size_t slots = (size_t)a->slot_count, bodies = (size_t)a->body_count;
    assert_true(a->body_count == b->body_count && a->bomb == b->bomb && a->slot_count == b->slot_count);
    assert_memory_equal(a->slots, b->slots, slots * sizeof *a->slots);
    assert_same_projection(&a->bomb_state, &b->bomb_state);
    assert_same_projection(&a->state, &b->state);
    assert_same_projection(&a->present, &b->present);
    assert_same_projection(&a->warm, &b->warm);
    assert_same_packed(&a->first.packed, &b->first.packed);
    assert_same_packed(&a->second.packed, &b->second.packed);
    assert_same_packed(&a->packed, &b->packed);
    assert_int_equal(a->parameter_count, b->parameter_count);
    assert_memory_equal(a->parameters, b->parameters, a->parameter_count * sizeof(float));
    assert_memory_equal(a->scale, b->scale, slots * sizeof(float));
    assert_memory_equal(a->cap, b->cap, slots * sizeof(float));
    assert_memory_equal(a->low, b->low, (size_t)slot_network_inputs(a) * sizeof(float));
    assert_memory_equal(a->high, b->high, (size_t)slot_network_inputs(a) * sizeof(float));
    assert_memory_equal(&a->bomb_inv_mass, &b->bomb_inv_mass, sizeof a->bomb_inv_mass);
    assert_memory_equal(&a->gate, &b->gate, sizeof a->gate);
    assert_int_equal(a->sweeps, b->sweeps);
    assert_memory_equal(a->factors, b->factors, sizeof a->factors);
    assert_string_equal(a->scene, b->scene);
    assert_string_equal(a->command, b->command);
    assert_memory_equal(a->pair_slots, b->pair_slots, (bodies * bodies + 1) * sizeof *a->pair_slots);
    assert_ptr_equal(a->kernels, b->kernels);
}

static SlotNetwork *written_and_read(const SlotNetwork *network) {
    Error error = {0};
    const char *path = temporary_path("net.npz");
    assert_ok(slot_network_write(network, path, &error), error);
    SlotNetwork *read = slot_network_read(path, &error);
    assert_ok(read != NULL, error);
    return read;
}

static void files_keep_every_bit(void **state) {
    (void)state;
    SlotNetwork *network = example();
    SlotNetwork *read = written_and_read(network);
    assert_same(read, network);
    slot_network_destroy(read);
    slot_network_destroy(network);
}

static void all_sweeps_or_none_are_kept(void **state) {
    (void)state;
    const int sweeps[] = {0, SLOT_SWEEPS_MAX};
    SlotNetwork *network = example();
    for (int i = 0; i < 2; i++) {
        network->sweeps = sweeps[i];
        for (int f = 0; f < SLOT_SWEEPS_MAX; f++) network->factors[f] = f < sweeps[i] ? 0.01f * (float)f : 0;
        SlotNetwork *read = written_and_read(network);
        assert_same(read, network);
        slot_network_destroy(read);
    }
    slot_network_destroy(network);
}

/* Numbers that rise through all of a matrix say where NumPy has each of them. */
static void numpy_sees_the_shapes(void **state) {
    (void)state;
    Error error = {0};
    SlotNetwork *network = example();
    for (int i = 0; i < 2 * FIVE_SLOTS * 64; i++) network->rows[i] = (float)i;
    for (int i = 0; i < 24 * 16; i++) network->state.rows[i] = (float)i;
    for (int i = 0; i < 112 * 64; i++) network->first.rows[i] = (float)i;
    const char *path = temporary_path("numpy.npz");
    assert_ok(slot_network_write(network, path, &error), error);
    slot_network_destroy(network);
    run_python("import sys, numpy as np\n"
               "f = np.load(sys.argv[1], allow_pickle=False)\n"
               "want = {'version': (), 'kind': (), 'scene': (), 'command': (), 'body_count': (), 'bomb': (),\n"
               "  'sweeps': (), 'slot_a': (9,), 'slot_b': (9,), 'slot_feature': (9,),\n"
               "  'bomb_state_rows': (6, 16), 'bomb_state_centre': (16,), 'state_rows': (24, 16),\n"
               "  'state_centre': (16,), 'present_rows': (9, 32), 'present_centre': (32,), 'warm_rows': (18, 48),\n"
               "  'warm_centre': (48,), 'first_rows': (112, 64), 'first_biases': (64,), 'second_rows': (64, 64),\n"
               "  'second_biases': (64,), 'last_rows': (18, 64), 'last_biases': (18,), 'scale': (9,), 'cap': (9,),\n"
               "  'low': (112,), 'high': (112,), 'gate': (), 'bomb_inv_mass': (),\n"
               "  'factors': (3,)}\n"
               "assert f.files == list(want), f.files\n"
               "kinds = dict(version='i', body_count='i', bomb='i', sweeps='i', slot_a='i', slot_b='i',\n"
               "  slot_feature='u', kind='U', scene='U', command='U')\n"
               "for name, shape in want.items():\n"
               "    assert f[name].shape == shape, (name, f[name].shape)\n"
               "    assert f[name].dtype.kind == kinds.get(name, 'f'), (name, f[name].dtype)\n"
               "assert (f['version'], f['kind'], f['body_count'], f['bomb']) == (2, 'scene-net', 5, 3)\n"
               "assert (f['sweeps'], f['gate'], f['scene']) == (3, np.float32(0.1), 'pyramid \\u00e4')\n"
               "assert f['command'] == 'twinbox train pyramid.yaml -o net.npz'\n"
               "slots = [tuple(map(int, s)) for s in zip(f['slot_a'], f['slot_b'], f['slot_feature'])]\n"
               "assert slots == [(0, 2, 7), (0, 2, 9), (0, 4, 0), (1, 2, 3), (1, 2, 4), (1, 2, 5),\n"
               "  (1, 2, 2**32 - 1), (2, 3, 1), (2, 4, 7)], slots\n"
               "for name in 'last_rows', 'state_rows', 'first_rows':\n"
               "    a = f[name]\n"
               "    assert (a == np.arange(a.size).reshape(a.shape)).all(), name\n"
               "assert (f['factors'] == np.array([0, 0.7, 2], 'f4')).all()\n",
               path);
}

static void numbers_out_of_range_are_refused(void **state) {
    (void)state;
    Error error = {0};
    SlotNetwork *network = example();
    const char *path = temporary_path("bad.npz");
    struct {
        float *number, bad;
        const char *text;
    } cases[] = {{&network->bomb_state.rows[11], NAN, "bomb_state_rows: number 11 is nan"},
                 {&network->bomb_state.centre[1], INFINITY, "bomb_state_centre: number 1 is inf"},
                 {&network->state.rows[0], -INFINITY, "state_rows: number 0 is -inf"},
                 {&network->state.centre[15], NAN, "state_centre: number 15"},
                 {&network->present.rows[287], NAN, "present_rows: number 287"},
                 {&network->present.centre[3], NAN, "present_centre: number 3"},
                 {&network->warm.rows[863], INFINITY, "warm_rows: number 863"},
                 {&network->warm.centre[47], NAN, "warm_centre: number 47"},
                 {&network->first.rows[7167], NAN, "first_rows: number 7167"},
                 {&network->first.biases[63], NAN, "first_biases: number 63"},
                 {&network->second.rows[4095], NAN, "second_rows: number 4095"},
                 {&network->second.biases[0], INFINITY, "second_biases: number 0"},
                 {&network->rows[1151], NAN, "last_rows: number 1151"},
                 {&network->biases[17], NAN, "last_biases: number 17"},
                 {&network->scale[8], NAN, "scale: number 8"},
                 {&network->scale[0], -1e-30f, "scale: number 0 is -1e-30; it must be finite and not negative"},
                 {&network->cap[5], -1, "cap: number 5 is -1"},
                 {&network->cap[5], INFINITY, "cap: number 5 is inf"},
                 {&network->low[111], NAN, "low: number 111 is nan"},
                 {&network->high[0], INFINITY, "high: number 0 is inf"},
                 {&network->bomb_inv_mass, -1, "bomb_inv_mass: number 0 is -1"},
                 {&network->gate, -0.5f, "gate: number 0 is -0.5"},
                 {&network->gate, NAN, "gate: number 0 is nan"},
                 {&network->factors[1], -0.1f, "factors: number 1 is -0.1; it must be from 0 to 2"},
                 {&network->factors[2], 2.1f, "factors: number 2 is 2.1"},
                 {&network->factors[0], NAN, "factors: number 0 is nan"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float kept = *cases[i].number;
        *cases[i].number = cases[i].bad;
        assert_ok(slot_network_write(network, path, &error), error);
        *cases[i].number = kept;
        assert_slot_network_refused(path, cases[i].text);
    }
    slot_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_keep_every_bit),
        cmocka_unit_test(all_sweeps_or_none_are_kept),
        cmocka_unit_test(numpy_sees_the_shapes),
        cmocka_unit_test(numbers_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
