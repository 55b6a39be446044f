/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The graph and the forward pass of gns. */
#include "particle_heap.h"
#include "owned.h"

#include "methods/gns_graph.h"

OWNED_VALUE(GnsGraph, gns_graph_free)

static void build(GnsGraph *graph, const ParticleHeap *heap, const GnsNet *net) {
    assert_true(gns_graph_build(graph, &heap->particles, &heap->ground, 1, &net->scales));
}

/* Every pair nearer than the radius has an edge each way, and no other has one. */
TEST(edges_are_those_of_all_pairs) {
    static ParticleHeap heap;
    GnsNet net;
    OWN(GnsGraph) graph = {.nodes = 0};
    make_heap(&heap, heap_order);
    make_net(&net, 16, 1);
    build(&graph, &heap, &net);
    int found = 0;
    for (int i = 0; i < HEAP_PARTICLES; i++)
        for (int j = 0; j < HEAP_PARTICLES; j++) {
            const Vec2 way = vec2_scale(1 / net.scales.radius, vec2_sub(heap.position[j], heap.position[i]));
            if (i == j || !(vec2_dot(way, way) < 1)) continue;
            int edge = 0;
            while (edge < graph.edges && (graph.receiver[edge] != i || graph.sender[edge] != j)) edge++;
            assert_in_range(edge, 0, graph.edges - 1);
            const float *inputs = graph.edge_inputs + (ptrdiff_t)edge * GNS_EDGE_INPUTS;
            assert_near(inputs[0], way.x, 0);
            assert_near(inputs[1], way.y, 0);
            assert_near(inputs[2], sqrtf(vec2_dot(way, way)), 0);
            assert_near(inputs[4], i / BOX_PARTICLES == j / BOX_PARTICLES, 0);
            found++;
        }
    assert_int_equal(found, graph.edges);
    assert_false(graph.beyond);
    gns_net_free(&net);
}

/* Boxes in one place do not make a number of edges that grows with its square; a fast particle is clamped. */
TEST(what_training_never_had_is_told) {
    static ParticleHeap heap;
    OWN(GnsNet) net;
    OWN(GnsGraph) graph = {.nodes = 0};
    make_heap(&heap, heap_order);
    make_net(&net, 16, 1);
    heap.velocity[40][2].y = -1e30f;
    build(&graph, &heap, &net);
    assert_true(graph.beyond);
    assert_near(graph.node_inputs[40 * GNS_NODE_INPUTS + 5], -net.scales.fastest / net.scales.velocity, 1e-6);
    heap.velocity[40][2].y = 0;
    for (int i = 0; i < HEAP_PARTICLES; i++) heap.position[i] = vec2(1e30f, -1e30f);
    build(&graph, &heap, &net);
    assert_true(graph.beyond);
    assert_int_equal(graph.edges, HEAP_PARTICLES * GNS_NEIGHBOURS);
}

/* outputs[HEAP_PARTICLES, GNS_OUTPUTS] */
static void predict(const ParticleHeap *heap, const GnsNet *net, const GnsKernels *kernels, bool tape, float *outputs) {
    OWN(GnsGraph) graph = {.nodes = 0};
    GnsPass pass = {.tape = tape, .kernels = kernels};
    build(&graph, heap, net);
    assert_true(gns_forward(&pass, &net->layout, net->parameters, &graph));
    memcpy(outputs, pass.outputs, HEAP_PARTICLES * GNS_OUTPUTS * sizeof *outputs);
    gns_pass_free(&pass);
}

TEST(all_kernels_have_the_same_bits) {
    static ParticleHeap heap;
    static float first[HEAP_PARTICLES * GNS_OUTPUTS], other[HEAP_PARTICLES * GNS_OUTPUTS];
    const Kernels *list[KERNELS_MAX + 1];
    kernels_list(list);
    make_heap(&heap, heap_order);
    for (int width = 16; width <= 48; width += 16) {
        OWN(GnsNet) net;
        make_net(&net, width, 3);
        predict(&heap, &net, &list[0]->gns, false, first);
        assert_true(first[0] != first[1]);
        for (int k = 0; list[k] != NULL; k++)
            for (int tape = 0; tape < 2; tape++) {
                predict(&heap, &net, &list[k]->gns, tape == 1, other);
                assert_memory_equal(first, other, sizeof first);
            }
    }
}

/* A graph has no order of its nodes: the same boxes in another order move the same, but for the rounding of sums. */
TEST(the_order_of_bodies_does_not_count) {
    static const int mixed[HEAP_BODIES] = {4, 2, 6, 0, 5, 3, 1};
    static ParticleHeap heap, other;
    static float first[HEAP_PARTICLES][GNS_OUTPUTS], second[HEAP_PARTICLES][GNS_OUTPUTS];
    OWN(GnsNet) net;
    make_heap(&heap, heap_order);
    make_heap(&other, mixed);
    make_net(&net, 16, 4);
    predict(&heap, &net, NULL, false, first[0]);
    predict(&other, &net, NULL, false, second[0]);
    for (int i = 0; i < HEAP_PARTICLES; i++)
        for (int k = 0; k < GNS_OUTPUTS; k++)
            assert_near(second[i][k], first[mixed[i / BOX_PARTICLES] * BOX_PARTICLES + i % BOX_PARTICLES][k], 1e-4);
}

/* With M rounds, a particle hears of those at most M edges away. */
TEST(news_travels_one_edge_a_round) {
    static ParticleHeap heap, other;
    static float first[HEAP_PARTICLES * GNS_OUTPUTS], second[HEAP_PARTICLES * GNS_OUTPUTS];
    for (int rounds = 1; rounds <= 3; rounds++) {
        OWN(GnsNet) net;
        make_heap(&heap, heap_order);
        for (int i = 0; i < HEAP_PARTICLES; i++) heap.position[i] = vec2(0.5f * (float)i, 0); /* a row */
        make_net(&net, 16, rounds);
        other = heap;
        other.particles = (GnsParticles){HEAP_BODIES, other.body, other.position, other.velocity};
        other.velocity[0][0].x += 1;
        predict(&heap, &net, NULL, false, first);
        predict(&other, &net, NULL, false, second);
        for (int i = 0; i < HEAP_PARTICLES; i++)
            assert_int_equal(i <= rounds,
                             memcmp(first + (ptrdiff_t)i * GNS_OUTPUTS, second + (ptrdiff_t)i * GNS_OUTPUTS,
                                    GNS_OUTPUTS * sizeof *first) != 0);
    }
}

RUN_TESTS(NULL, NULL)
