/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of the picture. Nothing here depends on the machine or the hour, only on the trajectories. */
#pragma once
#include "picture/picture.h"

/* The scene, what is slowed down, and at the right the frame, the simulated time and, of two panels, how far apart they
   are. */
void caption_header(const Picture *picture, Moment moment, Drawing *drawing);

/* What solved a panel, above it, and how far it is from the first where more than two runs could be meant. */
void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing);

enum { CAPTION_SIZE = 256 };

/* "pyramid_settled" -> "Pyramid settled": the options' title, or the scene's name. */
void caption_title(const Picture *picture, char title[CAPTION_SIZE]);

/* What solved a run, in two parts: "Physics engine" and "sequential impulses, engine"; the second may be empty. */
void caption_method(const Picture *picture, int run, char title[CAPTION_SIZE], char note[CAPTION_SIZE]);

/* Behind the title: the options' note, the cost and the method's note. */
void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size);

/* A distance as captions have it: "0.35", ">1000", or a dash where there is none. */
void caption_distance(char *text, size_t size, double metres);
