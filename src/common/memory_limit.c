/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/memory_limit.h"

#include <stdio.h>
#include <sys/resource.h>

MemoryLimit memory_limit(void) {
    static const struct {
        int resource;
        char letter; /* of the shell's ulimit */
    } kinds[] = {{RLIMIT_AS, 'v'}, {RLIMIT_DATA, 'd'}};
    rlim_t least = RLIM_INFINITY;
    MemoryLimit limit = {""};
    for (int i = 0; i < 2; i++) {
        struct rlimit found;
        if (getrlimit(kinds[i].resource, &found) != 0 || found.rlim_cur == RLIM_INFINITY || found.rlim_cur >= least)
            continue;
        least = found.rlim_cur;
        snprintf(limit.text, sizeof limit.text, "; the memory of a process is limited to %llu MiB (ulimit -%c)",
                 (unsigned long long)least >> 20, kinds[i].letter);
    }
    return limit;
}
