/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same frames whatever draws them: both contexts, with no, one and two threads of Mesa's, and as on CPUs that lack what
   this one has. Every 30th of 900 frames; all of them where the environment variable TWINBOX_ALL_FRAMES is set. */
#include "testing.h"

#include "render/mesa.h"
#include "render/render.h"
#include "simulate/simulate.h"

#include <dirent.h>
#include <sys/mman.h>
#include <sys/wait.h>

enum { FRAMES = 900, FEW = 30, PANELS = 2, WIDTH = 1280, HEIGHT = 720 };

/* The renderer itself asks for no threads; here it must not have its way. */
int __real_setenv(const char *name, const char *value, int overwrite);
int __wrap_setenv(const char *name, const char *value, int overwrite);
int __wrap_setenv(const char *name, const char *value, int overwrite) {
    return __real_setenv(name, value, strcmp(name, "LP_NUM_THREADS") == 0 ? 0 : overwrite);
}

typedef struct Way {
    ContextChoice context;
    const char *threads, *caps; /* caps NULL: all that the CPU has */
} Way;

static const Way ways[] = {{CONTEXT_OSMESA, "0", NULL},   {CONTEXT_OSMESA, "1", NULL}, {CONTEXT_OSMESA, "2", NULL},
                           {CONTEXT_EGL, "0", NULL},      {CONTEXT_EGL, "1", NULL},    {CONTEXT_EGL, "2", NULL},
                           {CONTEXT_OSMESA, "0", "sse2"}, {CONTEXT_EGL, "0", "sse2"},  {CONTEXT_OSMESA, "2", "sse4.1"},
                           {CONTEXT_EGL, "1", "avx"}};
enum { WAYS = sizeof ways / sizeof ways[0] };

/* What a process of its own found: Mesa reads its variables once. */
typedef struct Drawn {
    int count, threads;
    uint64_t hashes[FRAMES];
    Error error;
} Drawn;

static Trajectory *run_by(const char *method_text) {
    Error error = {0};
    Method method;
    Scene *scene = scene_read(SOURCE_DIR "/scenes/pyramid_settled.yaml", &error);
    assert_ok(scene != NULL && method_parse(&method, method_text, &error), error);
    scene->frames = FRAMES - 1;
    Trajectory *run = simulate(scene, &method, NULL, &error);
    assert_ok(run != NULL && run->frames == FRAMES, error);
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

static void draw(const Way *way, const Trajectory *const *runs, Drawn *drawn) {
    Error error = {0};
    const RenderOptions options = {.width = WIDTH, .height = HEIGHT, .context = way->context};
    int step = getenv("TWINBOX_ALL_FRAMES") != NULL ? 1 : FRAMES / FEW;
    __real_setenv("LP_NUM_THREADS", way->threads, 1);
    if (way->caps != NULL) __real_setenv("GALLIUM_OVERRIDE_CPU_CAPS", way->caps, 1);
    Renderer *renderer = renderer_create(runs, PANELS, &options, &error);
    Image *image = image_create(WIDTH, HEIGHT, &error);
    for (int frame = 0; frame < FRAMES && error.kind == ERROR_NONE; frame += step) {
        if (renderer != NULL && image != NULL && renderer_draw(renderer, frame, image, &error))
            drawn->hashes[drawn->count++] = image_hash(image);
        drawn->threads = count_threads();
    }
    drawn->error = error;
}

static void every_way_draws_the_same_frames(void **state) {
    (void)state;
    size_t size = WAYS * sizeof(Drawn);
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(ftruncate(fileno(file), (off_t)size), 0);
    Drawn *drawn = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
    assert_ptr_not_equal(drawn, MAP_FAILED);
    Trajectory *runs[PANELS] = {run_by("engine"), run_by("momentum:k=20")};
    for (int i = 0; i < WAYS; i++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            draw(&ways[i], (const Trajectory *const *)runs, &drawn[i]);
            _exit(0);
        }
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        if (status != 0 || drawn[i].error.kind != ERROR_NONE) fail_msg("way %d: %s", i, drawn[i].error.message);
    }
    assert_true(drawn[0].count >= FEW);
    /* The variables did reach Mesa. */
    assert_true(drawn[1].threads > drawn[0].threads && drawn[2].threads > drawn[1].threads);
    for (int i = 1; i < WAYS; i++) {
        assert_int_equal(drawn[i].count, drawn[0].count);
        for (int k = 0; k < drawn[0].count; k++)
            if (drawn[i].hashes[k] != drawn[0].hashes[k]) fail_msg("way %d: picture %d is another", i, k);
    }
    assert_true(drawn[0].hashes[0] != drawn[0].hashes[drawn[0].count - 1]);
    print_message("%d ways, %d frames each\n", WAYS, drawn[0].count);
    for (int i = 0; i < PANELS; i++) trajectory_destroy(runs[i]);
    munmap(drawn, size);
    fclose(file);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_way_draws_the_same_frames)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
