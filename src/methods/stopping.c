/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stopping rule of the iterative methods. */
#include "base/base.h"
#include "base/settings.h"
#include "engine/engine.h"
#include "methods/residual.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <stdlib.h>

bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error) {
    static const SettingSpec known[] = {{"near", NULL, SETTING_FLOAT(StoppingRule, near, 0, 1e6f)},
                                        {"more", NULL, SETTING_INT(StoppingRule, more, 1, SWEEPS_MAX)},
                                        {0}};
    if (rule->more == 0 && settings_get(chosen, "near") == NULL)
        return settings_get(chosen, "more") == NULL ||
               error_input(error, "more", "needs near: sweeps follow while the residual is at least near");
    if (rule->more == 0) rule->more = STOPPING_MORE;
    if (!settings_read(chosen, known, rule, error)) return false;
    rule->more = (rule->more + STOPPING_BLOCK - 1) / STOPPING_BLOCK * STOPPING_BLOCK;
    return true;
}

void *stopping_make(const Settings *chosen, const SettingSpec *known, const void *standard, size_t size,
                    const char *what, Error *error) {
    StoppingRule *rule = settings_make(chosen, known, standard, size, what, error);
    if (rule == NULL || stopping_read(rule, chosen, error)) return rule;
    free(rule);
    return NULL;
}

bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem) {
    return done < rule->more && residual_reaches(sweeps, problem->contact_count, rule->near);
}

bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution) {
    return done < rule->more && residual_reaches_scalar(problem, solution, rule->near);
}
