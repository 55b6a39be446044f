/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_studies.h"

#include <string.h>

/* clang-format off */
/* from, to, points */
#define LINEAR(...) \
    { __VA_ARGS__, .whole = false }
#define WHOLE(...) \
    { __VA_ARGS__, .whole = true }
#define LOGARITHMIC(...) \
    { __VA_ARGS__, .logarithmic = true }
#define WHOLE_LOGARITHMIC(...) \
    { __VA_ARGS__, .logarithmic = true, .whole = true }

const StabilityStudy stability_studies[] = {
    {"stack_height", "stack_height", "height", WHOLE(2, 40, 14), .stands = true, .quick = true, .weight = 18},
    {"stack_cold", "stack_cold", "height", WHOLE(2, 40, 14), .stands = true, .weight = 18},
    {"iterations", "stack_height", "iterations", WHOLE_LOGARITHMIC(1, 100, 12, .fails_low = true), .stands = true,
     .iterations = true, .quick = true, .weight = 4},
    {"iterations_cold", "stack_cold", "iterations", WHOLE_LOGARITHMIC(1, 100, 12, .fails_low = true), .stands = true,
     .iterations = true, .weight = 5},
    {"time_step", "time_step", "rate", WHOLE_LOGARITHMIC(20, 480, 10, .fails_low = true), .stands = true, .weight = 17},
    {"pyramid_rows", "pyramid_rows", "rows", WHOLE(4, 30, 9), .stands = true, .weight = 69},
    {"pyramid_rate", "pyramid_rows", "rate", WHOLE_LOGARITHMIC(10, 480, 10, .fails_low = true), .stands = true,
     .weight = 47},
    {"heavy_on_one", "heavy_on_one", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true, .quick = true, .weight = 2},
    {"heavy_on_five", "heavy_on_five", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 9},
    {"heavy_on_nine", "heavy_on_nine", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 18},
    {"plate", "plate", "ratio", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 3},
    {"gate", "gate", "mass", LOGARITHMIC(1, 1000, 13), .stands = true, .weight = 12},
    {"top_removed", "top_removed", "ratio", LOGARITHMIC(1, 200, 12), .stands = true, .weight = 5},
    {"tilted_stack", "tilted_stack", "shift", LINEAR(0, 0.1, 11), .stands = true, .weight = 7},
    {"overlap", "overlap", "spacing", LINEAR(0.4, 1, 13, .fails_low = true), .stands = true, .weight = 8},
    {"card_house", "card_house", "friction", LINEAR(0.1, 1, 10, .fails_low = true), .stands = true, .weight = 8},
    {"arch", "arch", "friction", LINEAR(0.2, 1, 9, .fails_low = true), .stands = true, .weight = 3},
    {"double_domino", "double_domino", "push", LINEAR(0, 3, 7), .weight = 5},
    {"friction_ramp", "friction_ramp", "slope", LINEAR(0, 0.6, 13), .stands = true, .quick = true, .weight = 1},
    {"far_from_origin", "far_from_origin", "distance", LOGARITHMIC(1, 1e6, 13), .stands = true, .unshifted = true,
     .quick = true, .weight = 2},
    {"at_rest", "at_rest", "height", WHOLE(1, 20, 10), .stands = true, .rests = true, .weight = 13},
    {"bomb_speed", "bomb_speed", "speed", LOGARITHMIC(5, 200, 12), .quick = true, .weight = 0.5},
    {"bomb_speed_thick", "bomb_speed", "speed", LOGARITHMIC(5, 200, 12), .fixed = {"thickness", 1}, .weight = 0.5},
    {"bomb_mass", "random_bombs", "mass", LOGARITHMIC(1, 1000, 13), .weight = 2},
    {"bomb_spin", "random_bombs", "spin", LINEAR(0, 20, 11), .weight = 1},
    {"beyond_x", "beyond_training", "x", LINEAR(0, 15, 16), .weight = 1},
    {"beyond_mass", "beyond_training", "mass", LOGARITHMIC(5, 1000, 13), .weight = 1}};

#define ITERATIONS {"iterations", WHOLE_LOGARITHMIC(1, 100, 10), 4}

const StabilityMap stability_maps[] = {
    {.name = "height_iterations", .scene = "stack_height", .x = {"height", WHOLE(2, 40, 10), 4}, .y = ITERATIONS,
     .stands = true, .iterations = true, .quick = true, .weight = 44},
    {.name = "ratio_iterations", .scene = "heavy_on_one", .x = {"ratio", LOGARITHMIC(1, 1000, 10), 4}, .y = ITERATIONS,
     .stands = true, .iterations = true, .quick = true, .weight = 4},
    {.name = "rate_height", .scene = "time_step", .x = {"rate", WHOLE_LOGARITHMIC(20, 480, 8), 3},
     .y = {"height", WHOLE(2, 40, 8), 3}, .stands = true, .weight = 300},
    {.name = "speed_thickness", .scene = "bomb_speed", .x = {"speed", LOGARITHMIC(5, 200, 12), 5},
     .y = {"thickness", LOGARITHMIC(0.1, 2, 10), 4}, .quick = true, .weight = 3},
    {.name = "spin_x", .scene = "random_bombs", .x = {"spin", LINEAR(0, 20, 11), 4}, .y = {"x", LINEAR(-5, 5, 11), 4},
     .quick = true, .weight = 10},
    /* The grid avoids the border, where the slope equals the friction. */
    {.name = "slope_friction", .scene = "friction_ramp", .x = {"slope", LINEAR(0.025, 0.575, 12), 4},
     .y = {"friction", LINEAR(0.05, 0.6, 12), 4}, .stands = true, .weight = 2}};
/* clang-format on */

const int stability_study_count = sizeof stability_studies / sizeof stability_studies[0];
const int stability_map_count = sizeof stability_maps / sizeof stability_maps[0];

const StabilityStudy *stability_study_find(const char *name) {
    for (int i = 0; i < stability_study_count; i++)
        if (strcmp(stability_studies[i].name, name) == 0) return &stability_studies[i];
    return NULL;
}
