/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network is drawn as units, or as matrices if it has too many units. */
#pragma once
#include "figure/figure.h"
#include "network/network.h"
#include "network/slot_network.h"

/* With more units in a layer, the matrices are drawn. */
enum { UNITS_MAX = 40 };

/* The colour of a weight, `share` of the largest, -1 .. 1: blue above 0, orange below, white at 0. The blue is
   darker, which distinguishes the signs in grey prints. */
uint32_t weight_colour(double share);

/* A title, shortened to the page's width. */
void draw_network_title(Sketch *sketch, const FigureSpec *spec, const char *title);

/* In mm. */
double network_title_height(const FigureSpec *spec);

/* Each begins the sketch. */
bool draw_units(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error);
bool draw_dense_matrices(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error);
bool draw_slot_matrices(Sketch *sketch, const FigureSpec *spec, const SlotNetwork *network, Error *error);

/* "sigmoid" */
const char *activation_name(Activation activation);

/* "10-10-2" */
enum { WIDTHS_TEXT_SIZE = 64 };
void format_widths(char text[WIDTHS_TEXT_SIZE], const Network *network);
