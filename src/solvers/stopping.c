/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/stopping.h"

#include "solvers/residual.h"

bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error) {
    int more = rule->more;
    if (more == 0 && settings_get(chosen, "near") == NULL)
        return settings_get(chosen, "more") == NULL ||
               error_input(error, "more", "needs near: sweeps follow while the residual is at least near");
    if (more == 0) more = STOPPING_MORE;
    if (!settings_float(chosen, "near", 0, 1e6f, &rule->near, error) ||
        !settings_int(chosen, "more", 1, SWEEPS_MAX, &more, error))
        return false;
    rule->more = (more + STOPPING_BLOCK - 1) / STOPPING_BLOCK * STOPPING_BLOCK;
    return true;
}

bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem) {
    return done < rule->more && residual_reaches(sweeps, problem->contact_count, rule->near);
}

bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution) {
    return done < rule->more && residual_reaches_scalar(problem, solution, rule->near);
}

bool stopping_run(const StoppingRule *rule, Sweeps *sweeps, const ContactProblem *problem, int k,
                  bool (*run)(Sweeps *, int)) {
    sweeps->block = rule->more > 0 ? STOPPING_BLOCK : 0;
    if (!run(sweeps, k)) return false;
    for (int done = 0; stopping_needs_more(rule, done, sweeps, problem); done += STOPPING_BLOCK)
        if (!run(sweeps, STOPPING_BLOCK)) return false;
    return true;
}
