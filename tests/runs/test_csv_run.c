/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs as CSV: what is written is read back bit by bit; what a file does not state is assumed and noted; what cannot be
   a run is refused with its line. */
#include "owned.h"

#include "example.h"
#include "runs/compare_runs.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"

static const CsvRunOptions defaults = {.name = "file"};
static CsvRunNotes notes;

/* Two bodies in two frames. */
#define HEAD "# dt: 1/60\n# size: 0,20,1\n# size: 1,1,2\nframe,body,x,y,angle\n"
#define ROWS "0,0,0,-0.5,0\n0,1,0,3,0\n1,0,0,-0.5,0\n1,1,0,2,0.5\n"

static Trajectory *read_text(const char *text, const CsvRunOptions *options, Error *error) {
    return csv_run_read(write_bytes(temporary_path("run.csv"), text, strlen(text)), options, &notes, error);
}

static Trajectory *read_ok(const char *text, const CsvRunOptions *options) {
    Error error = {0};
    Trajectory *run = read_text(text, options, &error);
    assert_ok(run != NULL, error);
    return run;
}

static bool has_note(const char *text) {
    for (int i = 0; i < notes.count; i++)
        if (strstr(notes.lines[i], text) != NULL) return true;
    return false;
}

TEST(a_small_file_is_read) {
    OWN(Trajectory) *run = read_ok(HEAD ROWS, &defaults);
    assert_true(run->frames == 2 && run->bodies == 2 && run->bomb == -1 && run->dt == 1.0F / 60);
    assert_true(run->no_velocities && run->no_contacts && run->scene_hash == 0);
    assert_true(run->size[0].x == 20 && run->size[1].y == 2);
    assert_true(run->position[3].y == 2 && run->angle[3] == 0.5F);
    assert_memory_equal(run->fixed, ((const uint8_t[]){1, 0}), 2);
    assert_string_equal(run->scene, "file");
    assert_true(has_note("1 static: 0 never moves") && has_note("velocities are unknown"));
    assert_true(has_note("the scene is called 'file'") && has_note("units are m, s and rad; y points up"));
}

/* Quotes, blank last lines, and numbers as determinism logs have them: the bits of a float32, in hexadecimal. */
TEST(quotes_and_bits_are_read) {
    OWN(Trajectory) *run = read_ok("# size: 0,1,1\n\"frame\", \"body\" ,\"x\",y,\"an\"\"gle\",angle,time\n"
                                   "0,0,\"0x1.000002p-1\",-0X1P-3,,0.25,0x0p0\n1,0,0x1.000002p-1,1,,0.25,0x1p-1\n\n \n",
                                   &defaults);
    assert_true(run->frames == 2 && run->dt == 0.5F && run->position[0].y == -0.125F);
    assert_true(run->position[0].x == nextafterf(0.5F, 1) && run->exact != NULL);
}

/* The float64 nearest to each text, as strtod() finds it: of any bits, of any number of digits, and between two. */
TEST(numbers_are_the_nearest_float64) {
    enum { COUNT = 20000 };
    static const char *const forms[] = {"%.17g", "%.16f", "%.9g", "%.19g", "%a", "%.1f", "%.12e"};
    static const char *const odd[] = {
        "-0",     "9007199254740993",     "9007199254740992.5",    "0.1000000000000000055",
        "4.35",   "9999999999999999999",  "0.0000000000000000001", "1e300",
        "5e-324", "00000000000000000001", "0x1.00000000000008p0",  "0X2.80000000000001P-1074"};
    const char *path = temporary_path("numbers.csv");
    FILE *file = fopen(path, "w");
    double numbers[COUNT];
    uint64_t bits = 1;
    assert_non_null(file);
    fprintf(file, "frame,body,x,y,angle\n");
    for (int i = 0; i < COUNT; i++) {
        char text[400];
        bits = bits * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const double number = ldexp((double)(int64_t)bits, -60 - (int)(bits >> 58));
        snprintf(text, sizeof text, forms[i % 7], number); // NOLINT(clang-diagnostic-format-nonliteral)
        if (i < (int)(sizeof odd / sizeof *odd)) strcpy(text, odd[i]);
        numbers[i] = strtod(text, NULL);
        fprintf(file, "%d,0,%s,0,0\n", i, text);
    }
    fclose(file);
    OWN(Trajectory) *run = csv_trace_read(path, &error);
    assert_ok(run != NULL, error);
    assert_memory_equal(&(double){trajectory_number(run, 0, 0)}, &(double){-0.0}, sizeof(double));
    for (int i = 0; i < COUNT; i++) {
        const double read = trajectory_number(run, (size_t)i, 0);
        if (memcmp(&read, &numbers[i], sizeof read) != 0) fail_msg("row %d: %.17g, not %.17g", i, read, numbers[i]);
    }
}

/* Two runs of unstated bodies: one rests in one of them. That is a difference, not another world. */
TEST(a_body_that_rests_in_one_run_is_not_static) {
    TrajectoryDifference difference;
    const char *path = temporary_path("rests.npz");
    OWN(Trajectory) *moves = read_ok(HEAD ROWS, &defaults),
                    *made = read_ok(HEAD "0,0,0,-0.5,0\n0,1,0,3,0\n1,0,0,-0.5,0\n1,1,0,3,0\n", &defaults);
    assert_ok(trajectory_write(made, path, &error), error);
    OWN(Trajectory) *rests = trajectory_read(path, &error);
    assert_ok(rests != NULL, error);
    assert_true(rests->fixed[1] && !moves->fixed[1]);
    trajectory_compare(rests, moves, &difference);
    assert_true(!difference.equal && difference.frame == 1 && difference.body == 1 && difference.what[0] == '\0');
    assert_near(difference.rollout_mse, 1.0 / 4, 1e-12); /* 1 m, of one body in one of two frames */
}

TEST(a_given_step_may_contradict_times) {
    OWN(Trajectory) *run = read_ok("# size: 0,1,1\ntime,frame,body,x,y,angle\n0,0,0,0,0,0\n0.5,1,0,0,0,0\n",
                                   &(CsvRunOptions){.name = "file", .dt = 0.25F});
    assert_true(run->dt == 0.25F && has_note("dt is 0.25 s, as given; the times of the file rise by 0.5 s"));
}

/* Line ends of Windows, a byte order mark, blanks, another order of columns and rows, no last line end. */
TEST(what_other_programs_write_is_read) {
    OWN(Trajectory) *run = read_ok("\xef\xbb\xbf# size: 0,20,1\r\n#size:1, 1, 2\r\n# made by hand\r\n"
                                   "time,angle, y ,x,body,frame,mass\r\n1.5,0.5,2,0,1,8,3\r\n1, 0, 3, 0, 1, 7, 3\r\n"
                                   "1,0,-0.5,0,0,7,3\r\n1.5,0,-0.5,0,0,8,3",
                                   &defaults);
    assert_true(run->frames == 2 && run->dt == 0.5F && run->position[3].y == 2 && run->angle[3] == 0.5F);
    assert_true(has_note("frame 7 of the file becomes frame 0") && has_note("unknown columns are left out: mass"));
    assert_true(has_note("dt is 1/2 s, from the column time"));
}

TEST(times_of_few_digits_give_the_step) {
    char text[8192] = "# size: 5,1,1\ntime,frame,body,x,y,angle\n";
    for (int i = 0; i <= 100; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%.5f,%d,5,%d,0,0\n", 2 + i / 60.0, i, i);
    }
    OWN(Trajectory) *run = read_ok(text, &defaults);
    assert_true(run->dt == (float)(1.0 / 60));
    assert_true(has_note("bodies 5 to 5 of the file become bodies 0 to 0") && has_note("no body is static"));
}

TEST(angles_may_be_in_degrees) {
    const CsvRunOptions degrees = {.name = "file", .degrees = true, .dt = 0.5F};
    OWN(Trajectory) *run =
        read_ok("# size: 0,1,1\nframe,body,x,y,angle,vx,vy,omega\n0,0,0,0,180,1,2,90\n1,0,0,0,-90,1,2,90\n", &degrees);
    assert_near(run->angle[0], 3.14159265F, 0);
    assert_near(run->angle[1], -1.57079633F, 0);
    assert_near(run->angular_velocity[1], 1.57079633F, 0);
    assert_true(run->velocity[1].y == 2 && run->dt == 0.5F && !run->no_velocities);
}

TEST(sizes_may_be_in_a_file) {
    const char *sizes = temporary_path("sizes.csv");
    const char text[] = "height,body,width,static\n2,1,1,0\n1,0,20,1\n";
    const CsvRunOptions options = {.name = "file", .sizes = sizes, .dt = 1};
    write_bytes(sizes, text, strlen(text));
    OWN(Trajectory) *run = read_ok("frame,body,x,y,angle\n" ROWS, &options);
    assert_true(run->size[0].x == 20 && run->size[1].y == 2);
    assert_memory_equal(run->fixed, ((const uint8_t[]){1, 0}), 2);
}

/* A static body needs one row; one that comes late or leaves early has rows while it is there. */
TEST(rows_may_be_missing_where_that_has_a_meaning) {
    OWN(Trajectory) *run = read_ok("# dt: 1\n# size: 0,20,1\n# size: 1,1,2\n# size: 2,1,1\nframe,body,x,y,angle\n"
                                   "0,0,0,-0.5,0\n0,1,0,3,0\n1,1,0,2,0\n1,2,7,7,0\n2,2,7,6,0\n",
                                   &defaults);
    assert_true(run->fixed[0] && run->position[6].y == -0.5F);
    assert_true(trajectory_has(run, 1, 1) && !trajectory_has(run, 2, 1));
    assert_true(!trajectory_has(run, 0, 2) && trajectory_has(run, 1, 2) && trajectory_has(run, 2, 2));
}

TEST(what_is_written_is_read_back) {
    const char *path = temporary_path("example.csv");
    OWN(Trajectory) *t = example_trajectory();
    t->position[1 * EXAMPLE_BODIES + 1].x = nextafterf(1000, 2000);
    t->iterations = 12;
    assert_ok(csv_run_write(t, path, &error), error);
    OWN(Trajectory) *run = csv_run_read(path, &defaults, &notes, &error);
    assert_ok(run != NULL, error);
    TrajectoryDifference difference;
    trajectory_compare(t, run, &difference);
    assert_true(difference.equal && !difference.poses_only && run->no_contacts);
    assert_string_equal(run->scene, t->scene);
    assert_string_equal(run->method, t->method);
    assert_int_equal(run->iterations, 12);
    assert_true(run->scene_hash == t->scene_hash && run->bomb == t->bomb && run->dt == t->dt);
    assert_memory_equal(&run->camera_center, &t->camera_center, sizeof(Vec2));
    assert_memory_equal(&run->camera_size, &t->camera_size, sizeof(Vec2));
    assert_memory_equal(run->fixed, t->fixed, EXAMPLE_BODIES);
    assert_int_equal(notes.count, 1); /* the units */
}

static const struct {
    const char *text, *reason;
} refused[] = {
    {"", "run.csv: error: the file is empty"},
    {"# size: 0,1,1\n", "run.csv:2: error: there is no header"},
    {"# dt: 1/60\n", "error: the sizes of the bodies are missing: give --sizes"},
    {HEAD, "run.csv: error: has no rows"},
    {HEAD "0,0,0,-0.5,0\n0,1,0,3,0\n1,0,0,-0.5,0\n1,1,0,nan,0\n2,0,0,-0.5,0\n2,1,0,3,0\n",
     "run.csv:10: error: body 1 is finite in frame 2, but not in frame 1"},
    {HEAD "0,0,0,-0.5,0\n0,1,0,1e39,0\n", "run.csv: error: body 1: a number of its first frame is NaN or infinite"},
    {HEAD "0,0,0,-0.5,0\n0,1,0,nano,0\n", "run.csv:6:7: error: y: 'nano' is not a finite number"},
    {HEAD "0,0,0,-0.5,0\n0,1,0,0x.p1,0\n", "run.csv:6:7: error: y: '0x.p1' is not a finite number"},
    {HEAD "0,0,0,-0.5\n", "run.csv:5: error: 4 fields, but the header has 5"},
    {HEAD "\n" ROWS, "run.csv:5: error: the line is empty"},
    {HEAD "-1,0,0,0,0\n", "run.csv:5:1: error: frame: '-1' is not a whole number from 0"},
    {HEAD ROWS "2000000000,0,0,0,0\n", "run.csv:9: error: frame 2000000000 cannot follow from frame 0"},
    {HEAD ROWS "2,2000000000,0,0,0\n", "run.csv:9: error: body 2000000000 has no size"},
    {HEAD "0,0,0,0,0\n", "run.csv: error: body 1 has a size but no row"},
    {HEAD ROWS "1,1,0,2,0.5\n", "run.csv:9: error: body 1 is twice in frame 1: also in line 8"},
    {HEAD ROWS "3,0,0,0,0\n3,1,0,0,0\n", "run.csv:9: error: frame 3 comes here, but frame 2 has no rows"},
    {HEAD "0,0,0,0,0\n0,1,0,0,0\n1,0,0,0,0\n2,0,0,0,0\n2,1,0,0,0\n",
     "run.csv:9: error: body 1 is in frame 0 and in frame 2, but not in frame 1"},
    {"# size: 0,1,1\nframe,body,x,y,angle\n0,0,0,0,0\n", "error: the time step is missing: give --dt S, a line"},
    {"# size: 0,1,1\ntime,frame,body,x,y,angle\n0,0,0,0,0,0\n", "a column time with more than one frame"},
    {"# size: 0,1,1\ntime,frame,body,x,y,angle\n0,0,0,0,0,0\n0,1,0,0,0,0\n", "the times do not rise"},
    {"# size: 0,1,1\ntime,frame,body,x,y,angle\n0,0,0,0,0,0\n0.1,1,0,0,0,0\n1,2,0,0,0,0\n",
     "run.csv:4: error: time 0.1 s does not fit to equal steps of 0.5 s: frame 1 is due at 0.5 s"},
    {"# dt: 0\n" HEAD, "run.csv:1: error: dt: expected a time in seconds"},
    {"# size: 0,0,1\n" HEAD, "run.csv:1: error: size: expected BODY,WIDTH,HEIGHT"},
    {"# sizes: 0,1,1\n" HEAD, "run.csv:1: error: '# sizes:': did you mean '# size:'?"},
    {"# size: 1,5,5\n" HEAD ROWS, "run.csv: error: body 1 has two sizes"},
    {"# bomb: 7\n" HEAD ROWS, "run.csv: error: the bomb is body 7, which has no size"},
    {"# camera: 0,0,-1,1\n" HEAD ROWS, "the camera's window must be finite and not negative"},
    {"# size: 0,1,1\nframe;body;x;y;angle\n",
     "run.csv:2: error: the fields are separated by semicolons; expected commas"},
    {"# size: 0,1,1\nframe,body,x,\"y\n", "run.csv:2:14: error: this quote is not closed"},
    {"# dt: 1/120\n# size: 0,1,1\ntime,frame,body,x,y,angle\n0,0,0,0,0,0\n0.0167,1,0,0,0,0\n",
     "run.csv:5: error: time 0.0167 s does not fit to equal steps of 0.00833333 s: frame 1 is due at 0.00833333 s"},
    {"# dt: 1\n# size: 0,1,1,static\n# size: "
     "1,1,1\nframe,body,x,y,angle\n0,0,0,0,0\n0,1,0,0,0\n1,0,0,0.1,0\n1,1,0,0,0\n",
     "run.csv:7: error: body 0 is static, but moves"},
    {"\x89HDF\r\n\x1a\n", "run.csv: error: is HDF5; only CSV can be imported"},
    {"PK\3\4", "run.csv: error: is a zip archive"},
    {"# size: 0,1,1\nframe,body,x,y,theta\n", "run.csv:2: error: the column 'angle' is missing"},
    {"# size: 0,1,1\nframes,body,x,y,angle\n", "run.csv:2:1: error: unknown column 'frames': did you mean 'frame'?"},
    {"# size: 0,1,1\nframe,body,x,y,angle,vx\n", "run.csv:2: error: give all of vx, vy and omega, or none"},
};

TEST(what_is_no_run_is_refused_with_its_line) {
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        error = (Error){0};
        Trajectory *run = read_text(refused[i].text, &defaults, &error);
        if (run != NULL) fail_msg("taken: %s", refused[i].text);
        assert_error(error, ERROR_INPUT, refused[i].reason);
    }
}

RUN_TESTS(NULL, NULL)
