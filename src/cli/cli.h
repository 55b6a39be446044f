/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of the commands, and what they share: notes, progress, outputs, options, panels, drawing, pages. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/options.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "pictures/render.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stdio.h>

/* The commands of twinbox. Each is one file, with its option table and glue only, and one line here: name, summary, and
   the heading of the group that begins with it, or NULL. Help, manual page and completion have these groups. One without a
   summary is not listed. */

#define COMMANDS(COMMAND)                                                                    \
    COMMAND(new, "write a commented scene to start from", "Make")                            \
    COMMAND(check, "validate a scene and draw its first frame, or judge a stored run", NULL) \
    COMMAND(simulate, "run a scene with one method and store the run", NULL)                 \
    COMMAND(methods, "list the methods and their settings", NULL)                            \
    COMMAND(import, "store the run of another program, from CSV", NULL)                      \
    COMMAND(render, "draw runs side by side as PNG frames and videos", "Look")               \
    COMMAND(page, "write a page that plays runs side by side in a browser", NULL)            \
    COMMAND(figure, "draw a figure for a paper from runs", NULL)                             \
    COMMAND(export, "write a run as CSV or JSON", NULL)                                      \
    COMMAND(compare, "find where and why two runs, or two PNG sequences, differ", "Compare") \
    COMMAND(approve, "accept the changes that a report of compare shows", NULL)              \
    COMMAND(chart, "measure speed against accuracy for every method", "Measure")             \
    COMMAND(stability, "find where each method fails", NULL)                                 \
    COMMAND(train, "train the network of a method", "Learn")                                 \
    COMMAND(dataset, "record what the engine's solver does to each touching pair", NULL)     \
    COMMAND(paper, "reproduce the paper, from seed to report", "For research on the method") \
    COMMAND(merge, "join what the shards of a study did", NULL)                              \
    COMMAND(solve, "solve the contact problem of one step with many methods", NULL)          \
    COMMAND(completion, NULL, NULL)

typedef struct Command {
    const char *name, *summary; /* summary NULL: not listed */
    const char *heading;        /* of the group that begins with it; NULL: of the group of the command before it */
    /* True: done and equal (exit status 0). False: different (1) or, with error set, failed: the caller prints the error
       and exits with its kind. argv[0] is "twinbox NAME". Bad options and --help end the program from within argp. */
    bool (*run)(int argc, char **argv, Error *error);
} Command;

/* All commands, ended by a NULL name. For the help: what the program does, and a first command line. */
extern const Command commands[];
extern const char program_summary[], program_begin[];

#define COMMAND_DECLARED(name, summary, heading) bool command_##name(int argc, char **argv, Error *error);
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

/* What a command prints on standard error beside its errors. The options -q and -v, which every command has, set the
   level; errors do not depend on it, nor do results that go to no file. */

typedef enum NoteLevel { NOTES_QUIET, NOTES_NORMAL, NOTES_VERBOSE } NoteLevel;

/* With NOTES_VERBOSE, the lines of base/base.h are printed, too, equal ones once. */
void note_set_level(NoteLevel level);
NoteLevel note_level(void);

/* "twinbox: note: TEXT": what the user should know about the result. Not with -q. */
void note_print(const char *format, ...) PRINTF_LIKE(1, 2);

/* "twinbox: TEXT": how the result came about. Only with -v. */
void note_verbose(const char *format, ...) PRINTF_LIKE(1, 2);

/* "next: twinbox WORD...", which ends with NULL, on standard output: what to type next. Words are quoted for a shell. Not with
   -q. */
void next_print(const char *const words[]);

/* "out/NAME" and the ending: for what the next command writes. */
typedef struct NextPath {
    char text[TRAJECTORY_NAME_SIZE + 32];
} NextPath;
NextPath next_path(const char *name, const char *ending);

/* To render a scene or a run as a film: "next: twinbox render wall.yaml -o out/wall --video out/wall.mp4". */
void next_film(const char *path);

/* Keeps back what is printed on standard output from now on. With -q, of commands whose results are files; main() prints it if
   the command does not succeed. */
void results_keep(void);
void results_end(bool print);

/* With -v: version, threads and instruction set before the work; time and memory after it. */
void note_begin(const char *command);
void note_end(void);

/* A progress bar on a terminal, lines of text elsewhere; with the time left once it is known.
   A signal requests the work to stop. Work of less than a second shows nothing. There is one bar at a time. */

/* Replaces the bar before it, and returns what the work reports to. Signals that are held stay so. */
const Progress *progress_bar_begin(const char *what);

/* Removes the bar from the terminal so that a line can be printed; the next report shows it again. */
void progress_bar_clear(void);
void progress_bar_end(void);

/* How long work still takes, at the rate of its recent progress. Fed with times: it reads no clock. */

enum { TIME_LEFT_SAMPLES = 64, TIME_LEFT_TEXT_SIZE = 32 };

typedef struct TimeLeft {
    int count;
    double spacing; /* s: samples are at least this far apart; it doubles when there is no room for more */
    struct TimeLeftSample {
        double time, part;
    } samples[TIME_LEFT_SAMPLES];
} TimeLeft;

/* Begins with work of which nothing is done. */
void time_left_begin(TimeLeft *left);

/* At `time` s after the beginning, this part (0 to 1) is done. Neither may fall. */
void time_left_add(TimeLeft *left, double time, double part);

/* The seconds that are left at the rate of the last third of the time, at least 4 s. False if that means little: in the
   first 2 s, with less than 2% done in the first 20 s, or 0.2% later, or while the rates of both halves of that time
   differ by more than a factor of 2. */
bool time_left_estimate(const TimeLeft *left, double time, double part, double *seconds);

/* "8 s", "6 min 40 s" or "2 h 10 min": no digits that an estimate does not have. */
void time_left_text(double seconds, char text[TIME_LEFT_TEXT_SIZE]);

/* SIGINT (Ctrl-C), SIGTERM and SIGHUP. Each ends the program with exit status 130 (ERROR_INTERRUPTED), in every command: at
   once where nothing would look at a request, between two pieces of work while signals are held. Files are written
   beside their name and renamed, so that an end at once leaves no half of one. */

/* Handles both signals from here on, also where the shell has a background process ignore them. */
void interrupt_handle(void);

/* While held, the first signal only requests a stop, and a second one, a second later or more, ends the program. The calls
   nest. */
void interrupt_hold(void);
void interrupt_release(void);

/* True after a signal. From any thread. */
bool interrupt_requested(void);

/* The signal was the expected end of the work, which was not interrupted by it. */
void interrupt_forget(void);

/* Checks of output paths before the work begins, so that hours of training do not end in "cannot write". A check leaves
   nothing behind. What may still fail later (a full disk) is reported by the writer. */

/* A file can be written to `path`: its folder exists and takes new files, and the path is no folder. ending: of the name,
   such as ".npz"; NULL: any. "-" (standard output), devices and pipes pass. ERROR_INPUT: another ending, or a folder;
   ERROR_SYSTEM: the folder is missing or takes no files. */
bool output_check_file(const char *path, const char *ending, Error *error);

/* The same for a .npz file of this kind (npz_check_kind; NULL: a run, which has none). ERROR_INPUT also if there is a file
   of another kind: it must not be lost by a mistyped name. */
bool output_check_npz(const char *path, const char *kind, Error *error);

/* ERROR_INPUT for a folder with the name of a file, such as "chart.png", which is a mistake. */
bool output_check_folder_name(const char *path, Error *error);

/* A folder exists and takes new files, or can be made with its parents; and its name. */
bool output_check_folder(const char *path, Error *error);

/* Results as JSON (--json): one object on standard output and nothing else there. Its first key is "format": the name of
   the command and the version of the keys, "twinbox solve 1". A number that is not finite is null. After an error
   nothing is printed. */

#define OPTION_JSON(T, member) \
    "--json", 0, NULL, "Print the result as one JSON object on standard output", OPTION_FLAG(T, member)

/* Refuses --json where a file is written to standard output. */
bool json_output_check(bool json, Error *error);

/* Prints what `write` puts between the format and the end of the object. */
typedef void JsonOutputWrite(JsonWriter *json, const void *context);
bool json_output(const char *format, JsonOutputWrite *write, const void *context, Error *error);

/* "point": [x, y] */
void json_output_pair(JsonWriter *json, const char *key, double x, double y);

/* The option --frames A:B of commands that show runs. */

typedef struct FrameRange {
    int first, last; /* inclusive; last -1: to the end */
} FrameRange;

/* "A:B", ":B", "A:" or "A"; `value` is a FrameRange. */
OptionRead frames_option_read;

/* Splits text at the first `separator` into two whole numbers. An empty part leaves its number unchanged. */
bool frames_option_split(const char *text, char separator, int minimum, int maximum, int64_t numbers[2]);

/* The options --camera X,Y,W,H and --view-from RUN of pictures and figures. */

#define CAMERA_OPTION_VIEW "X,Y,W,H: the view around the point (X, Y), W wide and H high, in metres"

/* An option's value "X,Y,W,H". */
bool camera_option_read(const Option *option, const char *text, void *view, Error *error);

/* Reads the run of --view-from, which the caller destroys; NULL if there is no `path`. ERROR_INPUT beside a view. */
bool camera_option_load(const char *path, const CameraView *view, Trajectory **run, Error *error);

/* The option --shard of commands whose work can be done in pieces (runs/pieces.h). */

/* The row of a command's table; member: a text, NULL if it is not given. */
#define OPTION_SHARD(T, member)                                                                                      \
    "--shard", 0, "I/N", "Do share I of N only; 'twinbox merge' joins them (default: as Slurm or MPI says, or all)", \
        OPTION_TEXT(T, member)

/* How the command is to run: as a merge, a shard or the whole. A note tells what the environment says. argv must last. */
bool shard_option_take(PiecesRun *run, const char *option, int argc, char **argv, Error *error);

/* The result of a shard: "shard 3 of 16: 30 pieces ...". output: as given to pieces_open(). */
void shard_option_print(const Pieces *pieces, const char *output);

/* The next command that runs is a merge. */
void shard_option_merge(const PiecesRun *run);

/* Finds the scenes that `cmake --install` put beside the program. */

/* A file or folder given on the command line: the path itself; but if it is relative and there is nothing under it in the
   working directory, the one of the installed data, if that exists: "/usr/share/twinbox/scenes/stack.yaml" for
   "scenes/stack.yaml". A name without "/" and "." is a scene's, too: "stack" for "scenes/stack.yaml", of the working
   directory or installed. Valid until the program ends. */
const char *installed_path(const char *path);

/* The text of a method, in which the file of its network is looked for in the same way. Valid until the program ends. */
const char *installed_network(const char *method);

/* Calls found("stack", context) and found("scenes/stack.yaml", context) for each scene that installed_path() finds by its
   name, or, but for what the working directory has, by its path. Names may come twice. */
typedef void InstalledScene(const char *scene, void *context);
void installed_scenes(InstalledScene *found, void *context);

/* The runs in a picture: read from .npz, or simulated from a scene, with the engine and with pair-net unless methods are given. */

typedef struct Panels {
    int count;
    Trajectory *runs[RENDER_PANELS_MAX];
    const char *inputs[RENDER_PANELS_MAX]; /* the file of each run, or its scene's */
} Panels;

/* What a CommandSpec says of such inputs. T is the command's Options, with inputs[RENDER_PANELS_MAX] and input_count. */
#define PANELS_INPUTS(T)                                             \
    .input = {.value = "RUN_OR_SCENE...",                            \
              .needed = "a run (.npz) or a scene (.yaml) is needed", \
              OPTION_PATHS(T, inputs, input_count)},                 \
    .inputs = {1, RENDER_PANELS_MAX, "panel"}

/* The option --method of commands that show runs: by what the scenes among the inputs are simulated. */
typedef struct PanelMethods {
    const char *texts[RENDER_PANELS_MAX];
    int count; /* 0: the command's default */
} PanelMethods;

#define OPTION_METHODS(T, member, defaults)                                                          \
    "--method", 'm', "NAME[:KEY=VALUE,...]",                                                         \
        "Simulate the scene by this method, for a panel of its own (may be repeated; " defaults ")", \
        OPTION_METHOD_TEXTS(T, member.texts, member.count)

/* Settings need exactly one scene among the inputs, methods one at least. After an error, panels_free frees what was loaded
   before it. */
bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set,
                 const PanelMethods *methods, Error *error);

/* Adds a run of the scene file by each of the methods. */
bool panels_add_scene(Panels *panels, const char *input, const SceneSettings *set, const PanelMethods *methods,
                      Error *error);
void panels_free(Panels *panels);

/* Simulates a scene with a method, with a progress bar, and adds the run. Errors name `input`. */
bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error);

/* The same with another progress; NULL: the bar. */
bool panels_add_watched(Panels *panels, const Scene *scene, const char *method_name, const char *input,
                        const Progress *progress, Error *error);

/* Writes each run into the directory, under its trajectory_file_name(). */
bool panels_store(const Panels *panels, const char *directory, Error *error);

/* The time per step of each panel's method, for the captions. */

typedef struct PanelCosts {
    char texts[RENDER_PANELS_MAX][64];
} PanelCosts;

/* Reads the costs of the panels from a chart.csv: the same scene, closed loop, at the impact. A run without a row has no
   cost; a file without any row for the runs is refused. The look then points into `costs`. */
bool panel_costs_read(PanelCosts *costs, const char *path, const Panels *panels, RenderLook *look, Error *error);

/* Draws panels as frames and videos, with progress bars. */

enum { DRAW_VIDEOS_MAX = 8 };

/* "-": y4m on standard output. */
typedef struct DrawVideos {
    int count;
    const char *paths[DRAW_VIDEOS_MAX];
} DrawVideos;

/* 1920 x 1080, all frames, one process per core. */
RenderOptions draw_panels_defaults(const char *directory);

/* The last frame of the longest panel. */
int panels_last_frame(const Panels *panels);

/* Checks the videos before anything is drawn: names and sizes; and, unless a merge is to encode them, programs and where
   they go. */
bool draw_videos_check(const DrawVideos *videos, int width, int height, bool of_merge, Error *error);
bool draw_videos_use_output(const DrawVideos *videos);

/* Draws the frames that `render` selects and encodes the videos; a shard draws only. study: render_study(). `result` owns
   no memory afterwards. */
bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderStudy *study,
                 RenderResult *result, Error *error);

/* Notes on standard error about pictures that may not show what their user expects. */

/* If the runs are of different scenes. A run without a scene_hash is of an unknown scene, and not compared. */
void note_different_scenes(const Trajectory *const *runs, int count);

/* If the frames do not contain the impact, -1 for none, around which they are to be slow. */
void note_missing_impact(const MomentPlan *plan, int impact);

/* If the folder has pictures or runs that are not of the sequence, and not inputs of it. False if it cannot be read. */
bool note_foreign_files(const char *directory, const RenderResult *result, const Panels *panels, Error *error);

/* What 'twinbox render' does for the shards of a film (render_study()). */

/* Everything that decides the files beside what the manifest tells: the program, the runs, as read or as simulated here, and
   the videos. costs: FILE.csv, or NULL. */
bool render_key(StudyKey *key, const Panels *panels, const DrawVideos *videos, const char *costs, Error *error);

/* Whether the merge can read an input again; path may be NULL. */
bool render_check_again(const char *path, Error *error);

/* RenderStudy.begin: stores the runs. context: a RunsPlace. */
typedef struct RunsPlace {
    const Panels *panels;
    const char *directory;
} RunsPlace;
bool render_store_runs(void *context, Error *error);

/* The pages of a study, folder/pages/NAME.html, and the table that lists them. They are written in parts, one after the
   other, so that a study that is interrupted continues with the page that it was at. */

/* All pages of a folder together, and the states in one page, which has only every n-th frame if they would take more. */
#define PAGE_SET_MAX_BYTES (256 << 20)
#define PAGE_SET_STATE_BYTES (8 << 20)

enum { PAGE_NAME_SIZE = 256 };

/* The caller sets the first five members. */
typedef struct PageSet {
    const char *folder;
    const CsvLayout *layout; /* of the table; its last columns are a link into a page and the page's bytes */
    int parts;
    /* Writes the pages of a part, and the table's rows that list them (piece_tables_print). Parts come in their order, but for
       those that an earlier run did. Rows of one page follow each other; where a page was left out, their last columns are
       empty and 0. */
    bool (*write)(void *context, int part, FILE *rows, const Progress *progress, Error *error);
    void *context;
    Pieces pieces;
    PiecePlan plan;
    int counted;               /* parts whose pages are counted: */
    int64_t bytes;             /* of the pages so far */
    int pages, left_out;       /* left out: beyond PAGE_SET_MAX_BYTES */
    char last[PAGE_NAME_SIZE]; /* the page of the last row that had one */
} PageSet;

/* Writes the pages and the table. key: of the study (runs/pieces.h). */
bool page_set_make(PageSet *set, uint64_t key, const Progress *progress, Error *error);

/* Removes what the parts have left, once all that the caller makes of the table is written. */
bool page_set_end(const PageSet *set, Error *error);

/* For `write`: makes `name` fit a file, and path "pages/NAME.html" of it; writes that page. path is empty and bytes is 0 if
   there is no room for it. */
typedef struct PageFile {
    char path[PAGE_NAME_SIZE];
    int bytes;
} PageFile;
bool page_set_write(const PageSet *set, const char *name, const Trajectory *const *runs, int count,
                    const PlayerOptions *options, PageFile *file, Error *error);

/* "pages/NAME.html#t=0.55&body=7&run=1": the moment, and the body in that run of the page. Of a page that was left out,
   empty. */
enum { PAGE_LINK_SIZE = PAGE_NAME_SIZE + PLAYER_LINK_SIZE + 16 };
void page_set_link(char link[PAGE_LINK_SIZE], const PageFile *file, double time, int body, int run);

/* "14 pages of 2.1 MB -> DIR/pages" and what was left out. */
void page_set_print(const PageSet *set, const char *html);

/* The scenes of scenes/templates/, embedded in the binary (src/CMakeLists.txt lists them, too). */

#define TEMPLATES(TEMPLATE) \
    TEMPLATE(wall)          \
    TEMPLATE(stack)         \
    TEMPLATE(pyramid)       \
    TEMPLATE(arch) TEMPLATE(dominoes) TEMPLATE(towers) TEMPLATE(gate) TEMPLATE(cardhouse) TEMPLATE(pile)

#define TEMPLATE_DECLARED(name) extern const char template_##name##_yaml[];
TEMPLATES(TEMPLATE_DECLARED)
#undef TEMPLATE_DECLARED

/* The scripts in src/cli/completion, each ended by a 0. */

extern const char completion_twinbox_bash[], completion__twinbox[], completion_twinbox_fish[];

/* What `twinbox --version -v` adds: what pictures are drawn by. */

/* A line for each kind of context: Mesa's version and rasteriser, or why it cannot be used. The one that `render` takes
   by default is marked. */
void print_contexts(FILE *file);
