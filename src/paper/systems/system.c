/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/system.h"

#include <stddef.h>

#define SYSTEM_LISTED(name) &system_##name,
const PaperSystem *const paper_systems[] = {SYSTEMS(SYSTEM_LISTED) NULL};

bool system_part_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    const SystemWork *work = context;
    return work->part->write(work->study, work->part->index, lines, progress, error);
}
