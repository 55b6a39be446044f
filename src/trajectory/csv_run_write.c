/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/csv_run.h"

#include "common/file.h"

#include <inttypes.h>
#include <string.h>

/* Nine digits keep every bit of a float32. */
static void print_head(FILE *out, const Trajectory *run) {
    fprintf(out, "# scene: %s\n# method: %s\n", run->scene, run->method);
    if (run->iterations > 0) fprintf(out, "# iterations: %d\n", run->iterations);
    if (run->scene_hash != 0) fprintf(out, "# scene_hash: %016" PRIx64 "\n", run->scene_hash);
    fprintf(out, "# dt: %.9g\n", (double)run->dt);
    if (run->bomb >= 0) fprintf(out, "# bomb: %d\n", run->bomb);
    if (run->camera_size.x > 0 && run->camera_size.y > 0)
        fprintf(out, "# camera: %.9g,%.9g,%.9g,%.9g\n", (double)run->camera_center.x, (double)run->camera_center.y,
                (double)run->camera_size.x, (double)run->camera_size.y);
    for (int body = 0; body < run->bodies; body++)
        fprintf(out, "# size: %d,%.9g,%.9g,%s\n", body, (double)run->size[body].x, (double)run->size[body].y,
                run->fixed[body] ? "static" : "dynamic");
}

/* Whether a body that is not static is there. */
static bool has_dynamic(const Trajectory *run, int frame) {
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && trajectory_has(run, frame, body)) return true;
    return false;
}

/* A static body is written once, as readers keep it where it is, and where it is alone: each frame has a row. */
static bool is_shown(const Trajectory *run, int frame, int body, bool alone) {
    const size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body, before = i - (size_t)run->bodies;
    if (!trajectory_has(run, frame, body)) return false;
    return !run->fixed[body] || alone || frame == 0 || !trajectory_has(run, frame - 1, body) ||
           memcmp(&run->position[i], &run->position[before], sizeof(Vec2)) != 0 ||
           memcmp(&run->angle[i], &run->angle[before], sizeof(float)) != 0 ||
           memcmp(&run->velocity[i], &run->velocity[before], sizeof(Vec2)) != 0 ||
           memcmp(&run->angular_velocity[i], &run->angular_velocity[before], sizeof(float)) != 0;
}

static void print_row(FILE *out, const Trajectory *run, int frame, int body) {
    const size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    const Vec2 position = run->position[i], velocity = run->velocity[i];
    fprintf(out, "%d,%d,%.9g,%.9g,%.9g", frame, body, (double)position.x, (double)position.y, (double)run->angle[i]);
    if (!run->no_velocities)
        fprintf(out, ",%.9g,%.9g,%.9g", (double)velocity.x, (double)velocity.y, (double)run->angular_velocity[i]);
    fputc('\n', out);
}

static void print_run(FILE *out, const void *context) {
    const Trajectory *run = context;
    print_head(out, run);
    fprintf(out, "frame,body,x,y,angle%s\n", run->no_velocities ? "" : ",vx,vy,omega");
    for (int frame = 0; frame < run->frames; frame++) {
        const bool alone = !has_dynamic(run, frame);
        for (int body = 0; body < run->bodies; body++)
            if (is_shown(run, frame, body, alone)) print_row(out, run, frame, body);
    }
}

bool csv_run_write(const Trajectory *run, const char *path, Error *error) {
    return file_write_text(path, print_run, run, error);
}
