/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The backward pass of the network of gns: reverse mode, by hand, the steps of methods/gns_graph.c in reverse order.
   float32 as the forward pass, sums in one order. Source: Rumelhart, Hinton, Williams, "Learning representations by
   back-propagating errors" (1986).

       gns_transpose(&layout, parameters, transposed);
       gns_forward(&pass, &layout, parameters, &graph);    pass.tape is true
       gns_backward(&back, &pass, &layout, parameters, transposed, &graph, output_slopes, gradient); */
#pragma once
#include "methods/gns_graph.h"
#include "nets/kinds.h"

/* Work space; zero-initialise. */
typedef struct GnsBackward {
    float *of_node, *of_edge, *of_sum, *of_receiver, *of_sender; /* d loss / d ..., [nodes or edges, width] */
    float *slopes, *second, *first;                              /* of a perceptron's layers, [rows, width] */
    float *numbers;
    size_t capacity;
} GnsBackward;

void gns_backward_free(GnsBackward *back);

/* Every weight matrix of the parameters that a backward pass uses, transposed, at its place; that of a round's first
   layer part by part. */
void gns_transpose(const GnsLayout *layout, const float *parameters, float *transposed);

/* After gns_forward with a tape: adds d loss / d parameters to gradient, from output_slopes[nodes, GNS_OUTPUTS] = d
   loss / d outputs. False when memory is short. */
bool gns_backward(GnsBackward *back, const GnsPass *pass, const GnsLayout *layout, const float *parameters,
                  const float *transposed, const GnsGraph *graph, const float *output_slopes, float *gradient);
