/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A piece of the speed-accuracy study: a launch of a scene with all methods, which share its converged run and its frozen
   steps. */
#pragma once
#include "common/progress.h"
#include "study/scene_study.h"

#include <stdio.h>

/* Scores all contenders of the study on the launch, in parallel, and writes the scores (study/method_scores.h). Called from
   several threads at once, it uses one thread each. */
bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error);
