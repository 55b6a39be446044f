/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of the picture. They depend only on the trajectories and options, not on the machine or the time. */
#pragma once
#include "picture/caption_size.h"
#include "picture/picture.h"
#include "picture/text_lines.h"

/* The title, on up to TEXT_LINES_MAX lines, and the slow motion; at the right the frame, the simulated time and, for two
   panels, their distance. */
void caption_header(const Picture *picture, Moment moment, Drawing *drawing);

/* Above a panel, its method and, if there are more than two runs, its distance from the first run. What does not fit is
   shortened or left out in this order: the description, the label of the distance, the number of bodies out of view (which
   then stands in the panel), the distance, the end of the name. */
void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* The title in the header: its first line beside the numbers at the right, in any frame. */
TextLines caption_header_title(const Picture *picture);

/* Pixels that a panel needs for the shortest form of any run's name; or for the whole name beside a distance. */
int caption_least_width(const Picture *picture, bool whole);

/* Two panels side by side: the header shows their distance, the only one. */
bool caption_is_pair(const Picture *picture);

/* Draws a name in at most `room` pixels: in the font if it fits, otherwise in the small one, there cut if need be. Returns
   the x where it ends. */
int caption_name_draw(const Picture *picture, const Font *font, const char *name, int x, int baseline, int room,
                      Drawing *drawing);

/* Shares room between texts of these widths: the largest width that none has to exceed for all to fit. */
int caption_fair_width(const int *widths, int count, int room);

/* "pyramid_settled" -> "Pyramid settled": the options' title, or the scene's name. */
void caption_title(const Picture *picture, char title[CAPTION_SIZE]);

/* The name of a run's method (common/method_look.h) and what it is: "engine" and "physics engine, sequential impulses"; the
   second may be empty. Or the caption that the options set for the run, without a second. */
void caption_method(const Picture *picture, int run, char name[CAPTION_SIZE], char note[CAPTION_SIZE]);

/* Text after the name: the options' note, the cost and what the method is. */
void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size);

/* Formats a distance for captions with at most four characters: "0.35", "35.2", "352", ">999", or a dash for NaN. */
void caption_distance(char *text, size_t size, double metres);
