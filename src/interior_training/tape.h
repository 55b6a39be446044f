/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reverse-mode derivatives of vector expressions, in double. Each operation appends a node with its values;
   tape_backward() goes back over the nodes and adds up the derivatives of one number with respect to all of them.
   Operands have equal lengths, or one has length 1 and stands for a vector of equal numbers. Operations with kinks
   (larger, smaller, the logarithm and power of interior_net.h) have the derivative of the piece that was taken.
   Source: Griewank and Walther, "Evaluating Derivatives" (2008), chapter 3. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef int TapeId; /* of a node */

typedef enum TapeOperation {
    TAPE_GIVEN,
    TAPE_ADD,
    TAPE_SUBTRACT,
    TAPE_MULTIPLY,
    TAPE_DIVIDE,
    TAPE_LARGER,
    TAPE_SMALLER,
    TAPE_LOG2,
    TAPE_POWER2,
    TAPE_LOG,
    TAPE_ROOT,
    TAPE_SUM,
    TAPE_OWN /* the first of a user's operations */
} TapeOperation;

typedef struct TapeNode {
    int operation;
    TapeId a, b; /* operands; -1: none */
    int length;
    size_t at; /* of the first number */
} TapeNode;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Tape {
    TapeNode *nodes;
    int count;
    double *values, *slopes; /* [used]; slopes: the derivatives, after tape_backward() */
    size_t used;
    bool failed; /* memory was short: values are not valid */
    /* The user's operations: fills values or adds to the slopes of the operands. */
    void (*forward)(void *context, struct Tape *tape, const TapeNode *node);
    void (*backward)(void *context, struct Tape *tape, const TapeNode *node);
    void *context;
    size_t node_capacity, value_capacity, slope_capacity;
} Tape;

void tape_free(Tape *tape);
void tape_clear(Tape *tape);

static inline double *tape_values(const Tape *tape, TapeId id) { return tape->values + tape->nodes[id].at; }
static inline double *tape_slopes(const Tape *tape, TapeId id) { return tape->slopes + tape->nodes[id].at; }

/* A node with given values; NULL: zeros. */
TapeId tape_given(Tape *tape, const double *values, int length);
TapeId tape_number(Tape *tape, double value);

TapeId tape_two(Tape *tape, TapeOperation operation, TapeId a, TapeId b);
TapeId tape_one(Tape *tape, TapeOperation operation, TapeId a);

/* One of the user's operations. */
TapeId tape_own(Tape *tape, int operation, TapeId a, TapeId b, int length);

/* Slopes of a number (a node of length 1) with respect to all nodes. */
void tape_backward(Tape *tape, TapeId number);

static inline TapeId tape_add(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_ADD, a, b); }
static inline TapeId tape_subtract(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_SUBTRACT, a, b); }
static inline TapeId tape_multiply(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_MULTIPLY, a, b); }
static inline TapeId tape_divide(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_DIVIDE, a, b); }
static inline TapeId tape_larger(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_LARGER, a, b); }
static inline TapeId tape_smaller(Tape *t, TapeId a, TapeId b) { return tape_two(t, TAPE_SMALLER, a, b); }
static inline TapeId tape_scale(Tape *t, double by, TapeId a) { return tape_multiply(t, tape_number(t, by), a); }
static inline TapeId tape_negative(Tape *t, TapeId a) { return tape_scale(t, -1, a); }
static inline TapeId tape_magnitude(Tape *t, TapeId a) { return tape_larger(t, a, tape_negative(t, a)); }
/* Between -limit and limit. */
static inline TapeId tape_clamp(Tape *t, TapeId a, TapeId limit) {
    return tape_larger(t, tape_smaller(t, a, limit), tape_negative(t, limit));
}
