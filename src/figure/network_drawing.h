/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two ways in which a network is shown: by its units, or where these are too many by its matrices. */
#pragma once
#include "figure/run_figures.h"
#include "network/network.h"
#include "network/slot_network.h"

/* Beyond so many units in a layer its matrices are shown. */
enum { UNITS_MOST = 40 };

/* Sign and size of a weight as a colour: blue above 0, orange below, white at 0; darker blue is what tells the signs
   apart in grey. `share` of the largest: -1 .. 1. */
uint32_t weight_colour(double share);

/* A title, cut to the page. */
void put_network_title(Sketch *sketch, const FigureSpec *spec, const char *title);

/* Its height, mm. */
double network_title_height(const FigureSpec *spec);

/* Begins the sketch. */
bool draw_units(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error);
bool draw_dense_matrices(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error);
bool draw_slot_matrices(Sketch *sketch, const FigureSpec *spec, const SlotNetwork *network, Error *error);

/* "sigmoid" */
const char *activation_word(Activation activation);

/* "10-10-2" */
enum { WIDTHS_TEXT_SIZE = 64 };
void write_widths(char text[WIDTHS_TEXT_SIZE], const Network *network);
