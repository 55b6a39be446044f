/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox render: frames and films of runs or scenes. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "base/settings.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VIDEOS_MAX = 8 };

typedef struct Options {
    const char *inputs[RENDER_PANELS_MAX];
    int input_count, caption_count;
    RenderOptions render;
    FrameRange frames;
    const char *videos[VIDEOS_MAX]; /* "-": y4m on standard output */
    int video_count;
    SceneSettings set;
    PanelMethods methods;
    const char *costs;     /* FILE.csv, or NULL */
    const char *view_from; /* RUN.npz, or NULL */
} Options;

static OptionRead read_size, read_png, read_context, read_camera;

#define SHOW_HELP(BIT, name, help, ...) " " name help ","

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
    {"--video", 0, "FILE",
     "Also encode a video: FILE.mp4 (H.264), .webm (VP9) or .gif; - writes y4m in 4:4:4 and BT.709 to standard output "
     "(may be repeated)",
     OPTION_TEXTS(Options, videos, video_count)},
    {"--resume", 0, NULL, "Redraw only frames that are missing or altered, compared with the manifest in DIR",
     OPTION_FLAG(Options, render.resume)},
    {"--png", 0, "fast|small", "Compression (default: fast); the pixels are the same",
     OPTION_READ(read_png, Options, render.small)},
    {"--jobs", 0, "N", "Number of processes (default: one per core); the frames are the same",
     OPTION_INT(Options, render.jobs, 1, RENDER_JOBS_MAX)},
    {"--context", 0, "osmesa|egl", "OpenGL without a display (default: the first that works); the frames are the same",
     OPTION_READ(read_context, Options, render.context)},
    {OPTION_METHODS(Options, methods, "default: engine, and pair-net if the scene names one")},
    {OPTION_SET(Options, set)},
    {.help = "Look:"},
    {"--compare", 0, "KIND",
     "split: a panel for each run (default); overlay: one panel, all runs but the first as outlines; difference: boxes "
     "coloured by their distance from the first run's",
     OPTION_ENUM(Options, render.look.compare, look_compare_names)},
    {"--show", 0, "LIST", "Any of" SHOW_MARKS(SHOW_HELP) " separated by commas",
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

/* What the steps of a run's method cost: from a chart.csv, the same scene, closed loop, at the impact. */

/* All settings of `some` are in `all` with the same value; a network only has to be if `all` has one. */
static bool contains(const Settings *all, const Settings *some) {
    for (int i = 0; i < some->count; i++) {
        const char *key = some->items[i].key, *value = settings_get(all, key);
        if (value == NULL ? strcmp(key, "network") != 0 : strcmp(value, some->items[i].value) != 0) return false;
    }
    return true;
}

/* In any order, and whether given or not: "engine" is "engine:k=10" in a scene with 10 iterations. The chart has no
   setting for the network that the scene names. */
static bool has_settings(const ChartRow *row, const Trajectory *run) {
    char text[METHOD_TEXT_SIZE];
    Settings charted, own;
    if (snprintf(text, sizeof text, "%s%s%s", row->method, row->setting[0] != '\0' ? ":" : "", row->setting) >=
            (int)sizeof text ||
        !method_all_settings(&charted, text, run->iterations) ||
        !method_all_settings(&own, run->method, run->iterations))
        return false;
    return contains(&charted, &own) && contains(&own, &charted);
}

/* The row with the settings of the run. A run without settings that does not state its scene's iterations is the only
   row of its method. NULL if there is no row. */
static const ChartRow *find_cost(const CsvTable *table, const Trajectory *run) {
    const size_t length = strcspn(run->method, ":");
    const ChartRow *found = NULL;
    int fitting = 0;
    for (int i = 0; i < table->count; i++) {
        const ChartRow *row = chart_row(table, i);
        if (strcmp(row->scene, run->scene) != 0 || row->protocol != PROTOCOL_CLOSED || row->phase != PHASE_IMPACT ||
            isnan(row->us_solver) || strncmp(row->method, run->method, length) != 0 || row->method[length] != '\0')
            continue;
        if (has_settings(row, run)) return row;
        found = row;
        fitting++;
    }
    return run->method[length] == '\0' && run->iterations == 0 && fitting == 1 ? found : NULL;
}

typedef struct Costs {
    char texts[RENDER_PANELS_MAX][64];
} Costs;

/* A run without a row has no cost; a file without any row for the runs is refused. The look then points into
   `costs`. */
static bool read_costs(Costs *costs, const char *path, const Panels *panels, RenderLook *look, Error *error) {
    CsvTable table;
    if (!csv_table_read(&table, path, &chart_layout, error)) return false;
    int found = 0;
    for (int i = 0; i < panels->count; i++) {
        const ChartRow *row = find_cost(&table, panels->runs[i]);
        if (row == NULL) continue;
        const int decimals = row->us_solver < 1 ? 2 : row->us_solver < 100 ? 1 : 0;
        snprintf(costs->texts[i], sizeof costs->texts[i], "%.*f \xC2\xB5s a step at the impact", decimals,
                 row->us_solver);
        look->costs[i] = costs->texts[i];
        found++;
    }
    csv_table_free(&table);
    return found > 0 || error_input(error, path, "has no closed-loop time at the impact for any of these runs");
}

static bool writes_output(const Options *options) {
    for (int i = 0; i < options->video_count; i++)
        if (path_is_standard(options->videos[i])) return true;
    return false;
}

/* Names, sizes, places and programs, before anything is drawn. */
static bool check_videos(const Options *options, Error *error) {
    const int width = options->render.width, height = options->render.height;
    bool files = false;
    for (int i = 0; i < options->video_count; i++) {
        const char *path = options->videos[i];
        for (int k = 0; k < i; k++)
            if (strcmp(path, options->videos[k]) == 0) return error_input(error, "--video", "'%s' twice", path);
        if (!path_is_standard(path)) {
            if (!video_check(path, width, height, error)) return false;
            files = true;
        } else if (isatty(STDOUT_FILENO))
            return error_input(error, "--video", "'-' writes a video to standard output, which is a terminal");
    }
    return !files || video_check_programs(error);
}

/* Of slow motion around an impact that the pictures do not contain; -1 for none. */
static void note_missing_impact(const MomentPlan *plan, int impact) {
    char slow[64] = "nothing is slowed down";
    if (impact >= plan->first && impact <= plan->last) return;
    if (plan->slow > 1)
        snprintf(slow, sizeof slow, "frames %d to %d beside it are slowed down", plan->slow_first, plan->slow_last);
    if (impact < 0)
        note_print("--slow: no run has a contact of the bomb with a box; %s", slow);
    else
        note_print("--slow: frames %d to %d do not contain the impact, frame %d; %s", plan->first, plan->last, impact,
                   slow);
}

/* All that can be refused before anything is written. */
static bool check_panels(Options *options, const Panels *panels, Costs *costs, Error *error) {
    RenderOptions *render = &options->render;
    const Trajectory *const *runs = (const Trajectory *const *)panels->runs;
    if (options->caption_count > panels->count)
        return error_input(error, "--caption", "%d captions for %d run%s", options->caption_count, panels->count,
                           panels->count == 1 ? "" : "s");
    int end = 0;
    for (int i = 0; i < panels->count; i++) end = int_max(end, runs[i]->frames - 1);
    const int last = render->last < 0 ? end : render->last;
    MomentPlan plan;
    if (render->first > end || last > end)
        return error_input(error, "--frames", "%d is beyond the last frame, %d",
                           render->first > end ? render->first : last, end);
    if (!moments_plan(&plan, runs, panels->count, render->first, last, render, error)) return false;
    if (render->slow > 1) note_missing_impact(&plan, moments_impact(runs, panels->count));
    note_different_scenes(runs, panels->count);
    return (options->costs == NULL || read_costs(costs, options->costs, panels, &render->look, error)) &&
           picture_check(runs, panels->count, render, error);
}

static bool make_video(const char *path, const RenderOptions *render, const RenderResult *result, Error *error) {
    const bool output = path_is_standard(path);
    const VideoOptions video = {.directory = render->directory,
                                .first = result->first,
                                .last = result->last,
                                .frame_rate = result->rate,
                                .hashes = result->hashes,
                                .path = output ? "standard output" : path,
                                .rate_is_chosen = render->fps > 0};
    const Progress *progress = progress_bar_begin(output ? "writing" : "encoding");
    bool ok;
    if (output) { /* a closed pipe is reported as an error; without this, SIGPIPE would end the program */
        void (*before)(int) = signal(SIGPIPE, SIG_IGN);
        ok = video_write_y4m(&video, STDOUT_FILENO, progress, error);
        signal(SIGPIPE, before);
    } else
        ok = video_encode(&video, progress, error);
    progress_bar_end();
    return ok;
}

/* Draws the frames that the options select and encodes the videos; `result` owns no memory afterwards. */
static bool draw(const Options *options, const Panels *panels, RenderResult *result, Error *error) {
    const RenderOptions *render = &options->render;
    const Progress *progress = progress_bar_begin("drawing");
    note_verbose("drawing %d panel%s, %d x %d pixels, at most %d process%s", panels->count, plural(panels->count),
                 render->width, render->height, render->jobs, render->jobs == 1 ? "" : "es");
    bool ok = render_sequence((const Trajectory *const *)panels->runs, panels->count, render, result, progress, error);
    progress_bar_end();
    for (int i = 0; ok && i < options->video_count; i++) ok = make_video(options->videos[i], render, result, error);
    free(result->hashes);
    result->hashes = NULL;
    return ok;
}

/* Messages go to standard error if standard output is the video. */
static void print_result(const Options *options, const RenderResult *result) {
    const RenderOptions *render = &options->render;
    FILE *out = writes_output(options) ? stderr : stdout;
    if (render->resume && result->why[0] != '\0') fprintf(out, "nothing to resume: %s\n", result->why);
    fprintf(out, "%d frames -> %s/frame_%06d.png ... frame_%06d.png", result->last - result->first + 1,
            render->directory, result->first, result->last);
    if (render->resume) fprintf(out, ", %d of them kept", result->kept);
    fprintf(out, "\nmanifest -> %s/manifest.json\n", render->directory);
    for (int i = 0; i < options->video_count; i++) fprintf(out, "video -> %s\n", options->videos[i]);
}

/* Files in the folder of a sequence that could be mistaken for a part of it. */

/* The number of a frame's file, or -1. */
static int frame_of(const char *name) {
    int index = -1;
    char own[SINK_NAME_SIZE];
    if (sscanf(name, "frame_%9d.png", &index) != 1 || index < 0) return -1;
    sink_frame_name(own, index);
    return strcmp(name, own) == 0 ? index : -1;
}

static bool is_of_sequence(const char *name, const RenderResult *result, const Panels *panels) {
    const int frame = frame_of(name);
    if (frame >= 0) return frame >= result->first && frame <= result->last;
    for (int i = 0; i < panels->count; i++) {
        char own[TRAJECTORY_FILE_NAME_SIZE];
        trajectory_file_name((const Trajectory *const *)panels->runs, i, own);
        if (strcmp(name, own) == 0) return true;
    }
    return false;
}

/* False with an error if the system fails. */
static bool look_up(const char *path, struct stat *status, Error *error) {
    *status = (struct stat){.st_ino = 0};
    return stat(path, status) == 0 || errno == ENOENT || errno == ENOTDIR || errno == ELOOP || errno == EACCES ||
           error_system(error, path, "cannot be read: %s", strerror(errno));
}

/* Whether the file is one of the runs' inputs, by whatever path. False with an error if the system fails. */
static bool is_input(const char *directory, const char *name, const Panels *panels, Error *error) {
    char path[PATH_MAX];
    struct stat file, input;
    if (snprintf(path, sizeof path, "%s/%s", directory, name) >= (int)sizeof path || !look_up(path, &file, error))
        return false;
    for (int i = 0; i < panels->count; i++) {
        if (!look_up(panels->inputs[i], &input, error)) return false;
        if (input.st_ino != 0 && input.st_dev == file.st_dev && input.st_ino == file.st_ino) return true;
    }
    return false;
}

static bool find_foreign(FolderList *names, const char *directory, const RenderResult *result, const Panels *panels,
                         Error *error) {
    DIR *folder = opendir(directory);
    if (folder == NULL) return folder_error(directory, error);
    const struct dirent *entry;
    bool ok = true;
    while (errno = 0, ok && (entry = readdir(folder)) != NULL) {
        const char *name = entry->d_name;
        if (name[0] == '.' || (!file_name_ends_with(name, ".png") && !file_name_ends_with(name, ".npz")) ||
            is_of_sequence(name, result, panels) || is_input(directory, name, panels, error))
            continue;
        ok = error->kind == ERROR_NONE;
        if (!ok) break;
        char *copy = strdup(name);
        ok = copy != NULL &&
             array_reserve((void **)&names->names, &names->capacity, names->count + 1, sizeof *names->names);
        if (ok)
            names->names[names->count++] = copy;
        else
            free(copy), error_memory(error, "render");
    }
    if (ok && errno != 0) ok = error_system(error, directory, "cannot be read: %s", strerror(errno));
    closedir(folder);
    return ok;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* Names files that are not of the sequence, and not inputs of it. False if the folder cannot be read. */
static bool note_foreign_files(const char *directory, const RenderResult *result, const Panels *panels, Error *error) {
    enum { SHOWN = 5 };
    FolderList list = {0};
    char text[1024] = "";
    const bool ok = find_foreign(&list, directory, result, panels, error);
    if (ok && list.count > 0) {
        qsort(list.names, list.count, sizeof *list.names, by_name);
        size_t first = 0;
        for (int shown = 0; shown < SHOWN && first < list.count; shown++) {
            /* Frames that follow each other are named by the first and the last. */
            const int frame = frame_of(list.names[first]);
            size_t last = first;
            while (frame >= 0 && last + 1 < list.count &&
                   frame_of(list.names[last + 1]) == frame + (int)(last + 1 - first))
                last++;
            text_add(text, sizeof text, "%s%.100s", shown > 0 ? ", " : "", list.names[first]);
            if (last > first) text_add(text, sizeof text, "%s%s", last > first + 1 ? " ... " : ", ", list.names[last]);
            first = last + 1;
        }
        if (first < list.count) text_add(text, sizeof text, " and %zu more", list.count - first);
        note_print("%s also has %zu file%s that %s not of this sequence: %s", directory, list.count,
                   plural((int)list.count), list.count > 1 ? "are" : "is", text);
    }
    folder_list_free(&list);
    return ok;
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

/* What can be refused before a run is read. */
static bool check_options(const Options *options, Error *error) {
    const RenderOptions *render = &options->render;
    const char *path = render->directory, *ending = strrchr(path, '.');
    /* The name of a film after -o would become a folder of frames. */
    if (video_check_format(path, 2, 2, &(Error){0}))
        return error_input(error, path, "-o names the folder of the frames; for a film: -o %.*s --video %s",
                           (int)(ending - path), path, path);
    if (!output_check_folder_name(path, error) || !colours_check(&render->colours, error) ||
        !caption_check(render->title, "--title", error) || !caption_check(render->look.end, "--end", error))
        return false;
    for (int i = 0; i < options->caption_count; i++)
        if (!caption_check(render->captions[i], "--caption", error)) return false;
    return true;
}

bool command_render(int argc, char **argv, Error *error) {
    Options options = {.render = render_defaults(NULL), .frames = {0, -1}};
    RenderOptions *render = &options.render;
    if (!options_parse(&spec, argc, argv, &options, error) || !check_options(&options, error)) return false;
    render->first = options.frames.first;
    render->last = options.frames.last;
    render->title_card = render->title != NULL;
    render->end_card = render->look.end != NULL;
    render->store_runs = true;
    Panels panels = {0};
    Trajectory *view_from;
    bool ok = camera_option_load(options.view_from, &render->look.view, &view_from, error);
    render->look.view_from = view_from;
    Costs costs;
    RenderResult result;
    ok = ok && check_videos(&options, error) &&
         panels_load(&panels, options.inputs, options.input_count, &options.set, &options.methods, error) &&
         check_panels(&options, &panels, &costs, error) && draw(&options, &panels, &result, error);
    if (ok) print_result(&options, &result);
    ok = ok && note_foreign_files(render->directory, &result, &panels, error);
    if (ok && !writes_output(&options)) next_figure(render->directory, &panels);
    panels_free(&panels);
    trajectory_destroy(view_from);
    return ok;
}
