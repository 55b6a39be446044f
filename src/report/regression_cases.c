/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_cases.h"

#include "common/file.h"

int regression_case_count(const Regression *regression) { return regression->count + regression->run_count; }

static RegressionCase frame_case(const RegressionFrame *frame) {
    RegressionCase made = {.kind = "frames",
                           .name = frame_name(frame),
                           .verdict = frame_verdict(frame),
                           .failed = frame_failed(frame),
                           .words = frame_words(frame),
                           .seconds = frame->seconds,
                           .frame = frame};
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (frame->at[side] != NULL && !file_path(made.paths[side], PATH_MAX, &(Error){0}, "%s", frame->at[side]->path))
            made.paths[side][0] = '\0';
    return made;
}

RegressionCase regression_case(const Regression *regression, int i) {
    if (i < regression->count) return frame_case(&regression->frames[i]);
    const RegressionRun *run = &regression->runs[i - regression->count];
    RegressionCase made = {.kind = "trajectories",
                           .name = run->name,
                           .verdict = run->difference.equal ? "equal" : "physics changed",
                           .failed = !run->difference.equal,
                           .words = run_words(run),
                           .seconds = run->seconds};
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!file_path(made.paths[side], PATH_MAX, &(Error){0}, "%s/%s", regression->sequences[side]->folder,
                       run->name))
            made.paths[side][0] = '\0';
    return made;
}
