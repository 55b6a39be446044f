/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The backward pass of gns is the slope of its forward pass. */
#include "methods/particle_heap.h"

#include "learning/gns_backward.h"

/* Two boxes, one of which is static: with more, some unit of ReLU would switch within almost any step. */
enum { FEW_BODIES = 2, PARTICLES = FEW_BODIES * BOX_PARTICLES };

typedef struct Trial {
    ParticleHeap heap;
    GnsNet net;
    GnsGraph graph;
    GnsPass pass;
    float slopes[PARTICLES * GNS_OUTPUTS]; /* the loss is their product with the outputs */
    float *kept, *gradient;
    int active; /* hidden values above 0 */
} Trial;

static int count_in(const GnsLayerTape *tape, int values) {
    int active = 0;
    for (int i = 0; i < values; i++) active += (tape->first[i] > 0) + (tape->second[i] > 0);
    return active;
}

/* How many hidden values are above 0. */
static int count_active(const Trial *trial) {
    const GnsPass *pass = &trial->pass;
    const int nodes = trial->graph.nodes * trial->net.layout.width,
              edges = trial->graph.edges * trial->net.layout.width;
    int active = count_in(&pass->nodes, nodes) + count_in(&pass->edges, edges) + count_in(&pass->decoder, nodes);
    for (int m = 0; m < trial->net.layout.rounds; m++)
        active += count_in(&pass->node_rounds[m], nodes) + count_in(&pass->edge_rounds[m], edges);
    return active;
}

static void begin(Trial *trial, int width, int rounds) {
    uint64_t random = 7;
    *trial = (Trial){.pass = {.tape = true}};
    make_heap(&trial->heap, (const int[HEAP_BODIES]){1, 2, 0, 3, 4, 5, 6});
    trial->heap.particles.bodies = FEW_BODIES;
    make_net(&trial->net, width, rounds);
    assert_true(gns_graph_build(&trial->graph, &trial->heap.particles, &trial->heap.ground, 1, &trial->net.scales));
    for (int i = 0; i < PARTICLES * GNS_OUTPUTS; i++) trial->slopes[i] = random_between(&random, -1, 1);
    const size_t bytes = (size_t)trial->net.layout.parameters * sizeof(float);
    trial->kept = malloc(bytes);
    trial->gradient = calloc(1, bytes);
    assert_true(trial->kept != NULL && trial->gradient != NULL);
    memcpy(trial->kept, trial->net.parameters, bytes);
}

static void end(Trial *trial) {
    free(trial->kept);
    free(trial->gradient);
    gns_graph_free(&trial->graph);
    gns_pass_free(&trial->pass);
    gns_net_free(&trial->net);
}

static double loss(Trial *trial) {
    double sum = 0;
    assert_true(gns_forward(&trial->pass, &trial->net.layout, trial->net.parameters, &trial->graph));
    for (int i = 0; i < PARTICLES * GNS_OUTPUTS; i++) sum += (double)trial->pass.outputs[i] * (double)trial->slopes[i];
    return sum;
}

static void find_gradient(Trial *trial) {
    GnsBackward back = {.capacity = 0};
    float *transposed = calloc((size_t)trial->net.layout.parameters, sizeof *transposed);
    assert_non_null(transposed);
    loss(trial);
    trial->active = count_active(trial);
    gns_transpose(&trial->net.layout, trial->net.parameters, transposed);
    assert_true(gns_backward(&back, &trial->pass, &trial->net.layout, trial->net.parameters, transposed, &trial->graph,
                             trial->slopes, trial->gradient));
    gns_backward_free(&back);
    free(transposed);
}

/* The loss a way along a direction within one array of parameters, all others kept. */
static double moved_loss(Trial *trial, int at, int count, const float *direction, double way) {
    for (int i = 0; i < count; i++)
        trial->net.parameters[at + i] = (float)((double)trial->kept[at + i] + way * (double)direction[i]);
    const double result = loss(trial);
    memcpy(trial->net.parameters, trial->kept, (size_t)trial->net.layout.parameters * sizeof(float));
    return result;
}

/* Central differences along a direction that rises with the gradient, so that the slope is not lost among the rounding
   errors of float32. Of these, half a thousandth is the shortest step that keeps 1%. Across a kink of ReLU differences
   are wrong: directions are drawn until as many values are active on both sides. */
static void check_array(Trial *trial, int at, int count, const char *what) {
    enum { LARGEST = 4096, DRAWS = 500 };
    static float direction[LARGEST];
    const double step = 5e-4;
    uint64_t random = 31 + (uint64_t)at;
    assert_in_range(count, 1, LARGEST);
    for (int draw = 0; draw < DRAWS; draw++) {
        double slope = 0, square = 0;
        for (int i = 0; i < count; i++) {
            const float share = random_between(&random, 0, 1);
            direction[i] = trial->gradient[at + i] < 0 ? -share : share;
            slope += (double)direction[i] * (double)trial->gradient[at + i];
            square += (double)direction[i] * (double)direction[i];
        }
        const double way = step / sqrt(square), ahead = moved_loss(trial, at, count, direction, way);
        if (count_active(trial) != trial->active) continue;
        const double found = (ahead - moved_loss(trial, at, count, direction, -way)) / (2 * way);
        if (count_active(trial) != trial->active) continue;
        if (!(fabs(found - slope) <= 0.01 * fabs(slope) + 1e-3))
            fail_msg("%s: the backward pass says %g, differences %g", what, slope, found);
        return;
    }
    fail_msg("%s: a unit switches in every direction", what);
}

static void check_mlp(Trial *trial, const GnsMlp *mlp, const char *what) {
    const int widths[4] = {mlp->inputs, mlp->width, mlp->width, mlp->outputs};
    for (int l = 0; l < 3; l++) {
        check_array(trial, mlp->weights[l], widths[l] * widths[l + 1], what);
        check_array(trial, mlp->biases[l], widths[l + 1], what);
    }
    if (mlp->gain < 0) return;
    check_array(trial, mlp->gain, mlp->outputs, what);
    check_array(trial, mlp->offset, mlp->outputs, what);
}

TEST(it_is_the_slope_of_the_forward_pass) {
    static Trial trial;
    for (int width = 16; width <= 32; width += 16) {
        begin(&trial, width, width == 16 ? 2 : 1);
        find_gradient(&trial);
        const GnsLayout *layout = &trial.net.layout;
        check_mlp(&trial, &layout->nodes, "nodes");
        check_mlp(&trial, &layout->edges, "edges");
        for (int m = 0; m < layout->rounds; m++) {
            check_mlp(&trial, &layout->edge_rounds[m], "edges of a round");
            check_mlp(&trial, &layout->node_rounds[m], "nodes of a round");
        }
        check_mlp(&trial, &layout->decoder, "decoder");
        end(&trial);
    }
}

RUN_TESTS(NULL, NULL)
