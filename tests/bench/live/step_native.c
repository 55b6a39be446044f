/* SPDX-License-Identifier: GPL-3.0-or-later */
/* step_native SCENE METHOD RUNS: the functions of the module (src/live/live.h) as part of a program. Prints the milliseconds of a run
   and the hash of its last frame. Of each ten steps the fastest of all runs counts, as other processes interrupt. */
#include "base/base.h"
#include "base/machine.h"
#include "live/bundle.h"
#include "live/live.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 10, PARTS_MAX = 10000 };

/* Networks come from files. */
void bundle_use(Bundle bundle) { (void)bundle; }

/* Steps a run to its end. Returns the hash of its last frame, 0 for an error. */
static uint64_t time_run(LiveScene *scene, const char *method, double best[PARTS_MAX]) {
    LiveRun *run = scene != NULL ? live_begin(scene, "", method, 1) : NULL;
    if (run == NULL) return 0;
    const int last = live_frames(run) - 1;
    int frame = 0;
    for (int part = 0; frame < last && part < PARTS_MAX; part++) {
        const double began = clock_seconds();
        frame = live_step(run, STEPS);
        best[part] = fmin(best[part], 1e3 * (clock_seconds() - began));
    }
    const uint64_t hash = live_hash(run, frame);
    live_end(run);
    return hash;
}

int main(int argc, char **argv) {
    static double best[PARTS_MAX];
    void *bundle = NULL;
    size_t size = 0;
    uint64_t hash = 0;
    double sum = 0;
    Error error = {0};
    if (argc != 4) return 2;
    if (!live_pack(argv[1], (const char *const *)&argv[2], 1, &bundle, &size, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    for (int part = 0; part < PARTS_MAX; part++) best[part] = HUGE_VAL;
    LiveScene *scene = live_open(bundle, (int)size);
    for (int i = atoi(argv[3]); i > 0; i--) hash = time_run(scene, argv[2], best);
    if (hash == 0) fprintf(stderr, "%s\n", live_error());
    for (int part = 0; part < PARTS_MAX && isfinite(best[part]); part++) sum += best[part];
    printf("%g %016" PRIx64 "\n", sum, hash);
    live_close(scene);
    return hash == 0;
}
