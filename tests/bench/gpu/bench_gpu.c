/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks on a graphics device beside the same on the cores, in turns: pairs from main memory to main memory, and
   without transfers; in one call and in many; steps of a pyramid, and of 4,096. Lines have the device's name: that of
   Mesa's software renderer ("llvmpipe") says nothing of a graphics card. Draws out/gpu.svg. */
#include "gpu.h"
#include "report.h"

#include "base/file.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/pair_net.h"
#include "nets/kernels.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#ifdef TWINBOX_EGL
#include <EGL/egl.h>
#include <EGL/eglext.h>
#endif

enum { SIZES = 7, PAIRS_MAX = 1000000, TURNS = 11, STEPS = 4, CONTACTS = 200, LAUNCHES = 64, WORLDS = 4096, WAYS = 12 };
enum { SCRATCH = 8192, SETTLED = 150 }; /* numbers, of which the widest network takes half; frames until boxes rest */

static const int sizes[SIZES] = {1, 10, CONTACTS, 1000, 10000, 100000, PAIRS_MAX};
static const double shortest = 2e-3; /* s: of a sample, far above the clock's resolution */
static const double longest = 0.25;  /* s: of the samples of a figure */

static Error error;
static Gpu gpu;

static void check(bool ok) {
    if (!ok) give_up(error.message);
}

/* The first graphics card with compute shaders, else what the program draws with. */
static bool open_device(void) {
    void *state;
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
#ifdef TWINBOX_EGL
    PFNEGLGETPROCADDRESSPROC find;
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (context_load("libEGL.so.1", "libegl1", &(ContextFunction){"eglGetProcAddress", 0}, 1, &find, &error)) {
        PFNEGLQUERYDEVICESEXTPROC query = (PFNEGLQUERYDEVICESEXTPROC)find("eglQueryDevicesEXT");
        if (query != NULL) query(sizeof devices / sizeof *devices, devices, &count);
    }
    for (EGLint i = 0; i < count; i++)
        if ((state = context_egl_open(EGL_PLATFORM_DEVICE_EXT, devices[i], 4, 3, &error)) != NULL &&
            gpu_open(&gpu, (Context){&context_egl, state}, &error))
            return true;
#endif
    const ContextKind *kind = context_kinds[0];
    return (state = kind->create(&error)) != NULL && gpu_open(&gpu, (Context){kind, state}, &error);
}

/* How a network is evaluated, and what a figure takes that way. */
typedef struct Way {
    char name[128];
    const Kernels *kernels; /* NULL: on the device */
    int threads;            /* also of the rest of a step */
    bool half, stays;       /* float16; without transfers */
    Samples us, network_us; /* the second: of the network in a step */
    double plotted[SIZES];  /* us */
} Way;

static Way ways[WAYS];
static int way_count;

static void add_ways(bool device) {
    const Kernels *list[KERNELS_MAX + 1];
    const int cores = omp_get_num_procs();
    kernels_list(list);
    for (int k = 0; list[k] != NULL; k++)
        for (int threads = 1; threads <= cores; threads += cores > 1 ? cores - 1 : 1, way_count++) {
            ways[way_count] = (Way){.kernels = list[k], .threads = threads};
            snprintf(ways[way_count].name, sizeof ways->name, "%s %d core%s", list[k]->name, threads, plural(threads));
        }
    for (int i = 0; device && i < 4; i++, way_count++) {
        ways[way_count] = (Way){.threads = cores, .half = i >= 2, .stays = i % 2 == 1};
        snprintf(ways[way_count].name, sizeof ways->name, "%s%s%s", gpu.name, i >= 2 ? " float16" : "",
                 i % 2 == 1 ? " without transfers" : "");
    }
}

/* What a figure measures: a network on so many pairs in so many calls, or steps of so many worlds. */
typedef struct Job {
    Network *network;
    GpuNet nets[2]; /* float32 and float16; without room: the device has none */
    int pairs, calls, worlds;
} Job;

static float in[PAIRS_MAX * PAIR_INPUTS_MAX], out[PAIRS_MAX * PAIR_CHANGES]; /* of all jobs */

static Job job_begin(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/networks/%s.npz", SOURCE_DIR, name);
    Job job = {.network = network_read(path, &error), .calls = 1};
    check(job.network != NULL);
    for (size_t i = 0; i < sizeof in / sizeof *in; i++) in[i] = (float)(i * 7 % 401) / 50 - 4;
    for (int half = 0; gpu.context.state != NULL && half < 2; half++)
        check((gpu_network(&job.nets[half], &gpu, job.network, half, &error) &&
               gpu_run(&job.nets[half], in, out, 1, &error)) ||
              half > 0);
    return job;
}

static void job_end(Job *job) {
    for (int half = 0; half < 2; half++) gpu_net_free(&job->nets[half]);
    network_destroy(job->network);
}

static void on_cores(const Job *job, const Way *way, int pairs) {
    const int tiles = (pairs + TILE_ROWS - 1) / TILE_ROWS, threads = tiles < way->threads ? tiles : way->threads;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < tiles; i++) {
        float scratch[SCRATCH];
        const int first = i * TILE_ROWS, left = pairs - first;
        way->kernels->predict(job->network, in, scratch, out, pairs, first, left < TILE_ROWS ? left : TILE_ROWS);
    }
}

/* Returns the time that it takes, s. */
static double predict(Job *job, const Way *way) {
    const float *from = way->stays ? NULL : in;
    const double begun = clock_seconds();
    for (int call = 0, pairs = job->pairs / job->calls; call < job->calls; call++)
        if (way->kernels != NULL)
            on_cores(job, way, pairs);
        else
            check(gpu_run(&job->nets[way->half], from, way->stays ? NULL : out, (size_t)pairs, &error));
    return clock_seconds() - begun;
}

/* Copies of the settled pyramid, which step together by the network of six outputs: the changes of velocity of both
   bodies. All have the same pairs. */
static World *start, *worlds[WORLDS];
static ContactProblem problems[WORLDS];
static ContactSolution *solutions[WORLDS];
static float dt;

static void change(int w, int body, const float *by, int stride) {
    BodyVelocity *velocity = &solutions[w]->velocities[body];
    if (problems[w].bodies[body].inv_mass == 0) return;
    velocity->linear = vec2_add(velocity->linear, vec2(by[0], by[stride]));
    velocity->angular += by[2 * stride];
}

/* Fills the network's inputs, or applies its outputs, for the pairs of a world, of which all worlds have `stride`; 0:
   counts them. */
static int visit(int w, int row, int stride, bool apply) {
    const ContactProblem *problem = &problems[w];
    if (apply) contact_solution_begin(problem, solutions[w]);
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first), row++) {
        float numbers[PAIR_INPUTS_MAX];
        if (apply) change(w, problem->contacts[first].a, out + row, stride);
        if (apply) change(w, problem->contacts[first].b, out + row + 3 * stride, stride);
        if (apply || stride == 0) continue;
        pair_inputs(problem, NULL, first, PAIR_RELATIVE, numbers);
        for (int i = 0; i < PAIR_INPUTS; i++) in[i * stride + row] = numbers[i];
    }
    return row;
}

/* Returns the time that the network takes, s. */
static double step(Job *job, const Way *way) {
    const int threads = job->worlds < way->threads ? job->worlds : way->threads;
    bool ok = true;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(&& : ok)
    for (int w = 0; w < job->worlds; w++)
        ok = world_begin_step(worlds[w], dt, &problems[w], &solutions[w], &(Error){0}) && ok;
    const int each = visit(0, 0, 0, false);
    job->pairs = job->worlds * each;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(&& : ok)
    for (int w = 0; w < job->worlds; w++) ok = visit(w, w * each, job->pairs, false) == (w + 1) * each && ok;
    const double network = predict(job, way);
#pragma omp parallel for num_threads(threads) schedule(static) reduction(&& : ok)
    for (int w = 0; w < job->worlds; w++) {
        visit(w, w * each, job->pairs, true);
        ok = world_end_step(worlds[w], &(Error){0}) && ok;
    }
    check(ok || error_input(&error, "benchmark", "a world cannot step, or has other pairs"));
    return network;
}

/* Returns the time that is spent on it, s. */
static double sample(Job *job, Way *way) {
    double network = 0, taken;
    int count = 0;
    for (int w = 0; w < job->worlds; w++) check(world_copy(worlds[w], start, &error));
    const double begun = clock_seconds();
    do {
        network += job->worlds > 0 ? step(job, way) : predict(job, way);
        taken = clock_seconds() - begun;
    } while (++count < (job->worlds > 0 ? STEPS : INT_MAX) && taken < shortest);
    samples_add(&way->us, 1e6 * taken / count);
    samples_add(&way->network_us, 1e6 * network / count);
    return taken;
}

/* Ways take turns; slow ones have fewer. */
static void measure(Job *job, const char *figure) {
    double spent[WAYS] = {0};
    char network[96];
    snprintf(network, sizeof network, "%s: the network", figure);
    for (int i = 0; i < way_count; i++) ways[i].us.count = ways[i].network_us.count = 0;
    for (int turn = 0; turn < TURNS; turn++)
        for (Way *way = ways; way < ways + way_count; way++)
            if ((way->kernels != NULL || job->nets[way->half].room > 0) && !(way->stays && job->worlds > 0) &&
                spent[way - ways] < longest)
                spent[way - ways] += sample(job, way);
    for (Way *way = ways; way < ways + way_count; way++) {
        if (way->us.count > 0) report_line("gpu", way->name, figure, "us", &way->us);
        if (way->us.count > 0 && job->worlds > 0) report_line("gpu", way->name, network, "us", &way->network_us);
    }
}

static void measure_pairs(const char *name) {
    char figure[96];
    Job job = job_begin(name);
    for (int s = 0; s < SIZES; s++) {
        job.pairs = sizes[s];
        snprintf(figure, sizeof figure, "%s on %d pair%s", name, sizes[s], plural(sizes[s]));
        measure(&job, figure);
        for (int i = 0; i < way_count; i++)
            ways[i].plotted[s] = ways[i].us.count > 0 ? samples_median(&ways[i].us) : NAN;
    }
    job.pairs = LAUNCHES * CONTACTS;
    for (job.calls = 1; job.calls <= LAUNCHES; job.calls *= LAUNCHES) {
        snprintf(figure, sizeof figure, "%s on %d x %d pairs in %d call%s", name, LAUNCHES, CONTACTS, job.calls,
                 plural(job.calls));
        measure(&job, figure);
    }
    job_end(&job);
}

static void measure_steps(void) {
    Job job = job_begin("pair-net-six");
    Simulation run;
    Method engine;
    Scene *scene = scene_read(SOURCE_DIR "/scenes/pyramid_settled.yaml", &error);
    check(scene != NULL && method_parse(&engine, "engine", &error) && simulation_begin(&run, scene, &engine, &error));
    for (int frame = 1; frame <= SETTLED; frame++) check(simulation_step(&run, frame, &error));
    for (int w = 0; w < WORLDS; w++) check((worlds[w] = scene_world(scene, &error)) != NULL);
    start = run.world;
    dt = scene->dt;
    job.worlds = WORLDS;
    sample(&job, &ways[0]); /* warms up; measure() forgets it */
    for (job.worlds = 1; job.worlds <= WORLDS; job.worlds *= WORLDS)
        measure(&job, job.worlds == 1 ? "a step of a pyramid" : "a step of 4096 pyramids");
    for (int w = 0; w < WORLDS; w++) world_destroy(worlds[w]);
    simulation_end(&run);
    scene_destroy(scene);
    job_end(&job);
}

static bool gpu_point(const void *of, int panel, int series, int i, PlotPoint *to) {
    *to = (PlotPoint){sizes[i], ways[series].plotted[i], 0};
    return (void)of, (void)panel, !isnan(to->y);
}

static void draw(void) {
    static PlotPage page;
    const char *caption = "Time of pair-net on a batch of pairs: on cores by each instruction set, and on a device.";
    PlotLook looks[PLOT_SERIES];
    PlotRange range = plot_range();
    for (int i = 0; i < way_count; i++) looks[i] = plot_look(i, ways[i].name);
    for (int i = 0; i < way_count * SIZES; i++) plot_range_include(&range, ways[i / SIZES].plotted[i % SIZES]);
    PlotPanel panel = {.box = {19, 34, FIGURE_PAGE_WIDTH - 22, 68},
                       .x = plot_log_axis(sizes[0], sizes[SIZES - 1], "Pairs in a batch"),
                       .y = plot_log_axis(range.least, range.most, "Time of a batch (µs)")};
    panel.x.powers = panel.y.powers = true;
    const PlotSpec spec = {.width = FIGURE_PAGE_WIDTH,
                           .height = 106,
                           .panels = &panel,
                           .looks = looks,
                           .panel_count = 1,
                           .series = way_count,
                           .rows = SIZES,
                           .point = gpu_point,
                           .legend_columns = 2,
                           .legend_left = 6,
                           .legend_top = 20,
                           .caption = caption};
    check(plot_draw(&page, &spec, "gpu", &error) && file_make_directory("out", &error) &&
          plot_page_write(&page, "out", "", "gpu", &error));
    plot_page_free(&page);
}

int main(void) {
    const bool device = open_device();
    if (!device) fprintf(stderr, "no compute shaders, so only cores are measured: %s\n", error.message);
    report_header();
    add_ways(device);
    measure_steps();
    measure_pairs("contact-net");
    measure_pairs("pair-net");
    draw();
    if (device) gpu_close(&gpu);
    return 0;
}
