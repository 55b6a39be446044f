/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/tape.h"

#include "common/array.h"
#include "network/interior_net.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void tape_free(Tape *tape) {
    free(tape->nodes);
    free(tape->values);
    free(tape->slopes);
    *tape = (Tape){0};
}

void tape_clear(Tape *tape) {
    tape->count = 0;
    tape->used = 0;
    tape->failed = false;
}

/* After a failure all nodes share the first numbers, so that callers need not check each call. */
static TapeId append(Tape *tape, int operation, TapeId a, TapeId b, int length) {
    if (!array_reserve((void **)&tape->nodes, &tape->node_capacity, (size_t)tape->count + 1, sizeof *tape->nodes) ||
        !array_reserve((void **)&tape->values, &tape->value_capacity, tape->used + (size_t)length,
                       sizeof *tape->values)) {
        tape->failed = true;
        return -1;
    }
    tape->nodes[tape->count] = (TapeNode){operation, a, b, length, tape->used};
    tape->used += ((size_t)length + 1) / 2 * 2; /* an even number: a node may be read as vectors of 16 bytes */
    return tape->count++;
}

TapeId tape_given(Tape *tape, const double *values, int length) {
    if (tape->failed) return -1;
    const TapeId id = append(tape, TAPE_GIVEN, -1, -1, length);
    if (id < 0) return id;
    if (values != NULL)
        memcpy(tape_values(tape, id), values, (size_t)length * sizeof *values);
    else
        memset(tape_values(tape, id), 0, (size_t)length * sizeof *values);
    return id;
}

TapeId tape_number(Tape *tape, double value) { return tape_given(tape, &value, 1); }

static inline double apply(int operation, double x, double y) {
    switch (operation) {
    case TAPE_ADD: return x + y;
    case TAPE_SUBTRACT: return x - y;
    case TAPE_MULTIPLY: return x * y;
    case TAPE_DIVIDE: return x / y;
    case TAPE_LARGER: return x > y ? x : y;
    default: return x < y ? x : y;
    }
}

/* Slopes by x and y times the slope of the result. */
static inline double by_first(int operation, double x, double y, double slope) {
    switch (operation) {
    case TAPE_MULTIPLY: return slope * y;
    case TAPE_DIVIDE: return slope / y;
    case TAPE_LARGER: return x > y ? slope : 0;
    case TAPE_SMALLER: return x < y ? slope : 0;
    default: return slope;
    }
}

static inline double by_second(int operation, double x, double y, double slope) {
    switch (operation) {
    case TAPE_SUBTRACT: return -slope;
    case TAPE_MULTIPLY: return slope * x;
    case TAPE_DIVIDE: return -slope * x / (y * y);
    case TAPE_LARGER: return x > y ? 0 : slope;
    case TAPE_SMALLER: return x < y ? 0 : slope;
    default: return slope;
    }
}

/* The arrays of an operation of two operands; a step is 0 for a single number. */
typedef struct Operands {
    const double *x, *y, *slope;
    double *out, *by_x, *by_y;
    int x_step, y_step, length;
} Operands;

static inline void run(int operation, const Operands *o) {
    if (o->x_step && o->y_step)
        for (int i = 0; i < o->length; i++) o->out[i] = apply(operation, o->x[i], o->y[i]);
    else
        for (int i = 0; i < o->length; i++) o->out[i] = apply(operation, o->x[i * o->x_step], o->y[i * o->y_step]);
}

static inline void run_back(int operation, const Operands *o) {
    if (o->x_step)
        for (int i = 0; i < o->length; i++)
            o->by_x[i] += by_first(operation, o->x[i], o->y[i * o->y_step], o->slope[i]);
    else
        for (int i = 0; i < o->length; i++)
            o->by_x[0] += by_first(operation, o->x[0], o->y[i * o->y_step], o->slope[i]);
    if (o->y_step)
        for (int i = 0; i < o->length; i++)
            o->by_y[i] += by_second(operation, o->x[i * o->x_step], o->y[i], o->slope[i]);
    else
        for (int i = 0; i < o->length; i++)
            o->by_y[0] += by_second(operation, o->x[i * o->x_step], o->y[0], o->slope[i]);
}

/* A constant operation in each branch, so that each loop is compiled for its own. */
#define FOR_EACH_OPERATION(function)                              \
    switch (operation) {                                          \
    case TAPE_ADD: function(TAPE_ADD, operands); break;           \
    case TAPE_SUBTRACT: function(TAPE_SUBTRACT, operands); break; \
    case TAPE_MULTIPLY: function(TAPE_MULTIPLY, operands); break; \
    case TAPE_DIVIDE: function(TAPE_DIVIDE, operands); break;     \
    case TAPE_LARGER: function(TAPE_LARGER, operands); break;     \
    default: function(TAPE_SMALLER, operands); break;             \
    }

static Operands operands_of(Tape *tape, const TapeNode *node) {
    const TapeNode *a = &tape->nodes[node->a], *b = &tape->nodes[node->b];
    return (Operands){.x = tape->values + a->at,
                      .y = tape->values + b->at,
                      .out = tape->values + node->at,
                      .x_step = a->length > 1 || node->length == 1,
                      .y_step = b->length > 1 || node->length == 1,
                      .length = node->length};
}

TapeId tape_two(Tape *tape, TapeOperation operation, TapeId a, TapeId b) {
    if (tape->failed) return -1;
    const int m = tape->nodes[a].length, n = tape->nodes[b].length;
    assert(m == n || m == 1 || n == 1);
    const TapeId id = append(tape, (int)operation, a, b, m > n ? m : n);
    if (id < 0) return id;
    const Operands all = operands_of(tape, &tape->nodes[id]), *operands = &all;
    FOR_EACH_OPERATION(run)
    return id;
}

static void back_two(Tape *tape, const TapeNode *node) {
    Operands all = operands_of(tape, node), *operands = &all;
    all.slope = tape->slopes + node->at;
    all.by_x = tape_slopes(tape, node->a);
    all.by_y = tape_slopes(tape, node->b);
    const int operation = node->operation;
    FOR_EACH_OPERATION(run_back)
}

TapeId tape_one(Tape *tape, TapeOperation operation, TapeId a) {
    if (tape->failed) return -1;
    const int length = tape->nodes[a].length;
    const TapeId id = append(tape, (int)operation, a, -1, operation == TAPE_SUM ? 1 : length);
    if (id < 0) return id;
    const double *x = tape_values(tape, a);
    double *out = tape_values(tape, id);
    if (operation == TAPE_SUM) out[0] = 0;
    for (int i = 0; i < length; i++) switch (operation) {
        case TAPE_SUM: out[0] += x[i]; break;
        case TAPE_LOG2: out[i] = interior_net_log2(x[i]); break;
        case TAPE_POWER2: out[i] = interior_net_power2(x[i]); break;
        case TAPE_LOG: out[i] = log(x[i]); break;
        default: out[i] = sqrt(x[i]); break;
        }
    return id;
}

/* 2^floor(log2 x) */
static double power_below(double x) {
    int exponent;
    frexp(x, &exponent);
    return ldexp(1, exponent - 1);
}

/* The logarithm and the power are straight lines between powers of two and between whole numbers. */
static void back_one(Tape *tape, const TapeNode *node) {
    const double *x = tape_values(tape, node->a), *out = tape->values + node->at, *slope = tape->slopes + node->at;
    double *by_x = tape_slopes(tape, node->a);
    for (int i = 0; i < tape->nodes[node->a].length; i++) switch (node->operation) {
        case TAPE_SUM: by_x[i] += slope[0]; break;
        case TAPE_LOG2: by_x[i] += slope[i] / power_below(x[i]); break;
        case TAPE_POWER2: by_x[i] += slope[i] * power_below(out[i]); break;
        case TAPE_LOG: by_x[i] += slope[i] / x[i]; break;
        default: by_x[i] += out[i] > 0 ? slope[i] / (2 * out[i]) : 0; break;
        }
}

TapeId tape_own(Tape *tape, int operation, TapeId a, TapeId b, int length) {
    if (tape->failed) return -1;
    const TapeId id = append(tape, operation, a, b, length);
    if (id >= 0) tape->forward(tape->context, tape, &tape->nodes[id]);
    return id;
}

void tape_backward(Tape *tape, TapeId number) {
    if (tape->failed ||
        !array_reserve((void **)&tape->slopes, &tape->slope_capacity, tape->used, sizeof *tape->slopes)) {
        tape->failed = true;
        return;
    }
    memset(tape->slopes, 0, tape->used * sizeof *tape->slopes);
    tape_slopes(tape, number)[0] = 1;
    for (int i = number; i >= 0; i--) {
        const TapeNode *node = &tape->nodes[i];
        if (node->operation >= TAPE_OWN)
            tape->backward(tape->context, tape, node);
        else if (node->operation >= TAPE_LOG2)
            back_one(tape, node);
        else if (node->operation != TAPE_GIVEN)
            back_two(tape, node);
    }
}
