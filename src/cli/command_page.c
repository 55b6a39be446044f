/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox page: runs, or scenes that are stepped in the browser, as one HTML file. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/notes.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/panels.h"
#include "live/live.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Options {
    const char *inputs[RENDER_PANELS_MAX], *captions[RENDER_PANELS_MAX], *output, *title;
    int input_count, caption_count, every;
    PanelMethods methods;
    bool live;
    FrameRange frames;
    SceneSettings set;
    ColourChoices colours;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "FILE", "Page to write: FILE.html", OPTION_OUTPUT(Options, output),
     .needed = "-o FILE is needed"},
    {"--every", 0, "N", "Keep every N-th frame only", OPTION_INT(Options, every, 1, INT_MAX)},
    {"--frames", 0, "A:B", "Keep only these frames of the runs (default: all)",
     OPTION_READ(frames_option_read, Options, frames)},
    {"--title", 0, "TEXT", "Title of the page (default: the scene's name)", OPTION_TEXT(Options, title)},
    {"--caption", 0, "TEXT",
     "Name of a run, instead of its method's (may be repeated: one per run, in their order; \"\" keeps the name)",
     OPTION_TEXTS(Options, captions, caption_count)},
    {OPTION_METHODS(Options, methods,
                    "default: engine, and pair-net if the scene names one; with --live: engine and interior")},
    {OPTION_SET(Options, set)},
    {OPTION_COLOUR(Options, colours)},
    {.help = "Live pages:"},
    {"--live", 0, NULL,
     "The page steps the scene itself: its readers drag the bomb and change settings and methods, and get the bits of "
     "twinbox simulate",
     OPTION_FLAG(Options, live)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    PANELS_INPUTS(Options),
    .help =
        "Write one HTML file that plays runs side by side in any browser, without a network or other files. Its "
        "readers can stop, zoom, measure bodies, and link to a moment. The address stack.html#stage shows the stage "
        "and the time line alone, as the key h does: for a projector, and for <iframe src=\"stack.html#stage\"> in "
        "another page. A run is a stored trajectory (.npz). A scene (.yaml) is simulated first. With --live, a method "
        "that a page cannot run is recorded. A page takes at most 64 MB: contacts are left out if it would take more.\v"
        "Example: twinbox page stack -o stack.html\n"
        "         twinbox page --live stack -m engine -m interior -o live.html"};

static bool write_page(const Options *options, const Panels *panels, const PlayerLive *live, Error *error) {
    char set[SCENE_SETTINGS_MAX * (SCENE_PARAMETER_SIZE + 32)] = ""; /* "bomb_x=2.5,height=12" */
    const Trajectory *const *runs = (const Trajectory *const *)panels->runs;
    PlayerOptions page = {.first = options->frames.first,
                          .last = options->frames.last,
                          .every = options->every,
                          .set = set,
                          .live = live,
                          .title = options->title,
                          .colours = options->colours,
                          .describe = render_defaults(NULL).describe};
    PlayerResult result;
    if (options->caption_count > panels->count)
        return error_input(error, "--caption", "%d captions for %d run%s", options->caption_count, panels->count,
                           panels->count == 1 ? "" : "s");
    for (int i = 0; i < panels->count; i++) {
        /* Folders differ between machines, but a scene is as it was typed, where that means the same in another
           checkout. */
        const char *input = installed_name(panels->inputs[i]), *name = input + file_folder_length(input);
        const bool elsewhere = input[0] == '/' || strncmp(input, "../", 3) == 0 || strstr(input, "/../") != NULL;
        if (file_name_ends_with(input, ".npz"))
            page.files[i] = name;
        else
            page.scenes[i] = elsewhere ? name : input;
        if (i < options->caption_count && options->captions[i][0] != '\0') page.names[i] = options->captions[i];
    }
    for (int i = 0; i < options->set.count; i++)
        text_add(set, sizeof set, "%s%s=%.17g", i > 0 ? "," : "", options->set.items[i].name,
                 options->set.items[i].value);
    if (!player_write(runs, panels->count, &page, options->output, &result, error)) return false;
    note_different_scenes(runs, panels->count);
    if (result.left_contacts) note_print("contacts are left out: with them the page would take more than 64 MB");
    printf("%d run%s of %d frames, %.2f MB -> %s\n", panels->count, panels->count == 1 ? "" : "s", result.frames,
           (double)result.bytes / 1e6, options->output);
    return true;
}

/* One scene, of which all other inputs are stored runs. */
static bool write_live(const Options *options, Panels *panels, Error *error) {
    static const PanelMethods usual = {{"engine", "interior"}, 2}, stored = {.count = 0};
    static const SceneSettings none = {0};
    const PanelMethods *methods = options->methods.count > 0 ? &options->methods : &usual;
    const char *scene = NULL, *runs[RENDER_PANELS_MAX], *live_methods[RENDER_PANELS_MAX];
    int run_count = 0, live_count = 0;
    for (int i = 0; i < options->input_count; i++) {
        const char *input = options->inputs[i];
        const bool run = file_name_ends_with(input, ".npz");
        if (!run && scene != NULL) return error_input(error, "--live", "needs one scene (got %s and %s)", scene, input);
        if (run)
            runs[run_count++] = input;
        else
            scene = input;
    }
    if (scene == NULL) return error_input(error, "--live", "needs a scene (.yaml)");
    if (live_module(false).size == 0)
        return error_input(error, "--live",
                           "this build has no module for live pages; install clang, lld, wasi-libc, "
                           "libclang-rt-dev-wasm32 and binaryen (tests/setup does), then configure and build afresh");

    /* Simulates the scene by each method here, too: the page compares its own hashes with these. */
    PlayerLive live = {0};
    bool networks = false;
    if (!panels_add_scene(panels, scene, &options->set, methods, error)) return false;
    for (int i = 0; i < methods->count; i++) {
        const MethodDescription *method = method_describe(methods->texts[i]);
        if (method == NULL || !live_has_method(method)) {
            note_print("%s is recorded: a page cannot run it", methods->texts[i]);
            continue;
        }
        networks |= method->needs_network;
        live_methods[live_count++] = live.methods[i] = panels->runs[i]->method;
    }
    live.module = live_module(networks);
    void *bundle = NULL;
    bool ok = panels_load(panels, runs, run_count, &none, &stored, error) &&
              live_pack(scene, live_methods, live_count, &bundle, &live.bundle_size, error);
    live.bundle = bundle;
    ok = ok && write_page(options, panels, &live, error);
    free(bundle);
    return ok;
}

bool command_page(int argc, char **argv, Error *error) {
    Options options = {.every = 1, .frames = {0, -1}};
    Panels panels = {0};
    if (!options_parse(&spec, argc, argv, &options, error) || !output_check_file(options.output, ".html", error) ||
        !caption_check(options.title, "--title", error))
        return false;
    for (int i = 0; i < options.caption_count; i++)
        if (!caption_check(options.captions[i], "--caption", error)) return false;
    if (options.live && (options.every > 1 || options.frames.first != 0 || options.frames.last != -1))
        return error_input(error, "--live", "shows whole runs; leave out --every and --frames");
    const bool ok = options.live ? write_live(&options, &panels, error)
                                 : panels_load(&panels, options.inputs, options.input_count, &options.set,
                                               &options.methods, error) &&
                                       write_page(&options, &panels, NULL, error);
    panels_free(&panels);
    return ok;
}
