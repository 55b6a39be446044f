/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes drawn with the real renderer, each with its right name. 50 of them; with TWINBOX_ALL_CHANGES=1 a thousand. A
   changed picture differs from the expected one in one thing: a body that moved in the run, a colour of a body, or
   pixels of a text. */
#include "made.h"

#include "pixels/gl.h"
#include "pixels/gl_functions.h"
#include "pictures/pictures_internal.h"
#include "pictures/mesa.h"
#include "pictures/render.h"
#include "regression/naming.h"

#include <math.h>

enum { FEW = 50, MANY = 1000, AT_LEAST = 99 /* percent */ };

/* A picture of a frame of runs by some methods. */
typedef struct Shot {
    const char *folder, *scene, *methods[3];
    int count, frame, width, height;
    RenderLook look;
} Shot;

static const Shot shots[] = {
    {"a", "stack", {"engine"}, 1, 20, 640, 360, {0}},
    {"b", "stack", {"engine", "momentum:k=20"}, 2, 60, 1280, 720, {.theme = LOOK_DARK}},
    {"c", "pyramid", {"engine"}, 1, 30, 1280, 720, {0}},
    {"d", "pyramid_settled", {"engine", "momentum:k=20"}, 2, 70, 960, 540, {.show = SHOW_TIMELINE}},
    {"e", "single", {"engine"}, 1, 40, 320, 180, {0}},
    {"f", "stability/arch", {"engine"}, 1, 60, 800, 450, {0}},
    {"g", "stability/card_house", {"engine"}, 1, 30, 800, 600, {.theme = LOOK_DARK}},
    {"h", "stack", {"engine", "momentum:k=20", "momentum:k=5"}, 3, 90, 1920, 1080, {.show = SHOW_GHOSTS}},
};
enum { SHOTS = sizeof shots / sizeof shots[0] };

typedef struct Stage {
    Trajectory *runs[3];
    RenderOptions options;
    Picture picture;
    FrameView view;
    Context context;
    GlFunctions gl;
    Canvas *canvas;
    Drawing drawing, moved; /* of the expected picture; with one body moved */
    Image *images[2];
    Moment moment;
    const Shot *shot;
} Stage;

/* What was drawn, and its right name. */
typedef struct Seed {
    Change truth;
    const Trajectory *actual; /* run of the panel, if the states differ */
} Seed;

static uint64_t random_state = 18;

static uint32_t random_bits(void) {
    random_state = random_state * 6364136223846793005U + 1442695040888963407U;
    return (uint32_t)(random_state >> 33);
}

static int any_below(int count) { return (int)(random_bits() % (uint32_t)count); }

static double random_between(double low, double high) { return low + (high - low) * random_bits() / 2147483648.0; }

static Trajectory *run_of(const Shot *shot, const char *method_text) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, shot->scene);
    Scene *scene = scene_from(path);
    scene->frames = shot->frame + 5;
    Trajectory *run = run_by(scene, method_text);
    scene_destroy(scene);
    return run;
}

/* The view that render writes beside the pictures. */
static void read_view(Stage *stage) {
    Error error = {0};
    char path[512];
    RenderOptions options = stage->options;
    snprintf(path, sizeof path, "%s", temporary_path(stage->shot->folder));
    options.directory = path;
    options.first = options.last = stage->shot->frame;
    options.jobs = 1;
    assert_ok(render_sequence((const Trajectory *const *)stage->runs, stage->shot->count, &options, NULL, NULL, &error),
              error);
    strcat(path, "/manifest.json");
    assert_ok(view_read(&stage->view, path, &error), error);
}

static void open_stage(Stage *stage, const Shot *shot) {
    Error error = {0};
    *stage = (Stage){.shot = shot, .moment = moment_stored(shot->frame)};
    stage->options = (RenderOptions){.width = shot->width, .height = shot->height, .look = shot->look};
    for (int i = 0; i < shot->count; i++) stage->runs[i] = run_of(shot, shot->methods[i]);
    read_view(stage);
    assert_ok(picture_plan(&stage->picture, (const Trajectory *const *)stage->runs, shot->count, shot->width,
                           shot->height, &error) &&
                  picture_apply_options(&stage->picture, &stage->options, &error),
              error);
    assert_ok(context_create(&stage->context, CONTEXT_AUTO, &error) &&
                  gl_load(&stage->gl, stage->context.kind->find, stage->context.state, &error),
              error);
    stage->canvas = canvas_create(&stage->gl, shot->width, shot->height, &error);
    assert_ok(stage->canvas != NULL, error);
    for (int i = 0; i < 2; i++) stage->images[i] = image_sized(shot->width, shot->height);
    picture_draw(&stage->picture, stage->moment, &stage->drawing);
}

static void close_stage(Stage *stage) {
    canvas_destroy(stage->canvas);
    context_destroy(&stage->context);
    drawing_free(&stage->drawing);
    drawing_free(&stage->moved);
    picture_free(&stage->picture);
    for (int i = 0; i < stage->shot->count; i++) trajectory_destroy(stage->runs[i]);
    for (int i = 0; i < 2; i++) image_destroy(stage->images[i]);
}

static void paint(Stage *stage, const Drawing *drawing, Image *image) {
    Error error = {0};
    assert_ok(canvas_paint(stage->canvas, drawing, stage->picture.theme->page, NULL, image, &error), error);
}

static Vec2 *position_of(Trajectory *run, int frame, int body) {
    return &run->position[(size_t)frame * (size_t)run->bodies + (size_t)body];
}

static float *angle_of(Trajectory *run, int frame, int body) {
    return &run->angle[(size_t)frame * (size_t)run->bodies + (size_t)body];
}

/* Draws the picture with a body of a run elsewhere, into `moved`. */
static void draw_moved(Stage *stage, int run, int body, double x, double y, double angle) {
    Trajectory *trajectory = stage->runs[run];
    Vec2 *position = position_of(trajectory, stage->shot->frame, body), old = *position;
    float *turned = angle_of(trajectory, stage->shot->frame, body), before = *turned;
    position->x += (float)x, position->y += (float)y, *turned += (float)angle;
    drawing_clear(&stage->moved);
    picture_draw(&stage->picture, stage->moment, &stage->moved);
    *position = old, *turned = before;
}

/* The first shape of a body: the one that differs when it moves. -1: none. */
static int shape_of(Stage *stage, int run, int body) {
    draw_moved(stage, run, body, 0.02, 0.01, 0);
    for (size_t i = 0; i < stage->drawing.shape_count && stage->moved.shape_count == stage->drawing.shape_count; i++)
        if (memcmp(&stage->drawing.shapes[i], &stage->moved.shapes[i], sizeof stage->drawing.shapes[i]) != 0)
            return (int)i;
    return -1;
}

static ChangeSubject subject_of(const Trajectory *run, int body) {
    int fixed = 0;
    for (int i = 0; i < run->bodies; i++) fixed += run->fixed[i] != 0;
    if (body == run->bomb) return SUBJECT_BOMB;
    return !run->fixed[body] ? SUBJECT_BODY : fixed == 1 ? SUBJECT_GROUND : SUBJECT_FIXED;
}

/* A body that exists, of a random panel. */
static Seed seed_body(Stage *stage) {
    int panel = any_below(stage->shot->count), body;
    const Trajectory *run = stage->runs[panel];
    do body = any_below(run->bodies);
    while (!trajectory_has(run, stage->shot->frame, body));
    return (Seed){.truth = {.subject = subject_of(run, body), .panel = panel + 1, .body = body}};
}

/* 1/16 to 30 pixels in any direction; one in three turns, too. */
static void seed_movement(Stage *stage, Seed *seed) {
    int panel = seed->truth.panel - 1, body = seed->truth.body;
    double scale = stage->view.panels[panel].scale, size = exp(random_between(log(1.0 / 16), log(30)));
    double direction = any_below(2) ? random_between(0, 6.283185307) : 1.5707963268 * any_below(4);
    Change *truth = &seed->truth;
    truth->kind = CHANGE_MOVED;
    truth->right = size * cos(direction), truth->up = size * sin(direction);
    truth->turn = any_below(3) == 0 ? random_between(-0.2, 0.2) : 0;
    draw_moved(stage, panel, body, truth->right / scale, truth->up / scale, truth->turn);
    const char *copy = temporary_path("copy.npz");
    assert_true(trajectory_write(stage->runs[panel], copy, &(Error){0}));
    Trajectory *actual = trajectory_read(copy, &(Error){0});
    assert_non_null(actual);
    position_of(actual, stage->shot->frame, body)->x += (float)(truth->right / scale);
    position_of(actual, stage->shot->frame, body)->y += (float)(truth->up / scale);
    *angle_of(actual, stage->shot->frame, body) += (float)truth->turn;
    seed->actual = actual;
}

static void copy_drawing(Stage *stage) {
    drawing_clear(&stage->moved);
    picture_draw(&stage->picture, stage->moment, &stage->moved);
}

/* Another fill, line or band colour; one channel by one step, or all by many. */
static void seed_colour(Stage *stage, Seed *seed) {
    int shape = shape_of(stage, seed->truth.panel - 1, seed->truth.body);
    seed->truth.kind = CHANGE_OTHER;
    copy_drawing(stage);
    if (shape < 0) return;
    int part = any_below(stage->moved.shapes[shape].paint[3] > 0 ? 3 : 2);
    uint32_t *paint_of = &stage->moved.shapes[shape].paint[part];
    uint32_t step = any_below(4) == 0 ? 1 : (uint32_t)any_below(120) + 3;
    for (int shift = 0; shift < 24; shift += 8) {
        uint32_t channel = *paint_of >> shift & 255;
        channel = channel + step < 256 ? channel + step : channel - step;
        *paint_of = (*paint_of & ~(255U << shift)) | channel << shift;
        if (step == 1) break;
    }
}

/* Some pixels of a text, a legend or an axis get another colour, and at the second time their own again. */
static Change toggle_text(const Stage *stage, int number) {
    static const ChangeSubject subjects[] = {SUBJECT_HEADER, SUBJECT_CAPTION, SUBJECT_AXIS, SUBJECT_LEGEND,
                                             SUBJECT_TIMELINE};
    const ViewPart *part = &stage->view.parts[number];
    const ViewRect *rect = &part->rect;
    for (int i = 0; i < 9; i++) {
        const int x = (rect->left + rect->right) / 2 + i % 3, y = (rect->top + rect->bottom) / 2 + i / 3;
        stage->images[1]->pixels[4 * ((size_t)y * (size_t)stage->shot->width + (size_t)x)] ^= 0x40;
    }
    return (Change){.subject = subjects[part->kind], .panel = part->panel};
}

static FrameChanges name_changes(Stage *stage, const Seed *seed, const ImageDifference *difference) {
    Error error = {0};
    FrameChanges changes;
    NamingScene scene = {.view = &stage->view, .frame = stage->shot->frame};
    for (int i = 0; i < stage->view.panel_count; i++) scene.runs[i][0] = scene.runs[i][1] = stage->runs[i];
    for (int i = 0; i < stage->view.panel_count; i++)
        for (int k = 0; k < stage->view.panels[i].outline_count; k++)
            scene.outlines[i][k] = stage->runs[0]; /* ghosts */
    if (seed->actual != NULL) scene.runs[seed->truth.panel - 1][1] = seed->actual;
    assert_ok(image_regions_find(stage->images[0], stage->images[1], NULL, difference, &changes.regions, &error),
              error);
    const size_t pixels = (size_t)stage->shot->width * (size_t)stage->shot->height;
    uint8_t *levels = malloc(pixels);
    assert_non_null(levels);
    (void)image_find_levels(stage->images[0], stage->images[1], NULL, 0, pixels, levels);
    assert_ok(naming_find(&scene, levels, difference, &changes, &error), error);
    free(levels);
    return changes;
}

/* The largest region has the right name; a movement is right within a tenth of a pixel or of its size. */
static bool is_right(const Stage *stage, const Change *truth, const FrameChanges *changes) {
    if (changes->regions.kept == 0 || changes->region_change[0] < 0) return false;
    const Change *found = &changes->list[changes->region_change[0]];
    int panel = stage->view.panel_count > 1 ? truth->panel : 0;
    if (found->subject != truth->subject || found->kind != truth->kind || found->panel != panel) return false;
    if (truth->subject <= SUBJECT_GROUND && found->body != truth->body) return false;
    if (truth->kind != CHANGE_MOVED) return true;
    double tolerance = fmax(0.1, 0.1 * hypot(truth->right, truth->up)), right = found->right - truth->right;
    /* The ground's ends are outside the picture: only its height is visible, and only that of what is visible. */
    bool ends = truth->subject != SUBJECT_GROUND && truth->subject != SUBJECT_FIXED;
    return hypot(ends ? right : 0, truth->turn != 0 && !ends ? 0 : found->up - truth->up) <= tolerance;
}

TEST(changes_get_their_names) {
    int all = getenv("TWINBOX_ALL_CHANGES") != NULL ? MANY : FEW, right = 0, done = 0;
    for (int i = 0; i < SHOTS; i++) {
        Stage stage;
        open_stage(&stage, &shots[i]);
        assert_ok(context_make_current(&stage.context, &(Error){0}), (Error){0});
        paint(&stage, &stage.drawing, stage.images[0]);
        for (int end = all * (i + 1) / SHOTS; done < end;) {
            const int parts = stage.view.part_count, kind = parts > 0 ? any_below(3) : 1 + any_below(2);
            const int part = parts > 0 ? any_below(parts) : 0;
            Seed seed = seed_body(&stage);
            if (kind == 0) copy_drawing(&stage);
            if (kind == 1) seed_movement(&stage, &seed);
            if (kind == 2) seed_colour(&stage, &seed);
            ImageDifference difference;
            paint(&stage, &stage.moved, stage.images[1]);
            if (kind == 0) seed.truth = toggle_text(&stage, part);
            image_compare_masked(stage.images[0], stage.images[1], NULL, 0, &difference);
            if (!difference.equal) { /* else hidden, outside, or without a line */
                FrameChanges changes = name_changes(&stage, &seed, &difference);
                const bool is = is_right(&stage, &seed.truth, &changes);
                const int found = changes.regions.kept > 0 ? changes.region_change[0] : -1;
                if (!is)
                    print_message("wrong: %s, %d x %d: %s; found: %s\n", stage.shot->scene, stage.shot->width,
                                  stage.shot->height, change_words(&seed.truth).text,
                                  found >= 0 ? change_words(&changes.list[found]).text : "nothing");
                done++, right += is;
            }
            if (kind == 0) toggle_text(&stage, part);
            trajectory_destroy((Trajectory *)seed.actual);
        }
        close_stage(&stage);
    }
    print_message("%d of %d names right\n", right, done);
    if (100 * right < AT_LEAST * done) fail_msg("%d of %d names are right, fewer than %d%%", right, done, AT_LEAST);
}

RUN_TESTS(NULL, NULL)
