/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/draw_panels.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/render_look.h"
#include "common/file.h"

#include <stdio.h>
#include <string.h>

enum { SIZE = 256, FRAMES, SLOW, HOLD, TITLE, END, VIDEO, RESUME, PNG, JOBS, CONTEXT, SET };

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0, "Folder for frame_000000.png ..., manifest.json and the runs (.npz)", 0},
    {"size", SIZE, "WxH", 0, "Size of a frame in pixels (default: 1920x1080)", 0},
    {"frames", FRAMES, "A:B", 0, "Draw only these frames of the run (default: all)", 0},
    {"slow", SLOW, "K", 0, "K times slower around the bomb's impact, 2 to 16, with poses interpolated between frames",
     0},
    {"hold", HOLD, "SECONDS", 0, "Hold the last frame for this long", 0},
    {"title", TITLE, "TEXT", 0, "Begin with a title card of two seconds", 0},
    {"end", END, "TEXT", 0, "End with a card of two seconds", 0},
    {"video", VIDEO, "FILE", 0,
     "Also encode a video: FILE.mp4 (H.264), .webm (VP9) or .gif; - writes y4m in 4:4:4 and BT.709 to standard output "
     "(may be repeated)",
     0},
    {"resume", RESUME, NULL, 0, "Redraw only frames that are missing or altered, compared with the manifest in DIR", 0},
    {"png", PNG, "fast|small", 0, "Compression (default: fast); the pixels are the same", 0},
    {"jobs", JOBS, "N", 0, "Number of processes (default: one per core); the frames are the same", 0},
    {"context", CONTEXT, "NAME", 0, "osmesa or egl (default: the first that works); the frames are the same", 0},
    OPTION_SET(SET, 0),
    {0}};

typedef struct Options {
    const char *inputs[RENDER_PANELS_MAX];
    int input_count;
    const char *output, *size, *frames, *slow, *hold, *title, *end, *png, *jobs, *context;
    bool resume;
    DrawVideos videos;
    SetOptions set;
    RenderLookOptions look;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: state->child_inputs[0] = &options->look; break;
    case 'o': options->output = value; break;
    case SIZE: options->size = value; break;
    case FRAMES: options->frames = value; break;
    case SLOW: options->slow = value; break;
    case HOLD: options->hold = value; break;
    case TITLE: options->title = value; break;
    case END: options->end = value; break;
    case VIDEO:
        if (options->videos.count == DRAW_VIDEOS_MAX) argp_error(state, "at most %d videos", DRAW_VIDEOS_MAX);
        options->videos.paths[options->videos.count++] = value;
        break;
    case RESUME: options->resume = true; break;
    case PNG: options->png = value; break;
    case JOBS: options->jobs = value; break;
    case CONTEXT: options->context = value; break;
    case SET: options_add_set(&options->set, value); break;
    case ARGP_KEY_ARG:
        if (options->input_count == RENDER_PANELS_MAX) argp_error(state, "at most %d panels", RENDER_PANELS_MAX);
        options->inputs[options->input_count++] = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->input_count == 0) argp_error(state, "a run (.npz) or a scene (.yaml) is needed");
        if (options->output == NULL) argp_error(state, "-o DIR is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp_child children[] = {{&render_look_argp, 0, NULL, 0}, {0}};

static const struct argp argp = {
    option_table,
    parse,
    "RUN_OR_SCENE...",
    "Draw runs side by side, one panel each, with one camera. A run is a stored trajectory (.npz). A scene (.yaml) is "
    "simulated with the engine and with the pair-net that it names.\v"
    "Example: twinbox render scenes/stack.yaml -o out/stack --video out/stack.mp4",
    children,
    NULL,
    NULL};

static bool choose_context(const char *name, ContextChoice *context, Error *error) {
    if (name == NULL) return true;
    if (strcmp(name, "osmesa") == 0)
        *context = CONTEXT_OSMESA;
    else if (strcmp(name, "egl") == 0)
        *context = CONTEXT_EGL;
    else
        return error_input(error, "--context", "'%s' is neither osmesa nor egl", name);
    return true;
}

static bool choose_png(const char *name, bool *small, Error *error) {
    if (name == NULL) return true;
    *small = strcmp(name, "small") == 0;
    return *small || strcmp(name, "fast") == 0 || error_input(error, "--png", "'%s' is neither fast nor small", name);
}

static bool read_order(const Options *options, RenderOptions *render, Error *error) {
    float hold = 0;
    if ((options->slow != NULL && !option_int("--slow", options->slow, 2, RENDER_SLOW_MAX, &render->slow, error)) ||
        (options->hold != NULL && !option_float("--hold", options->hold, 0, RENDER_HOLD_MAX, &hold, error)))
        return false;
    render->hold = (double)hold;
    render->title = options->title;
    render->title_card = options->title != NULL;
    render->look.end = options->end;
    render->end_card = options->end != NULL;
    return true;
}

static bool read_options(const Options *options, RenderOptions *render, Error *error) {
    *render = draw_panels_defaults(options->output);
    render->resume = options->resume;
    return render_look_read(&options->look, &render->look, error) &&
           choose_context(options->context, &render->context, error) &&
           choose_png(options->png, &render->small, error) &&
           (options->size == NULL || option_size("--size", options->size, RENDER_SIDE_MIN, RENDER_SIDE_MAX,
                                                 &render->width, &render->height, error)) &&
           (options->frames == NULL ||
            option_frames("--frames", options->frames, &render->first, &render->last, error)) &&
           (options->jobs == NULL || option_int("--jobs", options->jobs, 1, RENDER_JOBS_MAX, &render->jobs, error)) &&
           read_order(options, render, error) &&
           draw_videos_check(&options->videos, render->width, render->height, error);
}

/* Messages go to standard error if standard output is the video. */
static void print_result(const Options *options, const RenderOptions *render, const RenderResult *result) {
    FILE *out = draw_videos_use_output(&options->videos) ? stderr : stdout;
    if (render->resume && result->why[0] != '\0') fprintf(out, "nothing to resume: %s\n", result->why);
    fprintf(out, "%d frames -> %s/frame_%06d.png ... frame_%06d.png", result->last - result->first + 1,
            render->directory, result->first, result->last);
    if (render->resume) fprintf(out, ", %d of them kept", result->kept);
    fprintf(out, "\nmanifest -> %s/manifest.json\n", render->directory);
    for (int i = 0; i < options->videos.count; i++) fprintf(out, "video -> %s\n", options->videos.paths[i]);
}

static bool render_panels(Options *options, const Panels *panels, RenderOptions *render, Error *error) {
    int last = panels_last_frame(panels);
    RenderResult result;
    if (render->first > last || render->last > last)
        return error_input(error, "--frames", "'%s' is beyond the last frame, %d", options->frames, last);
    if (!render_look_apply(&options->look, &render->look, panels, error) ||
        !file_make_directory(render->directory, error) || !panels_store(panels, render->directory, error) ||
        !draw_panels(panels, render, &options->videos, &result, error))
        return false;
    print_result(options, render, &result);
    return true;
}

int command_render(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    RenderOptions render;
    if (!read_options(&options, &render, error)) return STATUS_DIFFERENT;
    Panels panels = {0};
    bool ok = panels_load(&panels, options.inputs, options.input_count, &options.set, error) &&
              render_panels(&options, &panels, &render, error);
    panels_free(&panels);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
