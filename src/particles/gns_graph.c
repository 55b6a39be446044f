/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles/gns_graph.h"

#include "common/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Cells beyond are one: far from everything, and the integers stay small. */
static const float cell_limit = 1e9f;

void gns_graph_free(GnsGraph *graph) {
    free(graph->node_inputs);
    free(graph->edge_inputs);
    free(graph->receiver);
    free(graph->sender);
    free(graph->first);
    free(graph->next);
    free(graph->cell);
    *graph = (GnsGraph){0};
}

/* The lists of the grid: a power of two, at least as many as particles. */
static int list_count(int nodes) {
    int count = 16;
    while (count < nodes) count *= 2;
    return count;
}

static bool reserve(GnsGraph *graph, int nodes) {
    const size_t count = (size_t)nodes, edges = count * GNS_NEIGHBOURS;
    return array_reserve((void **)&graph->node_inputs, &graph->node_capacity, count, GNS_NODE_INPUTS * sizeof(float)) &&
           array_reserve((void **)&graph->edge_inputs, &graph->edge_input_capacity, edges,
                         GNS_EDGE_INPUTS * sizeof(float)) &&
           array_reserve((void **)&graph->receiver, &graph->receiver_capacity, edges, sizeof *graph->receiver) &&
           array_reserve((void **)&graph->sender, &graph->sender_capacity, edges, sizeof *graph->sender) &&
           array_reserve((void **)&graph->first, &graph->first_capacity, (size_t)list_count(nodes),
                         sizeof *graph->first) &&
           array_reserve((void **)&graph->next, &graph->next_capacity, count, sizeof *graph->next) &&
           array_reserve((void **)&graph->cell, &graph->cell_capacity, count, sizeof *graph->cell);
}

static int64_t cell_of(float x, float radius) {
    const float at = floorf(x / radius);
    return (int64_t)(at < -cell_limit ? -cell_limit : at > cell_limit ? cell_limit : at);
}

/* Two large primes (Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects", 2003). */
static int list_of(int64_t x, int64_t y, int lists) {
    return (int)(((uint64_t)x * 73856093u ^ (uint64_t)y * 19349663u) & (uint64_t)(lists - 1));
}

static void fill_grid(GnsGraph *graph, const GnsParticles *particles, float radius) {
    const int lists = list_count(graph->nodes);
    for (int i = 0; i < lists; i++) graph->first[i] = -1;
    for (int i = graph->nodes - 1; i >= 0; i--) { /* so each list rises */
        graph->cell[i][0] = cell_of(particles->position[i].x, radius);
        graph->cell[i][1] = cell_of(particles->position[i].y, radius);
        const int list = list_of(graph->cell[i][0], graph->cell[i][1], lists);
        graph->next[i] = graph->first[list];
        graph->first[list] = i;
    }
}

static void add_edge(GnsGraph *graph, const GnsParticles *particles, int receiver, int sender, Vec2 way, float length) {
    const GnsBody *to = &particles->body[receiver / BOX_PARTICLES], *from = &particles->body[sender / BOX_PARTICLES];
    float *inputs = graph->edge_inputs + (ptrdiff_t)graph->edges * GNS_EDGE_INPUTS;
    inputs[0] = way.x;
    inputs[1] = way.y;
    inputs[2] = length;
    inputs[3] = from->mass / (from->mass + to->mass);
    inputs[4] = to == from ? 1.0f : 0.0f;
    graph->receiver[graph->edges] = receiver;
    graph->sender[graph->edges++] = sender;
}

static void add_edges_from_cell(GnsGraph *graph, const GnsParticles *particles, int i, int64_t x, int64_t y,
                                float radius, int last) {
    for (int j = graph->first[list_of(x, y, list_count(graph->nodes))]; j >= 0; j = graph->next[j]) {
        if (j == i || graph->cell[j][0] != x || graph->cell[j][1] != y) continue;
        const Vec2 way = vec2_scale(1.0f / radius, vec2_sub(particles->position[j], particles->position[i]));
        const float square = vec2_dot(way, way);
        if (!(square < 1.0f)) continue;
        if (graph->edges == last) {
            graph->beyond = true;
            return;
        }
        add_edge(graph, particles, i, j, way, sqrtf(square));
    }
}

static void find_edges(GnsGraph *graph, const GnsParticles *particles, float radius) {
    fill_grid(graph, particles, radius);
    for (int i = 0; i < graph->nodes; i++) {
        const int last = graph->edges + GNS_NEIGHBOURS;
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                add_edges_from_cell(graph, particles, i, graph->cell[i][0] + x, graph->cell[i][1] + y, radius, last);
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
    if (!reserve(graph, gns_particle_count(particles))) return false;
    graph->nodes = gns_particle_count(particles);
    graph->edges = 0;
    graph->beyond = false;
    find_edges(graph, particles, scales->radius);
    for (int i = 0; i < graph->nodes; i++) fill_node(graph, particles, i, ground, count, scales);
    return true;
}
