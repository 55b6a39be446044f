/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checks of a watch for one step. They run before the watch stores the step's positions as the last ones. */
#pragma once
#include "stability/verdict.h"

/* Stores the verdict if it is worse than the worst so far. */
void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit);

/* False if a body's state is NaN or infinite. */
bool check_finite(VerdictWatch *watch, const VerdictStep *step);
void check_energy(VerdictWatch *watch, const VerdictStep *step);
void check_tunnels(VerdictWatch *watch, const VerdictStep *step);
void check_depth(VerdictWatch *watch, const VerdictStep *step);
void check_falls(VerdictWatch *watch, const VerdictStep *step);
void check_creep(VerdictWatch *watch, const VerdictStep *step);
void check_calm(VerdictWatch *watch, const VerdictStep *step);

/* Seconds rounded to whole steps; at least one. */
int verdict_steps(double seconds, float dt);
