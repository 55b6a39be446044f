/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "runs/trajectory.h"

#include <limits.h>

typedef struct Options {
    const char *inputs[RENDER_PANELS_MAX], *output;
    int input_count, every;
    FrameRange frames;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "FILE", "Page to write: FILE.html", OPTION_OUTPUT(Options, output),
     .needed = "-o FILE is needed"},
    {"--every", 0, "N", "Keep every N-th frame only", OPTION_INT(Options, every, 1, INT_MAX)},
    {"--frames", 0, "A:B", "Keep only these frames of the runs (default: all)",
     OPTION_READ(frames_option_read, Options, frames)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    PANELS_INPUTS(Options),
    .help =
        "Write one HTML file that plays runs side by side in any browser, without a network or other files. Its "
        "readers "
        "can stop, zoom, measure bodies, and link to a moment. A run is a stored trajectory (.npz). A scene (.yaml) is "
        "simulated with the engine and with the pair-net that it names. A page takes at most 64 MB: contacts are left "
        "out if it would take more.\v"
        "Example: twinbox page engine.npz net.npz -o stack.html"};

/* The file's name without its folder, which differs between machines; NULL for a run that is simulated here. */
static const char *file_of(const char *input) {
    return file_name_ends_with(input, ".npz") ? input + file_folder_length(input) : NULL;
}

static bool write_page(const Options *options, const Panels *panels, Error *error) {
    const Trajectory *const *runs = (const Trajectory *const *)panels->runs;
    PlayerOptions page = {.first = options->frames.first,
                          .last = options->frames.last,
                          .every = options->every,
                          .describe = draw_panels_defaults(NULL).describe};
    PlayerResult result;
    for (int i = 0; i < panels->count; i++) page.files[i] = file_of(panels->inputs[i]);
    if (!player_write(runs, panels->count, &page, options->output, &result, error)) return false;
    note_different_scenes(runs, panels->count);
    if (result.left_contacts) note_print("contacts are left out: with them the page would take more than 64 MB");
    printf("%d run%s of %d frames, %.2f MB -> %s\n", panels->count, panels->count == 1 ? "" : "s", result.frames,
           (double)result.bytes / 1e6, options->output);
    return true;
}

bool command_page(int argc, char **argv, Error *error) {
    Options options = {.every = 1, .frames = {0, -1}};
    const SceneSettings none = {0};
    Panels panels = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!output_check_file(options.output, ".html", error)) return false;
    const bool ok =
        panels_load(&panels, options.inputs, options.input_count, &none, error) && write_page(&options, &panels, error);
    panels_free(&panels);
    return ok;
}
