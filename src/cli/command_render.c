/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox render: frames and films of runs or scenes. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/draw_panels.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/panels.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/gl.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <string.h>

typedef struct Options {
    const char *inputs[RENDER_PANELS_MAX];
    int input_count, caption_count;
    RenderOptions render;
    FrameRange frames;
    DrawVideos videos;
    SceneSettings set;
    PanelMethods methods;
    const char *costs;     /* FILE.csv, or NULL */
    const char *view_from; /* RUN.npz, or NULL */
    const char *shard;     /* or NULL */
    PiecesRun run;
    PiecesMode mode;
} Options;

static OptionRead read_size, read_png, read_context, read_camera;

static const Option option_table[] = {
    {"--output", 'o', "DIR", "Folder for frame_000000.png ..., manifest.json and the runs (.npz)",
     OPTION_TEXT(Options, render.directory), .needed = "-o DIR is needed"},
    {"--size", 0, "WxH", "Size of a frame in pixels (default: 1920x1080)", OPTION_READ(read_size, Options, render)},
    {"--frames", 0, "A:B", "Draw only these frames of the run (default: all)",
     OPTION_READ(frames_option_read, Options, frames)},
    {"--slow", 0, "K", "K times slower around the bomb's impact, 2 to 16, with poses interpolated between frames",
     OPTION_INT(Options, render.slow, 2, RENDER_SLOW_MAX)},
    {"--fps", 0, "N",
     "Pictures per second, 1 to 240, in real time: frames are left out, or poses interpolated between them (default: "
     "every frame of the run)",
     OPTION_DOUBLE(Options, render.fps, RENDER_FPS_MIN, RENDER_FPS_MAX)},
    {"--duration", 0, "SECONDS", "Length of the film with its cards; the run is shown faster or slower to fit",
     OPTION_DOUBLE(Options, render.duration, RENDER_DURATION_MIN, RENDER_DURATION_MAX)},
    {"--hold", 0, "SECONDS", "Hold the last frame for this long",
     OPTION_DOUBLE(Options, render.hold, 0, RENDER_HOLD_MAX)},
    {"--title", 0, "TEXT", "Begin with a title card of two seconds", OPTION_TEXT(Options, render.title)},
    {"--end", 0, "TEXT",
     "End with a card of two seconds, with a table of the distances from the reference, or from the run that held best",
     OPTION_TEXT(Options, render.look.end)},
    {"--no-table", 0, NULL, "The card of --end has its text only", OPTION_FLAG(Options, render.look.end_bare)},
    {"--video", 0, "FILE",
     "Also encode a video: FILE.mp4 (H.264), .webm (VP9) or .gif; - writes y4m in 4:4:4 and BT.709 to standard output "
     "(may be repeated)",
     OPTION_TEXTS(Options, videos.paths, videos.count)},
    {"--resume", 0, NULL, "Redraw only frames that are missing or altered, compared with the manifest in DIR",
     OPTION_FLAG(Options, render.resume)},
    {"--png", 0, "fast|small", "Compression (default: fast); the pixels are the same",
     OPTION_READ(read_png, Options, render.small)},
    {"--jobs", 0, "N", "Number of processes (default: one per core); the frames are the same",
     OPTION_INT(Options, render.jobs, 1, RENDER_JOBS_MAX)},
    {"--context", 0, "osmesa|egl", "OpenGL without a display (default: the first that works); the frames are the same",
     OPTION_READ(read_context, Options, render.context)},
    {OPTION_SHARD(Options, shard)},
    {OPTION_METHODS(Options, methods, "default: engine, and pair-net if the scene names one")},
    {OPTION_SET(Options, set)},
    {.help = "Look:"},
    {"--compare", 0, "KIND",
     "split: a panel for each run (default); overlay: one panel, all runs but the first as outlines; difference: boxes "
     "coloured by their distance from the first run's",
     OPTION_ENUM(Options, render.look.compare, look_compare_names)},
    {"--show", 0, "LIST",
     "Any of ghosts (outlines of the first run), distance (colours), trails, contacts, impulses, velocities (arrows), "
     "timeline (distance from the first run over time), separated by commas",
     OPTION_FLAGS(Options, render.look.show, look_show_names)},
    {"--labels", 0, "KIND",
     "In boxes that are large enough: mass (kg), number (of the body), name (the scene's key), or none (default)",
     OPTION_ENUM(Options, render.look.labels, look_labels_names)},
    {"--camera", 0, "KIND|X,Y,W,H",
     "fit: fixed, on what stands and what strikes it (default); bomb: follows the bomb; divergence: zooms in where the "
     "distance first exceeds 1 mm; " CAMERA_OPTION_VIEW " (both may be given)",
     OPTION_READ(read_camera, Options, render.look), .names = look_camera_names},
    {"--view-from", 0, "RUN", "The fixed view of this run (.npz) instead of the first panel's",
     OPTION_PATH(Options, view_from)},
    {"--theme", 0, "light|dark", "Colours (default: light)", OPTION_ENUM(Options, render.look.theme, look_theme_names)},
    {OPTION_COLOUR(Options, render.colours)},
    {"--caption", 0, "TEXT",
     "Caption of a run, instead of its method's name and description (may be repeated: one per run, in their order; "
     "\"\" keeps the name)",
     OPTION_TEXTS(Options, render.captions, caption_count)},
    {"--costs", 0, "FILE.csv", "Add the time per step to the captions, from a chart.csv of 'twinbox chart'",
     OPTION_TEXT(Options, costs)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    PANELS_INPUTS(Options),
    .help =
        "Draw runs side by side, one panel each, with one camera. A run is a stored trajectory (.npz). A scene (.yaml) "
        "is simulated first, by default with the engine and with the pair-net that it names.\v"
        "Example: twinbox render stack -o out/stack --video out/stack.mp4\n"
        "         twinbox render stack --method engine --method interior -o out/both"};

/* "1920x1080" */
static bool read_size(const Option *option, const char *text, void *value, Error *error) {
    RenderOptions *render = value;
    int64_t size[2] = {0, 0};
    if (!frames_option_split(text, 'x', RENDER_SIDE_MIN, RENDER_SIDE_MAX, size) || size[0] == 0 || size[1] == 0)
        return error_input(error, option->name, "'%s' is not WIDTHxHEIGHT, each from %d to %d", text, RENDER_SIDE_MIN,
                           RENDER_SIDE_MAX);
    render->width = (int)size[0];
    render->height = (int)size[1];
    return true;
}

static bool read_context(const Option *option, const char *text, void *value, Error *error) {
    const bool osmesa = strcmp(text, "osmesa") == 0;
    *(ContextChoice *)value = osmesa ? CONTEXT_OSMESA : CONTEXT_EGL;
    return osmesa || strcmp(text, "egl") == 0 ||
           error_input(error, option->name, "'%s' is neither osmesa nor egl", text);
}

static bool read_camera(const Option *option, const char *text, void *value, Error *error) {
    RenderLook *look = value;
    return strchr(text, ',') != NULL ? camera_option_read(option, text, &look->view, error)
                                     : option_enum(option, text, &look->camera, error);
}

static bool read_png(const Option *option, const char *text, void *value, Error *error) {
    const bool small = *(bool *)value = strcmp(text, "small") == 0;
    return small || strcmp(text, "fast") == 0 ||
           error_input(error, option->name, "'%s' is neither fast nor small", text);
}

/* Messages go to standard error if standard output is the video. */
static void print_result(const Options *options, const RenderResult *result) {
    const RenderOptions *render = &options->render;
    FILE *out = draw_videos_use_output(&options->videos) ? stderr : stdout;
    if (render->resume && result->why[0] != '\0') fprintf(out, "nothing to resume: %s\n", result->why);
    fprintf(out, "%d frames -> %s/frame_%06d.png ... frame_%06d.png", result->last - result->first + 1,
            render->directory, result->first, result->last);
    if (render->resume) fprintf(out, ", %d of them kept", result->kept);
    fprintf(out, "\nmanifest -> %s/manifest.json\n", render->directory);
    for (int i = 0; i < options->videos.count; i++) fprintf(out, "video -> %s\n", options->videos.paths[i]);
}

/* Before anything is written. */
static bool check_moments(const RenderOptions *render, const Panels *panels, Error *error) {
    const int end = panels_last_frame(panels), last = render->last < 0 ? end : render->last;
    const Trajectory *const *runs = (const Trajectory *const *)panels->runs;
    MomentPlan plan;
    if (render->first > end || last > end)
        return error_input(error, "--frames", "%d is beyond the last frame, %d",
                           render->first > end ? render->first : last, end);
    if (!moments_plan(&plan, runs, panels->count, render->first, last, render, error)) return false;
    if (render->slow > 1) note_missing_impact(&plan, moments_impact(runs, panels->count));
    note_different_scenes(runs, panels->count);
    return true;
}

/* A figure of the runs that the folder has. */
static void next_figure(const char *directory, const Panels *panels) {
    char paths[RENDER_PANELS_MAX][PATH_MAX], figure[PATH_MAX];
    const char *words[RENDER_PANELS_MAX + 5] = {"figure", "strip"};
    const int length = (int)strlen(directory) - file_name_ends_with(directory, "/");
    for (int i = 0; i < panels->count; i++) {
        char name[TRAJECTORY_FILE_NAME_SIZE];
        trajectory_file_name((const Trajectory *const *)panels->runs, i, name);
        snprintf(paths[i], sizeof paths[i], "%.*s/%s", length, directory, name);
        words[2 + i] = paths[i];
    }
    snprintf(figure, sizeof figure, "%.*s-strip.pdf", length, directory);
    words[2 + panels->count] = "-o";
    words[3 + panels->count] = figure;
    next_print(words);
}

static bool draw_study(Options *options, const Panels *panels, RenderStudy *study, Error *error) {
    RenderOptions *render = &options->render;
    RenderResult result;
    if ((options->mode != PIECES_WHOLE && !render_key(study->key, panels, &options->videos, options->costs, error)) ||
        !draw_panels(panels, render, &options->videos, study, &result, error))
        return false;
    if (study->pieces.mode == PIECES_SHARD) {
        shard_option_print(&study->pieces, render->directory);
        return true;
    }
    print_result(options, &result);
    if (!note_foreign_files(render->directory, &result, panels, error)) return false;
    if (!draw_videos_use_output(&options->videos)) next_figure(render->directory, panels);
    return true;
}

static bool render_panels(Options *options, const Panels *panels, Error *error) {
    RenderOptions *render = &options->render;
    const Trajectory *const *runs = (const Trajectory *const *)panels->runs;
    PanelCosts costs;
    StudyKey key = {0};
    RunsPlace place = {panels, render->directory};
    RenderStudy study = {.run = &options->run, .key = &key, .begin = render_store_runs, .context = &place};
    if (options->caption_count > panels->count)
        return error_input(error, "--caption", "%d captions for %d run%s", options->caption_count, panels->count,
                           panels->count == 1 ? "" : "s");
    const bool ok =
        check_moments(render, panels, error) &&
        (options->costs == NULL || panel_costs_read(&costs, options->costs, panels, &render->look, error)) &&
        picture_check(runs, panels->count, render, error) && draw_study(options, panels, &study, error);
    study_key_free(&key);
    return ok;
}

/* The name of a film after -o would become a folder of frames. */
static bool check_directory(const char *path, Error *error) {
    const char *ending = strrchr(path, '.');
    if (video_check_format(path, 2, 2, &(Error){0}))
        return error_input(error, path, "-o names the folder of the frames; for a film: -o %.*s --video %s",
                           (int)(ending - path), path, path);
    return output_check_folder_name(path, error);
}

/* How the command is to run. The merge reads the inputs of shards once more. */
static bool choose_mode(Options *options, int argc, char **argv, Error *error) {
    if (!shard_option_take(&options->run, options->shard, argc, argv, error) ||
        !pieces_find_mode(&options->mode, options->render.directory, &options->run, error))
        return false;
    bool ok = true;
    for (int i = 0; ok && options->mode == PIECES_SHARD && i < options->input_count; i++)
        ok = render_check_again(options->inputs[i], error);
    return ok && (options->mode != PIECES_SHARD || render_check_again(options->view_from, error));
}

static bool check_texts(const Options *options, Error *error) {
    bool ok = colours_check(&options->render.colours, error) &&
              caption_check(options->render.title, "--title", error) &&
              caption_check(options->render.look.end, "--end", error);
    for (int i = 0; ok && i < options->caption_count; i++)
        ok = caption_check(options->render.captions[i], "--caption", error);
    return ok;
}

bool command_render(int argc, char **argv, Error *error) {
    Options options = {.render = draw_panels_defaults(NULL), .frames = {0, -1}};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!check_directory(options.render.directory, error) || !check_texts(&options, error) ||
        !choose_mode(&options, argc, argv, error))
        return false;
    options.render.first = options.frames.first;
    options.render.last = options.frames.last;
    options.render.title_card = options.render.title != NULL;
    if (options.render.look.end_bare && options.render.look.end == NULL)
        return error_input(error, "--no-table", "needs --end TEXT: only that card has a table");
    options.render.end_card = options.render.look.end != NULL;
    Panels panels = {0};
    RenderLook *look = &options.render.look;
    Trajectory *view_from;
    bool ok = camera_option_load(options.view_from, &look->view, &view_from, error);
    look->view_from = view_from;
    ok = ok &&
         draw_videos_check(&options.videos, options.render.width, options.render.height, options.mode == PIECES_SHARD,
                           error) &&
         panels_load(&panels, options.inputs, options.input_count, &options.set, &options.methods, error) &&
         render_panels(&options, &panels, error);
    panels_free(&panels);
    trajectory_destroy(view_from);
    return ok;
}
