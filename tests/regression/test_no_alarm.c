/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames do not depend on the rendering configuration: both contexts, 0, 1 and 2 threads of Mesa, and emulated CPUs
   with fewer features. Every 30th of 900 frames; all if the environment variable TWINBOX_ALL_FRAMES is set. */
#include "made.h"

#include "pixels/built_contexts.h"
#include "pictures/mesa.h"
#include "pictures/render.h"

#include <dirent.h>
#include <sys/mman.h>
#include <sys/wait.h>

enum { FRAMES = 900, FEW = 30, PANELS = 2, WIDTH = 1280, HEIGHT = 720 };

/* The renderer sets the number of threads to 0; this test must be able to override that. */
int __real_setenv(const char *name, const char *value, int overwrite);
int __wrap_setenv(const char *name, const char *value, int overwrite);
int __wrap_setenv(const char *name, const char *value, int overwrite) {
    return __real_setenv(name, value, strcmp(name, "LP_NUM_THREADS") == 0 ? 0 : overwrite);
}

typedef struct Configuration {
    ContextChoice context;
    const char *threads, *caps; /* caps NULL: all features of the CPU */
} Configuration;

static const Configuration configurations[] = {{CONTEXT_OSMESA, "0", NULL},     {CONTEXT_OSMESA, "1", NULL},
                                               {CONTEXT_OSMESA, "2", NULL},     {CONTEXT_EGL, "0", NULL},
                                               {CONTEXT_EGL, "1", NULL},        {CONTEXT_EGL, "2", NULL},
                                               {CONTEXT_OSMESA, "0", "sse2"},   {CONTEXT_EGL, "0", "sse2"},
                                               {CONTEXT_OSMESA, "2", "sse4.1"}, {CONTEXT_EGL, "1", "avx"}};
enum { CONFIGURATIONS = sizeof configurations / sizeof configurations[0] };

/* The result of a separate process: Mesa reads its environment variables only once. */
typedef struct Drawn {
    int count, threads;
    uint64_t hashes[FRAMES];
    Error error;
} Drawn;

static Trajectory *pyramid_by(const char *method_text) {
    Scene *scene = scene_named("pyramid_settled");
    scene->frames = FRAMES - 1;
    Trajectory *run = run_by(scene, method_text);
    assert_int_equal(run->frames, FRAMES);
    scene_destroy(scene);
    return run;
}

static int count_threads(void) {
    int count = 0;
    DIR *tasks = opendir("/proc/self/task");
    for (struct dirent *entry; tasks != NULL && (entry = readdir(tasks)) != NULL;) count += entry->d_name[0] != '.';
    if (tasks != NULL) closedir(tasks);
    return count;
}

static void draw(const Configuration *configuration, const Trajectory *const *runs, Drawn *drawn) {
    Error error = {0};
    const RenderOptions options = {.width = WIDTH, .height = HEIGHT, .context = built_context(configuration->context)};
    int step = getenv("TWINBOX_ALL_FRAMES") != NULL ? 1 : FRAMES / FEW;
    __real_setenv("LP_NUM_THREADS", configuration->threads, 1);
    if (configuration->caps != NULL) __real_setenv("GALLIUM_OVERRIDE_CPU_CAPS", configuration->caps, 1);
    Renderer *renderer = renderer_create(runs, PANELS, &options, &error);
    Image *image = image_create(WIDTH, HEIGHT, &error);
    for (int frame = 0; frame < FRAMES && error.kind == ERROR_NONE; frame += step) {
        if (renderer != NULL && image != NULL && renderer_draw(renderer, frame, image, &error))
            drawn->hashes[drawn->count++] = image_hash(image);
        drawn->threads = count_threads();
    }
    drawn->error = error;
}

TEST(every_configuration_draws_the_same_frames) {
    size_t size = CONFIGURATIONS * sizeof(Drawn);
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(ftruncate(fileno(file), (off_t)size), 0);
    Drawn *drawn = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
    assert_ptr_not_equal(drawn, MAP_FAILED);
    Trajectory *runs[PANELS] = {pyramid_by("engine"), pyramid_by("momentum:k=20")};
    for (int i = 0; i < CONFIGURATIONS; i++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            draw(&configurations[i], (const Trajectory *const *)runs, &drawn[i]);
            _exit(0);
        }
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        if (status != 0 || drawn[i].error.kind != ERROR_NONE)
            fail_msg("configuration %d: %s", i, drawn[i].error.message);
    }
    assert_true(drawn[0].count >= FEW);
    /* The variables reached Mesa. */
    assert_true(drawn[1].threads > drawn[0].threads && drawn[2].threads > drawn[1].threads);
    for (int i = 1; i < CONFIGURATIONS; i++) {
        assert_int_equal(drawn[i].count, drawn[0].count);
        for (int k = 0; k < drawn[0].count; k++)
            if (drawn[i].hashes[k] != drawn[0].hashes[k]) fail_msg("configuration %d: picture %d differs", i, k);
    }
    assert_true(drawn[0].hashes[0] != drawn[0].hashes[drawn[0].count - 1]);
    print_message("%d configurations, %d frames each\n", CONFIGURATIONS, drawn[0].count);
    for (int i = 0; i < PANELS; i++) trajectory_destroy(runs[i]);
    munmap(drawn, size);
    fclose(file);
}

RUN_TESTS(NULL, NULL)
