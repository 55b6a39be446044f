/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a watch looks for in one step: each check takes note of what it finds. They come before the watch remembers the
   step's places as the last ones. */
#pragma once
#include "stability/verdict.h"

/* Keeps the reading where it is worse than what there is. */
void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit);

/* True where all numbers are finite. */
bool check_finite(VerdictWatch *watch, const VerdictStep *step);
void check_energy(VerdictWatch *watch, const VerdictStep *step);
void check_tunnels(VerdictWatch *watch, const VerdictStep *step);
void check_depth(VerdictWatch *watch, const VerdictStep *step);
void check_falls(VerdictWatch *watch, const VerdictStep *step);
void check_creep(VerdictWatch *watch, const VerdictStep *step);
void check_calm(VerdictWatch *watch, const VerdictStep *step);

/* Steps that come nearest to so many seconds; at least one. */
int verdict_steps(double seconds, float dt);

/* m */
double verdict_distance(Vec2 from, Vec2 to);
