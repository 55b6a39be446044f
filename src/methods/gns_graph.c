/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Boxes as particles, the graph of particles, and the forward pass over it (methods/gns_graph.h). */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/gns_graph.h"
#include "nets/kernels.h"
#include "nets/kinds.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

Vec2 box_particle(int k, Vec2 size) {
    const int column = k % 3 - 1, row = k / 3 - 1;
    return vec2(0.5f * (float)column * size.x, 0.5f * (float)row * size.y);
}

void box_particles_place(Vec2 *particles, Vec2 size, const BodyPose *pose) {
    const Mat22 rotation = mat22_rotation(pose->angle);
    for (int k = 0; k < BOX_PARTICLES; k++)
        particles[k] = vec2_add(pose->position, mat22_multiply(rotation, box_particle(k, size)));
}

/* tan(a/2) = sin a / (1 + cos a), twice more tan(a/2) = t / (1 + sqrt(1 + t^2)); then at most tan(pi / 16) = 0.2, where
   the series of the arc tangent needs few terms. Beyond a quarter turn: pi less the angle of the mirror image. */
double plane_angle(double cosine, double sine) {
    enum { TERMS = 12, HALVINGS = 2 };
    const double pi = 0x1.921fb54442d18p1, length = sqrt(cosine * cosine + sine * sine);
    if (!(length > 0)) return 0;
    double t = sine / (length + fabs(cosine)), sum = 0;
    for (int i = 0; i < HALVINGS; i++) t = t / (1 + sqrt(1 + t * t));
    for (int n = TERMS; n >= 0; n--) sum = 1.0 / (2 * n + 1) - t * t * sum;
    const double angle = (2 << HALVINGS) * t * sum;
    return cosine < 0 ? (sine < 0 ? -pi : pi) - angle : angle;
}

BodyPose box_particles_fit(const Vec2 *particles, Vec2 size, const BodyPose *near) {
    const Mat22 rotation = mat22_rotation(near->angle);
    double x = 0, y = 0, cosine = 0, sine = 0;
    for (int k = 0; k < BOX_PARTICLES; k++) {
        x += (double)particles[k].x;
        y += (double)particles[k].y;
    }
    x /= BOX_PARTICLES;
    y /= BOX_PARTICLES;
    for (int k = 0; k < BOX_PARTICLES; k++) {
        const Vec2 arm = mat22_multiply(rotation, box_particle(k, size));
        const double ax = (double)arm.x, ay = (double)arm.y;
        const double px = (double)particles[k].x - x, py = (double)particles[k].y - y;
        cosine += ax * px + ay * py;
        sine += ax * py - ay * px;
    }
    return (BodyPose){vec2((float)x, (float)y), (float)((double)near->angle + plane_angle(cosine, sine))};
}

/* Rows that pass a perceptron together: 64 rows of 16 numbers in four arrays stay in the L1 cache. */
enum { TILE = 64 };

void gns_pass_free(GnsPass *pass) {
    free(pass->numbers);
    *pass = (GnsPass){.tape = pass->tape};
}

static float *take(float *numbers, size_t *used, size_t count) {
    float *at = numbers != NULL ? numbers + *used : NULL;
    *used += (count + 7) & ~(size_t)7;
    return at;
}

static GnsLayerTape take_layer(float *numbers, size_t *used, size_t rows, size_t width) {
    GnsLayerTape layer;
    layer.first = take(numbers, used, rows * width);
    layer.second = take(numbers, used, rows * width);
    layer.normalised = take(numbers, used, rows * width);
    layer.inverse = take(numbers, used, rows);
    return layer;
}

/* Places the arrays in `numbers`, or with NULL only counts them. */
static size_t place(GnsPass *pass, float *numbers, const GnsLayout *layout, const GnsGraph *graph) {
    const size_t nodes = (size_t)graph->nodes, edges = (size_t)graph->edges, width = (size_t)layout->width;
    const bool tape = pass->tape;
    size_t used = 0;
    for (int m = 0; m <= layout->rounds; m++) {
        const bool own = tape || m == 0;
        pass->node[m] = own ? take(numbers, &used, nodes * width) : pass->node[0];
        pass->edge[m] = own ? take(numbers, &used, edges * width) : pass->edge[0];
        if (m == layout->rounds) break;
        pass->sum[m] = own ? take(numbers, &used, nodes * width) : pass->sum[0];
        pass->edge_rounds[m] = own ? take_layer(numbers, &used, tape ? edges : TILE, width) : pass->edge_rounds[0];
        pass->node_rounds[m] = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    }
    pass->nodes = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    pass->edges = tape ? take_layer(numbers, &used, edges, width) : pass->edge_rounds[0];
    pass->decoder = tape ? take_layer(numbers, &used, nodes, width) : pass->edge_rounds[0];
    pass->outputs = take(numbers, &used, nodes * GNS_OUTPUTS);
    pass->from_receiver = take(numbers, &used, nodes * width);
    pass->from_sender = take(numbers, &used, nodes * width);
    pass->change = take(numbers, &used, TILE * width);
    return used;
}

/* The rows from `row` on, of a perceptron with a tape; without one, the tile. */
static GnsLayerTape rows_of(const GnsPass *pass, const GnsLayerTape *layer, int row, int width) {
    if (!pass->tape) return *layer;
    const ptrdiff_t at = (ptrdiff_t)row * width;
    return (GnsLayerTape){layer->first + at, layer->second + at, layer->normalised + at, layer->inverse + row};
}

/* The rest of a perceptron, from the sums of its first layer on. */
static void finish(const GnsKernels *kernels, const GnsMlp *mlp, const float *parameters, const GnsLayerTape *tape,
                   int rows, float *out) {
    const int width = mlp->width;
    float *last = mlp->gain >= 0 ? tape->normalised : out;
    kernels->relu(tape->first, rows * width);
    kernels->multiply(tape->second, tape->first, parameters + mlp->weights[1], parameters + mlp->biases[1], rows, width,
                      width);
    kernels->relu(tape->second, rows * width);
    kernels->multiply(last, tape->second, parameters + mlp->weights[2], parameters + mlp->biases[2], rows, width,
                      mlp->outputs);
    if (mlp->gain >= 0)
        kernels->normalise(last, tape->inverse, out, parameters + mlp->gain, parameters + mlp->offset, rows, width);
}

static int tile_rows(int first, int rows) { return rows - first < TILE ? rows - first : TILE; }

/* out[rows, mlp->outputs] of in[rows, mlp->inputs] */
static void apply(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, const GnsLayerTape *tape,
                  const float *in, int rows, float *out) {
    for (int first = 0; first < rows; first += TILE) {
        const int count = tile_rows(first, rows);
        const GnsLayerTape at = rows_of(pass, tape, first, mlp->width);
        pass->kernels->multiply(at.first, in + (ptrdiff_t)first * mlp->inputs, parameters + mlp->weights[0],
                                parameters + mlp->biases[0], count, mlp->inputs, mlp->width);
        finish(pass->kernels, mlp, parameters, &at, count, out + (ptrdiff_t)first * mlp->outputs);
    }
}

static void add(float *out, const float *a, const float *b, int count) {
    for (int i = 0; i < count; i++) out[i] = a[i] + b[i];
}

/* The first layer's sums over a node's numbers are the same for all its edges, and made once. */
static void pass_messages(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, const GnsGraph *graph,
                          int m) {
    const GnsKernels *kernels = pass->kernels;
    const int width = mlp->width, square = width * width;
    const float *weights = parameters + mlp->weights[0];
    memset(pass->sum[m], 0, (size_t)graph->nodes * (size_t)width * sizeof(float));
    memset(pass->from_sender, 0, (size_t)graph->nodes * (size_t)width * sizeof(float));
    kernels->multiply(pass->from_receiver, pass->node[m], weights + square, parameters + mlp->biases[0], graph->nodes,
                      width, width);
    kernels->multiply(pass->from_sender, pass->node[m], weights + 2 * (ptrdiff_t)square, NULL, graph->nodes, width,
                      width);
    for (int first = 0; first < graph->edges; first += TILE) {
        const int count = tile_rows(first, graph->edges);
        const ptrdiff_t at = (ptrdiff_t)first * width;
        const GnsLayerTape tape = rows_of(pass, &pass->edge_rounds[m], first, width);
        memset(tape.first, 0, (size_t)count * (size_t)width * sizeof(float));
        kernels->add_rows(tape.first, pass->from_receiver, graph->receiver + first, count, width);
        kernels->add_rows(tape.first, pass->from_sender, graph->sender + first, count, width);
        kernels->multiply(tape.first, pass->edge[m] + at, weights, NULL, count, width, width);
        finish(kernels, mlp, parameters, &tape, count, pass->change);
        kernels->add_to_rows(pass->sum[m], pass->change, graph->receiver + first, count, width);
        add(pass->edge[m + 1] + at, pass->edge[m] + at, pass->change, count * width);
    }
}

static void update_nodes(const GnsPass *pass, const GnsMlp *mlp, const float *parameters, int nodes, int m) {
    const GnsKernels *kernels = pass->kernels;
    const int width = mlp->width;
    for (int first = 0; first < nodes; first += TILE) {
        const int count = tile_rows(first, nodes);
        const ptrdiff_t at = (ptrdiff_t)first * width;
        const GnsLayerTape tape = rows_of(pass, &pass->node_rounds[m], first, width);
        kernels->multiply(tape.first, pass->node[m] + at, parameters + mlp->weights[0], parameters + mlp->biases[0],
                          count, width, width);
        kernels->multiply(tape.first, pass->sum[m] + at, parameters + mlp->weights[0] + (ptrdiff_t)width * width, NULL,
                          count, width, width);
        finish(kernels, mlp, parameters, &tape, count, pass->change);
        add(pass->node[m + 1] + at, pass->node[m] + at, pass->change, count * width);
    }
}

bool gns_forward(GnsPass *pass, const GnsLayout *layout, const float *parameters, const GnsGraph *graph) {
    const size_t needed = place(pass, NULL, layout, graph);
    if (!array_reserve((void **)&pass->numbers, &pass->capacity, needed, sizeof *pass->numbers)) return false;
    place(pass, pass->numbers, layout, graph);
    if (pass->kernels == NULL) pass->kernels = &kernels_best()->gns;
    apply(pass, &layout->nodes, parameters, &pass->nodes, graph->node_inputs, graph->nodes, pass->node[0]);
    apply(pass, &layout->edges, parameters, &pass->edges, graph->edge_inputs, graph->edges, pass->edge[0]);
    for (int m = 0; m < layout->rounds; m++) {
        pass_messages(pass, &layout->edge_rounds[m], parameters, graph, m);
        update_nodes(pass, &layout->node_rounds[m], parameters, graph->nodes, m);
    }
    apply(pass, &layout->decoder, parameters, &pass->decoder, pass->node[layout->rounds], graph->nodes, pass->outputs);
    return true;
}

/* Cells beyond are one: far from everything, and the integers stay small. */
static const float cell_limit = 1e9f;

void gns_graph_free(GnsGraph *graph) {
    free(graph->arrays.memory);
    *graph = (GnsGraph){0};
}

/* The lists of the grid: a power of two, at least as many as particles. */
static int list_count(int nodes) {
    int count = 16;
    while (count < nodes) count *= 2;
    return count;
}

static int64_t cell_of(float x, float radius) {
    const float at = floorf(x / radius);
    return (int64_t)(at < -cell_limit ? -cell_limit : at > cell_limit ? cell_limit : at);
}

/* Two large primes (Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects",
   2003). */
static int list_of(int64_t x, int64_t y, int lists) {
    return (int)(((uint64_t)x * 73856093u ^ (uint64_t)y * 19349663u) & (uint64_t)(lists - 1));
}

/* Edges to particle i from those of a cell, as long as there are fewer than `last` in all. */
static void add_edges(GnsGraph *graph, const GnsParticles *particles, int i, int64_t x, int64_t y, float radius,
                      int last) {
    for (int j = graph->first[list_of(x, y, list_count(graph->nodes))]; j >= 0; j = graph->next[j]) {
        if (j == i || graph->cell[j][0] != x || graph->cell[j][1] != y) continue;
        const Vec2 way = vec2_scale(1.0f / radius, vec2_sub(particles->position[j], particles->position[i]));
        const float square = vec2_dot(way, way);
        if (!(square < 1.0f)) continue;
        if (graph->edges == last) {
            graph->beyond = true;
            return;
        }
        const GnsBody *to = &particles->body[i / BOX_PARTICLES], *from = &particles->body[j / BOX_PARTICLES];
        float *inputs = graph->edge_inputs + (ptrdiff_t)graph->edges * GNS_EDGE_INPUTS;
        inputs[0] = way.x;
        inputs[1] = way.y;
        inputs[2] = sqrtf(square);
        inputs[3] = from->mass / (from->mass + to->mass);
        inputs[4] = to == from ? 1.0f : 0.0f;
        graph->receiver[graph->edges] = i;
        graph->sender[graph->edges++] = j;
    }
}

/* m from the surface, negative inside; *outward: unit, away from the box. */
static float surface_distance(Vec2 point, const Box *box, Vec2 *outward) {
    const Vec2 local = mat22_multiply(mat22_transpose(box->rotation), vec2_sub(point, box->position));
    const Vec2 beyond = vec2_sub(vec2_abs(local), box->half);
    Vec2 way = vec2(beyond.x > 0 ? beyond.x : 0, beyond.y > 0 ? beyond.y : 0);
    float distance = sqrtf(vec2_dot(way, way));
    if (distance > 0) {
        way = vec2_scale(1.0f / distance, way);
    } else { /* inside: through the nearest face */
        way = beyond.x > beyond.y ? vec2(1, 0) : vec2(0, 1);
        distance = beyond.x > beyond.y ? beyond.x : beyond.y;
    }
    *outward = mat22_multiply(box->rotation, vec2(copysignf(way.x, local.x), copysignf(way.y, local.y)));
    return distance;
}

static float clamp(float x, float limit) { return x < -limit ? -limit : x > limit ? limit : x; }

static void fill_node(GnsGraph *graph, const GnsParticles *particles, int i, const Box *ground, int count,
                      const GnsScales *scales) {
    float *inputs = graph->node_inputs + (ptrdiff_t)i * GNS_NODE_INPUTS;
    const float fastest = scales->fastest;
    for (int k = 0; k < GNS_HISTORY; k++) {
        const Vec2 velocity = particles->velocity[i][k];
        if (!(fabsf(velocity.x) <= fastest && fabsf(velocity.y) <= fastest)) graph->beyond = true;
        *inputs++ = clamp(velocity.x, fastest) / scales->velocity;
        *inputs++ = clamp(velocity.y, fastest) / scales->velocity;
    }
    *inputs++ = particles->body[i / BOX_PARTICLES].bomb ? 1.0f : 0.0f;
    float nearest = scales->radius;
    Vec2 outward = vec2(0, 0), way;
    for (int b = 0; b < count; b++) {
        const float distance = surface_distance(particles->position[i], &ground[b], &way);
        if (!(distance < nearest)) continue;
        nearest = distance;
        outward = way;
    }
    const float share = clamp(nearest / scales->radius, 1.0f);
    *inputs++ = share;
    *inputs++ = (1.0f - share) * outward.x;
    *inputs = (1.0f - share) * outward.y;
}

bool gns_graph_build(GnsGraph *graph, const GnsParticles *particles, const Box *ground, int count,
                     const GnsScales *scales) {
    const int nodes = gns_particle_count(particles), lists = list_count(nodes);
    const size_t room = (size_t)nodes, edges = room * GNS_NEIGHBOURS;
    if (!ARRAY_BLOCK_RESERVE(&graph->arrays, ARRAY_PART(graph->node_inputs, room * GNS_NODE_INPUTS),
                             ARRAY_PART(graph->edge_inputs, edges * GNS_EDGE_INPUTS),
                             ARRAY_PART(graph->receiver, edges), ARRAY_PART(graph->sender, edges),
                             ARRAY_PART(graph->first, lists), ARRAY_PART(graph->next, room),
                             ARRAY_PART(graph->cell, room)))
        return false;
    graph->nodes = nodes;
    graph->edges = 0;
    graph->beyond = false;
    /* A grid of cells as wide as the radius. */
    for (int i = 0; i < lists; i++) graph->first[i] = -1;
    for (int i = nodes - 1; i >= 0; i--) { /* so each list rises */
        graph->cell[i][0] = cell_of(particles->position[i].x, scales->radius);
        graph->cell[i][1] = cell_of(particles->position[i].y, scales->radius);
        const int list = list_of(graph->cell[i][0], graph->cell[i][1], lists);
        graph->next[i] = graph->first[list];
        graph->first[list] = i;
    }
    for (int i = 0; i < nodes; i++) {
        const int last = graph->edges + GNS_NEIGHBOURS;
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                add_edges(graph, particles, i, graph->cell[i][0] + x, graph->cell[i][1] + y, scales->radius, last);
    }
    for (int i = 0; i < nodes; i++) fill_node(graph, particles, i, ground, count, scales);
    return true;
}
