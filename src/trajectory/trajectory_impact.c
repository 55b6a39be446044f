/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory.h"

static bool is_of_bomb_and_box(const Trajectory *trajectory, const TrajectoryContact *contact) {
    if (contact->a != trajectory->bomb && contact->b != trajectory->bomb) return false;
    return !trajectory->fixed[contact->a] && !trajectory->fixed[contact->b];
}

int trajectory_impact(const Trajectory *trajectory) {
    if (trajectory->bomb < 0) return -1;
    for (int step = 1; step < trajectory->frames; step++)
        for (int64_t i = trajectory->contact_start[step]; i < trajectory->contact_start[step + 1]; i++)
            if (is_of_bomb_and_box(trajectory, &trajectory->contacts[i])) return step;
    return -1;
}
