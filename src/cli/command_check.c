/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox check: validates a scene and draws its first frame, or judges a stored run. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/judge.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/panels.h"
#include "engine/engine.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "runs/launch_check.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 1280, HEIGHT = 720 };

/* s after the bomb is added in which it has struck: the picture shows its path. */
static const double way = 3;

typedef struct Options {
    const char *scene, *output;              /* output: NULL for NAME-first-frame.png */
    unsigned verdict;                        /* of `verdicts` */
    double max_overlap, max_drift, max_gain; /* m, m, J; NaN: any */
    JudgeOptions judge;
    bool json;
} Options;

static const char *const verdicts[] = {"any",   "sound",     "holds",    "settles",    "stands",
                                       "moves", "too short", "falls",    "collapses",  "hangs",
                                       "sinks", "tunnels",   "explodes", "non-finite", NULL};

static const Option option_table[] = {
    {"--output", 'o', "FILE.png",
     "Picture of the first frame (default: NAME-first-frame.png in the working folder); - writes it to standard output",
     OPTION_TEXT(Options, output)},
    {OPTION_JSON(Options, json)},
    {.help = "Runs (.npz):"},
    OPTIONS_JUDGE(Options, judge),
    {"--verdict", 0, "WORD",
     "Fail with exit status 1 unless the verdict is this: sound (nothing hangs, sinks, tunnels or explodes; it may "
     "fall), holds (settles, stands or moves), settles, stands, moves, too short, falls, collapses, hangs, sinks, "
     "tunnels, explodes, non-finite (default: any)",
     OPTION_ENUM(Options, verdict, verdicts)},
    {"--max-overlap", 0, "M", "Fail if two boxes overlap by more, m", OPTION_DOUBLE(Options, max_overlap, 0, 1e6)},
    {"--max-drift", 0, "M", "Fail if a body moves further after the time that the verdict names, m",
     OPTION_DOUBLE(Options, max_drift, 0, 1e6)},
    {"--max-gain", 0, "J", "Fail if the energy exceeds that of the start and the bomb by more, J",
     OPTION_DOUBLE(Options, max_gain, 0, 1e12)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE|RUN.npz", .needed = "a scene or a run (.npz) is needed", OPTION_PATH(Options, scene)},
    .inputs = {1, 1, "input"},
    .help =
        "Validate a scene: all keys, boxes that start inside others, the launches of the bomb, the networks that it "
        "names, and each parameter at both ends. Prints a summary, which names launches that strike no box "
        "(it tries 41 at most, with the engine), and draws the first frame with the path of the bomb.\n"
        "Or judge a stored run of any engine: the verdict that simulate prints, the deepest overlap, drift and energy "
        "gained. Contacts are recomputed from the poses.\v"
        "Example: twinbox check stack -o first.png\n"
        "         twinbox simulate stack -o engine.npz\n"
        "         twinbox check engine.npz --scene stack --verdict sound"};

static void print_bodies(FILE *out, const Scene *scene) {
    double mass = 0;
    int fixed = 0;
    for (int i = 0; i < scene->body_count; i++) {
        fixed += scene->bodies[i].fixed;
        mass += scene->bodies[i].fixed ? 0 : (double)scene->bodies[i].mass;
    }
    const int boxes = scene->body_count - fixed;
    fprintf(out, "    bodies: %d box%s of %.6g kg together, and %d static\n", boxes, boxes == 1 ? "" : "es", mass,
            fixed);
    fprintf(out, "    duration: %d steps of %.6g s, %.6g s; %d iterations per step\n", scene->frames, (double)scene->dt,
            scene->frames * (double)scene->dt, scene->iterations);
    if (scene->overlaps_allowed) fprintf(out, "    overlaps: allowed\n");
}

/* Where the engine's lengths do not fit the scene: shares of the smallest side of a box. */
typedef struct Fit {
    double side;              /* m; INFINITY: no box */
    double slop;              /* of that, what contacts leave uncorrected */
    double step;              /* of that, how far a box at rest falls in a step before its contact is felt */
    double apart, moved, far; /* m: positions as float32, the motion of a body in a step, there; `far` from 0 */
} Fit;

/* The body that loses the largest share of its motion, as stated or after a fall by `side`, to the rounding of its
   position. */
static void find_rounding(Fit *fit, const BodyDef *body, double dt, double pull) {
    const double speed = vec2_distance(body->velocity, vec2(0, 0));
    const float far = fmaxf(fabsf(body->position.x), fabsf(body->position.y));
    const double apart = (double)(nextafterf(far, INFINITY) - far),
                 moved = dt * (speed > 0 ? speed : sqrt(pull * fit->side));
    if (moved > 0 && apart * fit->moved >= fit->apart * moved)
        fit->apart = apart, fit->moved = moved, fit->far = (double)far;
}

static Fit find_fit(const Scene *scene) {
    const double dt = (double)scene->dt, pull = vec2_distance(scene->gravity, vec2(0, 0));
    double side = INFINITY;
    for (int i = 0; i < scene->body_count; i++)
        if (!scene->bodies[i].fixed)
            side = fmin(side, fmin((double)scene->bodies[i].size.x, (double)scene->bodies[i].size.y));
    Fit fit = {.side = side, .slop = (double)CONTACT_SLOP / side, .step = pull * dt * dt / side, .moved = 1};
    for (int i = 0; i < scene->body_count; i++)
        if (!scene->bodies[i].fixed) find_rounding(&fit, &scene->bodies[i], dt, pull);
    const BodyDef bomb = scene_bomb_body(scene);
    if (scene->bomb.present) find_rounding(&fit, &bomb, dt, pull);
    return fit;
}

static const double small = 0.05; /* as a share of a side, or of a motion */

static bool check_rounding(const Fit *fit) { return fit->apart / 2 <= small * fit->moved; }

static bool check_fits(const Fit *fit) { return fit->slop <= small && fit->step <= small; }

static void print_fit(FILE *out, const Scene *scene) {
    const Fit fit = find_fit(scene);
    if (!check_fits(&fit))
        fprintf(
            out,
            "    size: of the smallest side, %.3g m, contacts leave %.3g%% as overlap (slop, %g m), and a box falls by "
            "%.3g%% in a step: make the scene larger, or dt shorter\n",
            fit.side, 100 * fit.slop, (double)CONTACT_SLOP, 100 * fit.step);
    if (!check_rounding(&fit))
        fprintf(
            out,
            "    rounding: %.6g m from 0, positions are %.3g m apart (float32), and a body moves by %.3g m in a step: "
            "make dt longer, or move the scene towards 0\n",
            fit.far, fit.apart, fit.moved);
}

/* "launches from x = -4.9 to -1.25 and from 1.25 to 4.9 m": where they miss, if they differ in x. */
static void print_misses(FILE *out, const Scene *scene, const LaunchMisses *misses) {
    char which[400] = "launches";
    for (int i = 0; scene_span_varies(&scene->bomb.x) && i < misses->span_count; i++) {
        const OverlapSpan *span = &misses->spans[i];
        const bool alone = span->from == span->to;
        text_add(which, sizeof which, "%s %s %s%.3g", i == 0 ? "" : " and", alone ? "at" : "from", i == 0 ? "x = " : "",
                 span->from);
        if (!alone) text_add(which, sizeof which, " to %.3g", span->to);
        if (i + 1 == misses->span_count) text_add(which, sizeof which, " m");
    }
    if (misses->tried == 0)
        fprintf(out, "    misses: not looked for, as the scene is large\n");
    else if (misses->missed > 0 && misses->tried == 1)
        fprintf(out, "    misses: the bomb strikes no box\n");
    else if (misses->missed > 0)
        fprintf(out, "    misses: %s strike no box (%d of %d tried)%s\n", which, misses->missed, misses->tried,
                misses->missed == misses->tried ? "; chart and train refuse such a scene" : "");
}

/* ", x from -5 to 5 m": behind the family so far. */
static void add_family(char *text, size_t size, const char *name, const SceneSpan *span, const char *unit) {
    if (scene_span_varies(span))
        text_add(text, size, "%s%s from %.6g to %.6g %s", text[0] != '\0' ? ", " : "", name, (double)span->from,
                 (double)span->to, unit);
}

static void print_bomb(FILE *out, const Scene *scene) {
    const SceneBomb *bomb = &scene->bomb;
    const BodyDef body = scene_bomb_body(scene);
    char family[256] = "";
    if (!bomb->present) {
        fprintf(out, "    bomb: none\n");
        return;
    }
    fprintf(out, "    bomb: %.6g kg, added after step %d at (%.6g, %.6g) m with (%.6g, %.6g) m/s\n", (double)body.mass,
            bomb->frame, (double)body.position.x, (double)body.position.y, (double)body.velocity.x,
            (double)body.velocity.y);
    add_family(family, sizeof family, "x", &bomb->x, "m");
    add_family(family, sizeof family, "rotation", &bomb->rotation, "rad");
    add_family(family, sizeof family, "spin", &bomb->spin, "rad/s");
    add_family(family, sizeof family, "mass", &bomb->mass, "kg");
    fprintf(out, "    launches: %s\n", family[0] != '\0' ? family : "one");
}

/* Runs the engine until the bomb has struck, as far as the scene goes; only one step if that would take long. */
static bool draw_first_frame(const Scene *scene, const char *path, Error *error) {
    const double most_states = 1e7, bodies = scene->body_count + 1;
    const double frames = scene->bomb.present ? scene->bomb.frame + ceil(way / (double)scene->dt) : 1;
    Scene shown = *scene;
    Panels panels = {0};
    Image *image = NULL;
    Renderer *renderer = NULL;
    RenderOptions render = render_defaults(NULL);
    render.look.approach = true;
    render.width = WIDTH;
    render.height = HEIGHT;
    if (frames < shown.frames) shown.frames = (int)frames;
    if (shown.frames * bodies > most_states) shown.frames = 1;
    const bool ok = panels_add_run(&panels, &shown, "engine", path, error) &&
                    (renderer = renderer_create((const Trajectory *const *)panels.runs, 1, &render, error)) != NULL &&
                    (image = image_create(WIDTH, HEIGHT, error)) != NULL && renderer_draw(renderer, 0, image, error) &&
                    image_write_png(image, path, NULL, 0, error);
    image_destroy(image);
    renderer_destroy(renderer);
    panels_free(&panels);
    return ok;
}

static void put_bomb(JsonWriter *json, const Scene *scene, const LaunchMisses *misses) {
    const SceneBomb *bomb = &scene->bomb;
    const BodyDef body = scene_bomb_body(scene);
    const struct {
        const char *name;
        const SceneSpan *span;
    } family[] = {{"x", &bomb->x}, {"rotation", &bomb->rotation}, {"spin", &bomb->spin}, {"mass", &bomb->mass}};
    json_begin_object(json, "bomb", JSON_LINES);
    json_put_int(json, "frame", bomb->frame);
    json_put_number(json, "mass", (double)body.mass);
    json_output_pair(json, "position", (double)body.position.x, (double)body.position.y);
    json_output_pair(json, "velocity", (double)body.velocity.x, (double)body.velocity.y);
    json_begin_object(json, "launches", JSON_ONE_LINE);
    for (size_t i = 0; i < sizeof family / sizeof *family; i++)
        if (scene_span_varies(family[i].span))
            json_output_pair(json, family[i].name, (double)family[i].span->from, (double)family[i].span->to);
    json_end(json);
    json_begin_object(json, "misses", JSON_ONE_LINE);
    json_put_int(json, "tried", misses->tried);
    json_put_int(json, "missed", misses->missed);
    json_begin_array(json, "x", JSON_ONE_LINE);
    for (int i = 0; i < misses->span_count; i++)
        json_output_pair(json, NULL, misses->spans[i].from, misses->spans[i].to);
    json_end(json);
    json_end(json);
    json_end(json);
}

typedef struct Checked {
    const Scene *scene;
    const LaunchMisses *misses;
    const char *path, *picture;
} Checked;

static void write_result(JsonWriter *json, const void *context) {
    const Checked *checked = context;
    const Scene *scene = checked->scene;
    int fixed = 0;
    for (int i = 0; i < scene->body_count; i++) fixed += scene->bodies[i].fixed;
    json_put_text(json, "scene", checked->path);
    json_put_int(json, "bodies", scene->body_count - fixed);
    json_put_int(json, "static", fixed);
    json_put_int(json, "steps", scene->frames);
    json_put_number(json, "dt", (double)scene->dt);
    json_put_int(json, "iterations", scene->iterations);
    json_put_bool(json, "overlaps_allowed", scene->overlaps_allowed);
    const Fit fit = find_fit(scene);
    if (!json_put_absent(json, "size", check_fits(&fit))) { /* as there is no remark if all fits */
        json_begin_object(json, "size", JSON_ONE_LINE);
        json_put_number(json, "smallest_side", fit.side);
        json_put_number(json, "slop", fit.slop);
        json_put_number(json, "step", fit.step);
        json_end(json);
    }
    if (!json_put_absent(json, "rounding", check_rounding(&fit))) {
        json_begin_object(json, "rounding", JSON_ONE_LINE);
        json_put_number(json, "from_0", fit.far);
        json_put_number(json, "apart", fit.apart);
        json_put_number(json, "moved", fit.moved);
        json_end(json);
    }
    if (!json_put_absent(json, "bomb", !scene->bomb.present)) put_bomb(json, scene, checked->misses);
    json_begin_array(json, "parameters", JSON_LINES);
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "name", parameter->name);
        json_put_number(json, "value", parameter->value);
        json_put_number(json, "from", parameter->from);
        json_put_number(json, "to", parameter->to);
        json_put_text(json, "unit", parameter->unit);
        json_end(json);
    }
    json_end(json);
    json_begin_object(json, "networks", JSON_LINES);
    for (int i = 0; i < scene->network_count; i++)
        json_put_text(json, scene->networks[i].method, scene->networks[i].path);
    json_end(json);
    json_put_text(json, "picture", checked->picture);
}

static bool check_scene(const Scene *scene, const Options *options, Error *error) {
    const bool to_output = options->output != NULL && strcmp(options->output, "-") == 0;
    FILE *out = to_output && note_level() > NOTES_QUIET ? stderr : stdout;
    char standard[SCENE_NAME_SIZE + 32];
    snprintf(standard, sizeof standard, "%s-first-frame.png", scene->name);
    file_name_clean(standard);
    LaunchMisses misses = {0};
    if (!scene_check_launches(scene, error) || !scene_check_networks(scene, error) ||
        !scene_check_ends(options->scene, scene, error) ||
        (scene->bomb.present && !launches_find_misses(scene, &misses, error)))
        return false;
    if (!options->json) {
        fprintf(out, "%s is valid\n", options->scene);
        print_bodies(out, scene);
        print_bomb(out, scene);
        if (scene->bomb.present) print_misses(out, scene, &misses);
        for (int i = 0; i < scene->parameter_count; i++) {
            const SceneParameter *parameter = &scene->parameters[i];
            fprintf(out, "    parameter %s: %.9g, from %.9g to %.9g%s%s\n", parameter->name, parameter->value,
                    parameter->from, parameter->to, parameter->unit[0] != '\0' ? " " : "", parameter->unit);
        }
        for (int i = 0; i < scene->network_count; i++)
            fprintf(out, "    network of %s: %s\n", scene->networks[i].method, scene->networks[i].path);
        print_fit(out, scene);
        fflush(out);
    }
    const char *picture = to_output ? "/dev/stdout" : options->output != NULL ? options->output : standard;
    if (!draw_first_frame(scene, picture, error)) return false;
    if (options->json)
        return json_output("twinbox check 1", write_result, &(Checked){scene, &misses, options->scene, picture}, error);
    if (to_output) return true;
    fprintf(out, "first frame -> %s\n", picture);
    next_film(options->scene);
    return true;
}

/* twinbox check RUN.npz */

enum { LIMITS = 3, FAILURE_SIZE = 160 };

typedef struct CheckedRun {
    const Options *options;
    JudgedRun judged;
    int failed;
    char failures[1 + LIMITS][FAILURE_SIZE]; /* another verdict than is wanted, and what is beyond a limit */
} CheckedRun;

/* Notes failures. False with error set if the run does not tell what a limit is for. */
static bool check_limits(CheckedRun *checked, const Trajectory *run, Error *error) {
    const Options *options = checked->options;
    const VerdictReading *reading = &checked->judged.verdict.reading;
    const Verdict verdict = reading->verdict;
    const char *wanted = verdicts[options->verdict];
    if (!isnan(options->max_drift) && isnan(reading->drift))
        return error_input(error, options->scene, "lasts %.3g s: --max-drift needs a run of more than %.3g s",
                           (run->frames - 1) * (double)run->dt,
                           VERDICT_DRIFT_UNITS * checked->judged.verdict.watch.unit);
    if (!isnan(options->max_gain) && isnan(reading->excess))
        return error_input(error, options->scene, "has no masses, and bodies are struck: --max-gain needs --scene");
    const bool right = options->verdict == 0          ? true
                       : strcmp(wanted, "sound") == 0 ? verdict_sound(verdict)
                       : strcmp(wanted, "holds") == 0 ? verdict_holds(verdict)
                                                      : strcmp(wanted, verdict_name(verdict)) == 0;
    if (!right)
        snprintf(checked->failures[checked->failed++], FAILURE_SIZE, "verdict %s, not %s", verdict_name(verdict),
                 wanted);
    const struct {
        const char *what, *unit;
        double value, most; /* NaN: no limit */
    } limits[LIMITS] = {{"overlap", "m", reading->deepest, options->max_overlap},
                        {"drift", "m", reading->drift, options->max_drift},
                        {"energy gained", "J", reading->excess, options->max_gain}};
    for (int i = 0; i < LIMITS; i++)
        if (limits[i].value > limits[i].most)
            snprintf(checked->failures[checked->failed++], FAILURE_SIZE, "%s %.4g %s, more than %.4g %s",
                     limits[i].what, limits[i].value, limits[i].unit, limits[i].most, limits[i].unit);
    return true;
}

static void write_checked(JsonWriter *json, const void *context) {
    const CheckedRun *checked = context;
    json_put_text(json, "run", checked->options->scene);
    json_put_bool(json, "passed", checked->failed == 0);
    json_begin_array(json, "failures", JSON_LINES);
    for (int i = 0; i < checked->failed; i++) json_put_text(json, NULL, checked->failures[i]);
    json_end(json);
    simulate_verdict_put(&checked->judged.verdict, json, "verdict");
}

/* Prints the verdict and figures. False also, without an error, if the run has failures. */
static bool check_run(const Options *options, Error *error) {
    if (options->output != NULL) return error_input(error, "--output", "applies to scenes only");
    Trajectory *run = trajectory_read(options->scene, error);
    if (run == NULL) return false;
    CheckedRun checked = {.options = options};
    bool ok = judged_run_find(&checked.judged, run, &options->judge, error) && check_limits(&checked, run, error);
    if (ok && options->json) {
        ok = json_output("twinbox check run 1", write_checked, &checked, error);
    } else if (ok) {
        printf("%s by %s: %d steps of %g s, %d bodies (%s)\n", run->scene, run->method, run->frames - 1,
               (double)run->dt, run->bodies, options->scene);
        judged_run_print(&checked.judged, &options->judge);
        for (int i = 0; i < checked.failed; i++) printf("failed: %s\n", checked.failures[i]);
    }
    judged_run_free(&checked.judged);
    trajectory_destroy(run);
    return ok && checked.failed == 0;
}

bool command_check(int argc, char **argv, Error *error) {
    Options options = {.max_overlap = NAN, .max_drift = NAN, .max_gain = NAN};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const char *output = options.output;
    const bool to_output = output != NULL && path_is_standard(output);
    if (file_name_ends_with(options.scene, ".npz")) return check_run(&options, error);
    if (file_name_ends_with(options.scene, ".npy"))
        return error_input(error, options.scene,
                           "is one array of NumPy; a run is a .npz, of at least position, angle, size and dt");
    if (options.verdict > 0 || !isnan(options.max_overlap) || !isnan(options.max_drift) || !isnan(options.max_gain) ||
        options.judge.scene != NULL || options.judge.set.count > 0 || options.judge.skin > 0)
        return error_input(error, options.scene,
                           "is a scene; --scene, --set, --skin, --verdict and limits apply to runs");
    const char *ending = output != NULL ? strrchr(output, '.') : NULL;
    if (output != NULL && !to_output && (ending == NULL || strcmp(ending, ".png") != 0))
        return error_input(error, output, "the name of the picture must end in .png");
    if (options.json && to_output)
        return error_input(error, "--json", "cannot be combined with a picture on standard output");
    if (note_level() == NOTES_QUIET && !options.json) results_keep();
    Scene *scene = scene_read(options.scene, error);
    const bool ok = scene != NULL && check_scene(scene, &options, error);
    scene_destroy(scene);
    return ok;
}
