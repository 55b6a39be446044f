/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox solve: takes a contact problem from a file, or from a step of a scene; writes it, and scores methods on
   it. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "engine/engine.h"
#include "methods/criteria.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "runs/problem_file.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

enum { MAX_METHODS = 64, FLOOR_STARTS = 8 };

typedef struct Options {
    const char *input; /* with `frame` a scene, else a file of a contact problem */
    const char *methods[MAX_METHODS];
    int method_count, frame; /* frame 0: not given */
    float bomb_x;            /* m; NaN: not given */
    SceneSettings set;
    const char *run_by, *output;
    const char *impulses; /* path of a table of impulses to score, or NULL */
    bool json;
} Options;

static const Option option_table[] = {
    {"--method", 'm', "NAME[:KEY=VALUE,...]", "Method to score (may be repeated)",
     OPTION_METHOD_TEXTS(Options, methods, method_count)},
    {"--impulses", 0, "FILE.csv",
     "Also score these impulses, in N s over the step: a table with the columns contact (its index in P.npz, from 0), "
     "normal and tangent; contacts that it omits have none",
     OPTION_TEXT(Options, impulses)},
    {OPTION_JSON(Options, json)},
    {.help = "Of a scene:"},
    {"--frame", 0, "N", "Number of the step, from 1: the step that leads to frame N of a run",
     OPTION_INT(Options, frame, 1, SCENE_MAX_FRAMES)},
    {"--bomb-x", 0, "X", "Where the bomb is launched, m (default: the scene's x)",
     OPTION_FLOAT(Options, bomb_x, -SCENE_MAX_POSITION, SCENE_MAX_POSITION)},
    {OPTION_SET(Options, set)},
    {"--run-by", 0, "NAME[:KEY=VALUE,...]", "Method that runs the scene up to this step (default: engine)",
     OPTION_METHOD(Options, run_by)},
    {"--output", 'o', "P.npz", "Write the contact problem; without --method, nothing is solved",
     OPTION_BINARY(Options, output)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE|P.npz",
              .needed = "a scene, or a contact problem (.npz), is needed",
              OPTION_PATH(Options, input)},
    .inputs = {1, 1, "input"},
    .help =
        "Solve the contact problem of one step with each method, or score impulses from elsewhere: the bodies with "
        "their velocities before any impulse, and the contacts. The step is one of a scene (--frame), or was written "
        "by -o before. Methods are scored against the converged solution: RMS error of the bodies' velocities (m/s, "
        "spin weighted by 1/sqrt 6), bodies whose velocity is right (within 0.05 m/s or 5% of the change made by the "
        "contacts), and the residual of the method's impulses: the largest change of a contact's velocity by one more "
        "sweep (m/s; a method without impulses counts as impulses of 0). The floor is the largest error of another "
        "answer that is as right: the reference begins at other impulses, too, those of the methods among them. Errors "
        "below it do not tell methods apart. Then the laws of contact, each 0 where it is "
        "kept: Signorini (largest gap velocity times impulse, J), the friction cone (largest distance of an impulse "
        "from it, N s), dissipation (largest energy that friction failed to take, J); nan: the method has no "
        "impulses. Last, to compare with the method reference: the deepest penetration that the step leads to (m), "
        "and the kinetic energy that contacts add (J; negative: take).\v"
        "Example: twinbox solve stack --frame 41 -m engine:k=10 -m engine:k=100\n"
        "         twinbox solve stack --frame 41 -o impact.npz\n"
        "         twinbox solve impact.npz --method momentum:k=20\n"
        "In Python: problem = numpy.load('impact.npz'); problem['velocity'] has shape (bodies, 2)."};

typedef struct Score {
    SolutionError error;
    double residual; /* m/s */
    ContactCriteria criteria;
} Score;

typedef struct Result {
    const StoredProblem *stored;
    const Method *methods;
    int method_count;
    Reference truth;
    double floor;                  /* m/s; of a problem whose reference converged */
    const char *impulses;          /* path, or NULL */
    Score scores[MAX_METHODS + 1]; /* of the impulses behind the methods */
} Result;

/* Of what a method, or a table of impulses, has made of the problem. Its impulses are one more start for the floor: it
   may have found another right answer. */
static bool score_solution(Result *result, const ContactSolution *solution, Score *score, Error *error) {
    const ContactProblem *problem = &result->stored->problem;
    Reference work = {0};
    bool ok = reference_residual(&work, problem, solution->impulses, &score->residual, error);
    if (ok) score->error = solution_error(problem, solution->velocities, result->truth.velocities);
    if (ok) score->criteria = contact_criteria(problem, solution, true);
    if (ok && reference_converged(&result->truth) && isfinite(score->residual))
        ok = reference_raise_floor(&work, problem, &result->truth, solution->impulses, &result->floor, error);
    reference_free(&work);
    return ok;
}

typedef struct ImpulseRow {
    int contact;
    double normal, tangent; /* N s */
} ImpulseRow;

#define IMPULSE_LARGEST 1e30

static const CsvColumn impulse_columns[] = {
    CSV_MEMBER(ImpulseRow, contact, CSV_INTEGER, .maximum = INT_MAX, .key = true),
    CSV_MEMBER(ImpulseRow, normal, CSV_NUMBER, .minimum = -IMPULSE_LARGEST, .maximum = IMPULSE_LARGEST),
    CSV_MEMBER(ImpulseRow, tangent, CSV_NUMBER, .minimum = -IMPULSE_LARGEST, .maximum = IMPULSE_LARGEST),
};
static const CsvLayout impulse_layout = CSV_LAYOUT("impulses", impulse_columns, ImpulseRow, .max_rows = 1 << 20);

/* The impulses of the table, and the velocities that they make. */
static bool apply_table(const CsvTable *table, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    contact_solution_begin(problem, solution);
    for (int i = 0; i < table->count; i++) {
        const ImpulseRow *row = (const ImpulseRow *)table->rows + i;
        if (row->contact >= problem->contact_count)
            return csv_table_error(table, i, 0, error, "contact: there is no contact %d; the problem has %d",
                                   row->contact, problem->contact_count);
        const ContactImpulse impulse = {(float)row->normal, (float)row->tangent};
        solution->impulses[row->contact] = impulse;
        contact_push(solution->velocities, &problem->contacts[row->contact], problem->bodies, impulse);
    }
    return true;
}

static bool score_all(Result *result, Error *error) {
    const ContactProblem *problem = &result->stored->problem;
    ContactSolution solution = {calloc((size_t)problem->body_count, sizeof *solution.velocities),
                                calloc((size_t)problem->contact_count + 1, sizeof *solution.impulses),
                                0,
                                {0}};
    bool ok = solution.velocities != NULL && solution.impulses != NULL;
    if (!ok) error_memory(error, "solve");
    ok = ok && reference_solve(&result->truth, problem, NULL, error);
    if (ok && reference_converged(&result->truth)) {
        Reference other = {0};
        ok = reference_floor(&other, problem, &result->truth, FLOOR_STARTS, &result->floor, error);
        reference_free(&other);
    }
    for (int i = 0; ok && i < result->method_count; i++) {
        const Scene scene = {.iterations = 10, .accumulate_impulses = true};
        ContactSolver solver;
        if (!(ok = method_create_solver(&result->methods[i], &scene, &solver, error))) break;
        ok = solver.kind->solve(solver.state, problem, &solution, error) &&
             score_solution(result, &solution, &result->scores[i], error);
        solver.kind->destroy(solver.state);
    }
    CsvTable table;
    if (ok && result->impulses != NULL && (ok = csv_table_read(&table, result->impulses, &impulse_layout, error))) {
        ok = apply_table(&table, problem, &solution, error) &&
             score_solution(result, &solution, &result->scores[result->method_count], error);
        csv_table_free(&table);
    }
    free(solution.velocities);
    free(solution.impulses);
    return ok;
}

static int row_count(const Result *result) { return result->method_count + (result->impulses != NULL); }

static const char *row_name(const Result *result, int i) {
    return i < result->method_count ? result->methods[i].text : result->impulses;
}

static void print_result(const Result *result) {
    const StoredProblem *stored = result->stored;
    printf("%s, step %d: %d bodies, %d contacts; reference: residual %.2g m/s after %d factorizations", stored->scene,
           stored->frame, stored->problem.body_count, stored->problem.contact_count, result->truth.residual,
           result->truth.factorizations);
    if (reference_converged(&result->truth))
        printf("; floor %.2g m/s\n", result->floor);
    else
        printf("\nThe reference did not converge (tolerance: %g m/s); nothing is scored against it.\n",
               REFERENCE_TOLERANCE);
    printf("%-40s %12s %12s %12s %12s %10s %14s %14s %10s\n", "method", "error m/s", "right  ", "residual m/s",
           "signorini J", "cone N s", "dissipation J", "penetration m", "energy J");
    for (int i = 0; i < row_count(result); i++) {
        const Score *row = &result->scores[i];
        const ContactCriteria *laws = &row->criteria;
        if (reference_converged(&result->truth))
            printf("%-40s %12.4g %7d/%-4d", row_name(result, i), row->error.rms, row->error.right, row->error.counted);
        else
            printf("%-40s %12s %7s/%-4d", row_name(result, i), "-", "-", row->error.counted);
        printf(" %12.4g %12.4g %10.4g %14.4g %14.4g %10.4g\n", row->residual, laws->signorini, laws->cone,
               laws->dissipation, laws->penetration, laws->energy);
    }
}

static void write_result(JsonWriter *json, const void *context) {
    const Result *result = context;
    json_put_text(json, "scene", result->stored->scene);
    json_put_int(json, "step", result->stored->frame);
    json_put_int(json, "bodies", result->stored->problem.body_count);
    json_put_int(json, "contacts", result->stored->problem.contact_count);
    json_begin_object(json, "reference", JSON_ONE_LINE);
    json_put_number(json, "residual", result->truth.residual);
    json_put_int(json, "factorizations", result->truth.factorizations);
    json_put_bool(json, "converged", reference_converged(&result->truth));
    if (reference_converged(&result->truth)) json_put_number(json, "floor", result->floor);
    json_end(json);
    json_begin_array(json, "methods", JSON_LINES);
    for (int i = 0; i < row_count(result); i++) {
        const Score *row = &result->scores[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, i < result->method_count ? "method" : "impulses", row_name(result, i));
        if (reference_converged(&result->truth)) {
            json_put_number(json, "error", row->error.rms);
            json_put_int(json, "right", row->error.right);
        }
        json_put_int(json, "counted", row->error.counted);
        json_put_number(json, "residual", row->residual);
        json_put_number(json, "signorini", row->criteria.signorini);
        json_put_number(json, "cone", row->criteria.cone);
        json_put_number(json, "dissipation", row->criteria.dissipation);
        json_put_number(json, "penetration", row->criteria.penetration);
        json_put_number(json, "energy", row->criteria.energy);
        json_end(json);
    }
    json_end(json);
}

static bool solve_and_print(const StoredProblem *stored, const Options *options, Error *error) {
    static Method methods[MAX_METHODS];
    Result result = {
        .stored = stored, .methods = methods, .method_count = options->method_count, .impulses = options->impulses};
    bool ok = true;
    for (int i = 0; ok && i < options->method_count; i++) ok = method_parse(&methods[i], options->methods[i], error);
    ok = ok && score_all(&result, error);
    if (ok && options->json)
        ok = json_output("twinbox solve 1", write_result, &result, error);
    else if (ok)
        print_result(&result);
    reference_free(&result.truth);
    return ok;
}

static bool is_scored(const Options *options) { return options->method_count > 0 || options->impulses != NULL; }

typedef struct Recording {
    const Scene *scene;
    const Options *options;
} Recording;

/* Uses the problem of the last step, which lasts as long as the world stands still. */
static bool use_last(void *context, int frame, const World *world, Error *error) {
    const Recording *recording = context;
    const Options *options = recording->options;
    if (frame < options->frame) return true;
    StoredProblem stored = {.frame = frame, .problem = *world_problem(world)};
    snprintf(stored.scene, sizeof stored.scene, "%s", recording->scene->name);
    if (options->output != NULL) {
        if (!problem_write(&stored.problem, stored.scene, frame, options->output, error)) return false;
        if (!options->json)
            printf("%s, step %d: %d bodies, %d contacts -> %s\n", stored.scene, frame, stored.problem.body_count,
                   stored.problem.contact_count, options->output);
    }
    return !is_scored(options) || solve_and_print(&stored, options, error);
}

static bool solve_step(const Options *options, Error *error) {
    Method method;
    Scene *scene = scene_read_with(options->input, options->set.items, options->set.count, error);
    bool ok = scene != NULL;
    if (ok && !isnan(options->bomb_x)) {
        ok = scene->bomb.present || error_input(error, options->input, "the scene has no bomb to launch");
        scene->bomb.x.value = options->bomb_x;
    }
    if (ok) scene->frames = options->frame;
    ok = ok && method_parse(&method, options->run_by != NULL ? options->run_by : "engine", error) &&
         simulate_observed(scene, &method, &(StepObserver){use_last, &(Recording){scene, options}}, error);
    scene_destroy(scene);
    return ok;
}

static bool check_options(const Options *options, Error *error) {
    const bool step = options->frame > 0;
    if (!step && file_name_ends_with(options->input, ".yaml"))
        return error_input(error, options->input, "--frame N is needed: the step of the scene");
    if (file_name_ends_with(options->input, ".hdf5") || file_name_ends_with(options->input, ".h5"))
        return error_input(
            error, options->input,
            "HDF5 is not read: a contact problem is a .npz file, as `twinbox solve SCENE --frame N -o P.npz` "
            "writes it");
    if (!step &&
        (options->output != NULL || options->run_by != NULL || options->set.count > 0 || !isnan(options->bomb_x)))
        return error_input(error, options->input, "-o, --run-by, --set and --bomb-x are for a scene, with --frame N");
    if (step && file_name_ends_with(options->input, ".npz"))
        return error_input(error, options->input, "--frame is for a scene; a contact problem is of one step");
    if (!is_scored(options) && (options->output == NULL || options->json))
        return error_input(error, options->input, "--method NAME or --impulses FILE.csv is needed%s",
                           step ? ", or -o P.npz to write" : "");
    return json_output_check(options->json, error) &&
           (options->output == NULL || output_check_npz(options->output, "contact problem", error));
}

bool command_solve(int argc, char **argv, Error *error) {
    Options options = {.bomb_x = NAN};
    if (!options_parse(&spec, argc, argv, &options, error) || !check_options(&options, error)) return false;
    if (options.frame > 0) return solve_step(&options, error);
    StoredProblem *stored = problem_read(options.input, error);
    const bool ok = stored != NULL && solve_and_print(stored, &options, error);
    problem_destroy(stored);
    return ok;
}
