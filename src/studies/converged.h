/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a converged run, and the verdict on others of the same scene beside it:

       EnergyLog converged = {0};
       energy_log_run(&converged, scene, &reference, error);
       VerdictRun run = verdict_run_of(scene, &method);
       run.converged = &converged;
       verdict_run(&reading, scene, &method, &run, error); */
#pragma once
#include "runs/verdict.h"

void energy_log_free(EnergyLog *log);

/* Runs a scene with a method and logs it. ERROR_INPUT also if the method fails (MethodFailure). */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);

/* Runs the scene with the method until the verdict is final. A method that fails is a verdict, not an error. False with
   error set if the method cannot be created, the launch is refused, too many bodies are near each other, or memory is
   short. */
bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, const VerdictRun *run,
                 Error *error);
