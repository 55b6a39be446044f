/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation_training/relation_launches.h"

#include "solvers/sain.h"
#include "solvers/solvers.h"

#include <stdlib.h>

static bool make_by_name(const ContactSolverKind *kind, const char *text, ContactSolver *solver, Error *error) {
    Settings settings;
    if (!settings_parse(&settings, text, kind->description.settings, kind->description.name, error)) return false;
    void *state = kind->create(&settings, error);
    if (state != NULL) *solver = (ContactSolver){kind, state};
    return state != NULL;
}

static bool make_solver(void *context, int i, ContactSolver *solver, Error *error) {
    const RelationDriver *driver = ((const RelationLaunches *)context)->driver;
    if (driver != NULL) return sain_make(solver, driver->network, driver->form, error);
    return i % 2 == 0 ? make_by_name(&solver_engine, RELATION_ENGINE_SETTINGS, solver, error)
                      : make_by_name(&solver_momentum, "k=50", solver, error);
}

/* Launches rise along the family: a round takes every so manieth, so that each covers the family. */
static bool record_scene(const RelationLaunches *from, const Scene *scene, ImpactProblems *problems,
                         const Progress *progress, Error *error) {
    const int all = from->rounds * from->launches;
    Launch *launches = malloc((size_t)all * sizeof *launches);
    if (launches == NULL) return error_memory(error, scene->name);
    bool ok = from->held_out ? launches_for_scoring(scene, all, launches, error)
                             : launches_for_training(scene, all, launches, error);
    for (int i = 0; ok && i < from->launches; i++) launches[i] = launches[i * from->rounds + from->round];
    RelationLaunches context = *from;
    const RelationRecording recording = {scene, launches, from->launches, make_solver, &context};
    ok = ok && relation_record(&recording, problems, progress, error);
    free(launches);
    return ok;
}

bool relation_launches_record(const RelationLaunches *launches, ImpactProblems *problems, const Progress *progress,
                              Error *error) {
    for (int s = 0; s < launches->scene_count; s++)
        if (!record_scene(launches, launches->scenes[s], problems, progress, error)) return false;
    return true;
}
