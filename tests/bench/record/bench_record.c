/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For wait4(). */
#define _DEFAULT_SOURCE
/* What recording adds to the steps of a run: runs of the pyramid by the engine without a recorder, with one, with one
   that writes a .npz, and with one that writes it without contacts. Each run is a process of its own; the kinds take
   turns. Files are written to TMPDIR, or /tmp. */
#include "report.h"

#include "runs/runs.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { RUNS = 5, KINDS = 4, LENGTHS = 1 };

static const int lengths[LENGTHS] = {24000}; /* steps */

static const struct {
    const char *name;
    bool records, writes, no_contacts;
} kinds[KINDS] = {{"steps", false, false, false},
                  {"recorded", true, false, false},
                  {"written", true, true, false},
                  {"written without contacts", true, true, true}};

static void check(bool done, const Error *error) {
    if (done) return;
    fprintf(stderr, "%s\n", error->message);
    _exit(3);
}

static const char *output_path(void) {
    static char path[512];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/bench_record.npz", folder != NULL ? folder : "/tmp");
    return path;
}

static void run(int kind, int steps) {
    Error error = {0};
    Method method;
    Scene *scene = scene_read(SOURCE_DIR "/scenes/pyramid.yaml", &error);
    check(scene != NULL && method_parse(&method, "engine", &error), &error);
    scene->frames = steps;
    const RecorderOutput output = {output_path(), TRAJECTORY_NPZ};
    RunWatch watch = {0};
    if (kinds[kind].records)
        watch.recorder =
            recorder_create_to(scene, &method, &output, kinds[kind].writes, kinds[kind].no_contacts, &error);
    check(!kinds[kind].records || watch.recorder != NULL, &error);
    check(simulate_watched(scene, &method, &watch, &error), &error);
    check(!kinds[kind].records || recorder_finish(watch.recorder, &error), &error);
}

typedef struct Cost {
    double wall, processor; /* s */
    double memory;          /* MiB */
} Cost;

static double seconds(struct timeval time) { return (double)time.tv_sec + 1e-6 * (double)time.tv_usec; }

static Cost measure(int kind, int steps) {
    const double start = clock_seconds();
    const pid_t child = fork();
    if (child == 0) {
        run(kind, steps);
        _exit(0);
    }
    struct rusage usage;
    int status;
    if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0) exit(3);
    return (Cost){.wall = clock_seconds() - start,
                  .processor = seconds(usage.ru_utime) + seconds(usage.ru_stime),
                  .memory = (double)usage.ru_maxrss / 1024};
}

static void measure_length(int steps, bool is_target) {
    Samples wall[KINDS] = {0}, processor[KINDS] = {0}, memory[KINDS] = {0}, ratio[KINDS] = {0}, work[KINDS] = {0};
    for (int i = 0; i < RUNS; i++) {
        Cost cost[KINDS];
        for (int k = 0; k < KINDS; k++) {
            cost[k] = measure(k, steps);
            samples_add(&wall[k], cost[k].wall);
            samples_add(&processor[k], cost[k].processor);
            samples_add(&memory[k], cost[k].memory - cost[0].memory);
            samples_add(&ratio[k], cost[k].wall / cost[0].wall);
            samples_add(&work[k], cost[k].processor / cost[0].processor);
        }
    }
    char figure[64];
    for (int k = 0; k < KINDS; k++) {
        snprintf(figure, sizeof figure, "pyramid %d steps", steps);
        report_line("record", kinds[k].name, figure, "s", &wall[k]);
        report_line("record", kinds[k].name, figure, "processor s", &processor[k]);
        report_line("record", kinds[k].name, figure, "time / steps", &ratio[k]);
        report_line("record", kinds[k].name, figure, "processor time / steps", &work[k]);
        report_line("record", kinds[k].name, figure, "MiB more", &memory[k]);
    }
    if (!is_target) return;
    report_target("recorded / steps, processor time", samples_median(&work[1]), "at most", 1.1);
    report_target("written / steps, time", samples_median(&ratio[2]), "at most", 1.5);
    report_target("memory of a recorded run, MiB more", samples_median(&memory[2]), "at most", 64);
}

int main(void) {
    report_header();
    for (int i = 0; i < LENGTHS; i++) measure_length(lengths[i], i == 0);
    unlink(output_path());
    return 0;
}
