/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Videos have all frames or do not exist. */
#include "made.h"

#include "base/machine.h"
#include "base/process.h"
#include "files.h"
#include "mesa.h"
#include "pictures/render.h"
#include "runs.h"
#include "runs/trajectory.h"
#include "sanitized.h"

#include <signal.h>
#include <sys/stat.h>

enum { FRAMES = 9, WIDTH = 96, HEIGHT = 64 };

static char folder[256]; /* of the frames */
static PictureHashes *hashes;

FIXTURE(make) {
    RenderResult result;
    snprintf(folder, sizeof folder, "%s", temporary_path("frames"));
    OWN(Trajectory) *run = run_make("engine", FRAMES);
    RenderOptions options = {.width = WIDTH, .height = HEIGHT, .last = -1, .jobs = 1, .directory = folder};
    assert_ok(render_sequence((const Trajectory *[]){run}, 1, &options, &result, NULL, &error), error);
    hashes = result.hashes;
}

FIXTURE(destroy) { free(hashes); }

static VideoOptions options_for(const char *path) {
    return (VideoOptions){folder, 0, FRAMES - 1, 60, hashes, path, false};
}

static void run_words(const char *const *argv, char *text, size_t size) {
    Error error = {0};
    Process process;
    assert_ok(process_start(&process, argv, &error), error);
    assert_ok(process_finish(&process, text, size, &error), error);
}

/* What ffprobe says of a video, of each of its streams or packets. */
static void ask(const char *path, const char *entries, char *text, size_t size) {
    char name[300];
    snprintf(name, sizeof name, "file:%s", path);
    run_words((const char *[]){"ffprobe", "-v", "error", "-count_frames", "-show_entries", entries, "-of", "csv=p=0",
                               name, NULL},
              text, size);
}

/* Frames, rate and size according to a decoder. */
static void probe(const char *path, int *frames, double *rate, int *width, int *height) {
    char text[256];
    int over, under;
    ask(path, "stream=width,height,avg_frame_rate,nb_read_frames", text, sizeof text);
    if (sscanf(text, "%d,%d,%d/%d,%d", width, height, &over, &under, frames) != 5) fail_msg("%s", text);
    *rate = (double)over / under;
}

/* The most frames from one key frame to the next, or to the end. */
static int longest_seek(const char *path) {
    char text[4096];
    int longest = 0, since = 0;
    ask(path, "packet=flags", text, sizeof text);
    assert_int_equal(text[0], 'K');
    for (const char *line = text; *line != '\0'; line += strcspn(line, "\n"), line += *line == '\n') {
        since = *line == 'K' ? 0 : since + 1;
        if (since > longest) longest = since;
    }
    return longest + 1;
}

static void assert_nothing_left(const char *directory) {
    assert_int_equal(count_files(directory, ".tmp"), 0);
    assert_int_equal(count_files(directory, ".part"), 0);
}

static double light_of(const uint8_t rgb[3]) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

/* The root of the mean square, in levels of 255, by which the light of a film's frames differs from the pictures'.
   Colours have half the pixels. */
static double film_error(const VideoOptions *options) {
    enum { PIXELS = WIDTH * HEIGHT };
    char from[300], text[256], decoded[300];
    static uint8_t rgb[3 * PIXELS];
    double squares = 0;
    Error error = {0};
    snprintf(from, sizeof from, "file:%s", options->path);
    snprintf(decoded, sizeof decoded, "file:%s", temporary_path("decoded"));
    run_words((const char *[]){"ffmpeg", "-y", "-v", "error", "-i", from, "-f", "rawvideo", "-pix_fmt", "rgb24",
                               decoded, NULL},
              text, sizeof text);
    FILE *file = fopen(decoded + strlen("file:"), "rb");
    assert_non_null(file);
    for (int frame = 0; frame < FRAMES; frame++) {
        OWN(Image) *image = image_read_png(frame_path(folder, frame), &error);
        assert_ok(image != NULL, error);
        assert_int_equal(fread(rgb, 3, PIXELS, file), PIXELS);
        for (int i = 0; i < PIXELS; i++) squares += pow(light_of(rgb + 3 * i) - light_of(image->pixels + 4 * i), 2);
    }
    fclose(file);
    return sqrt(squares / ((double)PIXELS * FRAMES));
}

/* All frames, and the same bytes again. Of films, players seek from one key frame to the next: at 2.5 Hz, nine frames
   are
   3.6 s; those that know no tags guess the matrix of colours from the size; and their light is as near to that of the
   pictures as 3.0 levels in .mp4 and 2.4 in .webm (with -crf 40 and 46 instead of 16 and 24 they are 20 and 5.8). */
TEST(each_form_has_all_its_frames_as_they_are) {
    static const char *const names[] = {"a.mp4", "a.webm", "a.gif"}, *const other[] = {"b.mp4", "b.webm", "b.gif"};
    for (int i = 0; i < 3; i++) {
        const bool film = i < 2;
        int frames, width, height;
        double rate;
        VideoOptions options = options_for(temporary_path(names[i])), again = options_for(temporary_path(other[i]));
        options.frame_rate = again.frame_rate = film ? 2.5 : 60;
        assert_ok(video_encode(&options, NULL, &error), error);
        assert_ok(video_encode(&again, NULL, &error), error);
        assert_same_file(options.path, again.path);
        probe(options.path, &frames, &rate, &width, &height);
        assert_int_equal(frames, film ? FRAMES : (FRAMES + 2) / 3); /* a GIF has 0.05 s a frame */
        assert_true(width == WIDTH && height == HEIGHT);
        assert_near(rate, film ? 2.5 : 20, 1e-9);
        if (!film) continue;
        const int most = longest_seek(options.path);
        if (most > 2) fail_msg("%s: %d frames of 0.4 s without a key frame", names[i], most);
        const double found = film_error(&options);
        if (!(found < 5)) fail_msg("%s: %g levels", names[i], found);
        char text[256];
        ask(options.path, "stream=color_space,color_transfer,color_primaries", text, sizeof text);
        assert_string_equal(text, "bt709,bt709,bt709\n");
    }
    assert_nothing_left(temporary_folder);
}

/* A GIF of a chosen rate has up to 50 frames per second, of the run's rate up to 25. */
TEST(gifs_keep_a_chosen_rate) {
    static const struct {
        double rate;
        bool chosen;
        double shown;
    } cases[] = {{50, true, 50}, {50, false, 25}, {25, false, 25}, {100, true, 50}, {20, false, 20}, {75, false, 25}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i += (size_t)sampled(3)) {
        int frames, width, height;
        double rate;
        VideoOptions options = options_for(temporary_path("rate.gif"));
        options.frame_rate = cases[i].rate, options.rate_is_chosen = cases[i].chosen;
        assert_ok(video_encode(&options, NULL, &error), error);
        probe(options.path, &frames, &rate, &width, &height);
        const int stride = (int)(cases[i].rate / cases[i].shown);
        assert_int_equal(frames, (FRAMES + stride - 1) / stride);
        assert_near(rate, cases[i].shown, 1e-9);
    }
}

/* Large pictures are scaled to 800 pixels, in their shape; small ones keep their size. */
TEST(gifs_are_small) {
    static const int sizes[][4] = {
        {1600, 90, 800, 45}, {90, 1600, 45, 800}, {801, 100, 800, 100}, {800, 60, 800, 60}, {96, 64, 96, 64}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i += (size_t)sampled(2)) {
        int frames, width, height;
        double rate;
        const char *directory = temporary_path("large");
        OWN(Image) *image = image_sized(sizes[i][0], sizes[i][1]);
        assert_ok(file_make_directory(directory, &error), error);
        for (size_t k = 0; k < 4 * (size_t)image->width * (size_t)image->height; k++)
            image->pixels[k] = (uint8_t)(k % 251);
        assert_ok(image_write_png(image, frame_path(directory, 0), NULL, 0, &error), error);
        VideoOptions options = {.directory = directory, .frame_rate = 60, .path = temporary_path("small.gif")};
        assert_ok(video_encode(&options, NULL, &error), error);
        probe(options.path, &frames, &rate, &width, &height);
        assert_true(frames == 1 && width == sizes[i][2] && height == sizes[i][3]);
    }
}

/* No name is taken for a pattern, an option or a URL. */
TEST(any_file_name_works) {
    static const char *const names[] = {"-y.mp4", "a%03d.gif", "http:x.mp4", "b c'\"$.mp4"};
    char before[512];
    const char *directory = temporary_path("names");
    assert_ok(file_make_directory(directory, &error), error);
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(directory), 0);
    for (int i = 0; i < 4; i++) {
        VideoOptions options = options_for(names[i]);
        assert_ok(video_encode(&options, NULL, &error), error);
        assert_int_equal(access(names[i], F_OK), 0);
    }
    assert_int_equal(chdir(before), 0);
    assert_int_equal(count_files(directory, ""), 4);
}

TEST(a_damaged_frame_makes_no_video) {
    size_t size, other_size;
    const char *path = temporary_path("kept.mp4"), *frame = frame_path(folder, 4);
    FREED char *data = read_whole(frame, &size), *other = read_whole(frame_path(folder, 8), &other_size);
    OWN(Image) *small = image_sized(8, 8);
    for (int i = 0; i < 4; i++) {
        static const char *const texts[] = {"cannot open", "unexpected end of file", "differ from those drawn",
                                            "frame 4 is 8x8, but the first is 96x64"};
        VideoOptions options = options_for(path);
        write_bytes(path, "old", 3);
        error = (Error){0};
        if (i == 0) assert_int_equal(unlink(frame), 0);
        if (i == 1) write_bytes(frame, data, size - 20);
        if (i == 2) write_bytes(frame, other, other_size);
        if (i == 3) assert_ok(image_write_png(small, frame, NULL, 0, &error), error);
        assert_refused(video_encode(&options, NULL, &error), texts[i]);
        size_t old_size;
        char *old = read_whole(path, &old_size);
        assert_string_equal(old, "old");
        free(old);
        assert_nothing_left(temporary_folder);
    }
    write_bytes(frame, data, size);
}

/* Puts a program of this name first in PATH. */
static void pretend(const char *name, const char *script) {
    char path[512];
    const char *directory = temporary_path("bin");
    Error error = {0};
    assert_ok(file_make_directory(directory, &error), error);
    snprintf(path, sizeof path, "%s/%s", directory, name);
    write_bytes(path, script, strlen(script));
    assert_int_equal(chmod(path, 0700), 0);
    snprintf(path, sizeof path, "%s:/usr/bin:/bin", directory);
    assert_int_equal(setenv("PATH", path, 1), 0);
}

TEST(a_video_that_lacks_a_frame_is_removed) {
    static const struct {
        const char *ffmpeg, *text;
    } cases[] = {
        {"#!/bin/sh\nfor last; do :; done\n"
         "exec /usr/bin/ffmpeg -v error -y -f lavfi -i testsrc=s=96x64:r=60 -frames:v 8 -f mp4 \"$last\" </dev/null\n",
         ""},
        {"#!/bin/sh\ncat >/dev/null\necho broken >&2\nexit 5\n", "failed (status 5)\nbroken"},
        {"#!/bin/sh\nkill -9 $$\n", "failed (signal 9)"},
        {"#!/bin/sh\ncat >/dev/null\n", "ffprobe: error: failed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        error = (Error){0};
        VideoOptions options = options_for(temporary_path("lacking.mp4"));
        pretend("ffmpeg", cases[i].ffmpeg);
        assert_false(video_encode(&options, NULL, &error));
        assert_error(error, ERROR_SYSTEM, cases[i].text);
        assert_int_equal(access(options.path, F_OK), -1);
        assert_nothing_left(temporary_folder);
    }
    VideoOptions options = options_for(temporary_path("lacking.mp4"));
    pretend("ffmpeg", "#!/bin/sh\ncat >/dev/null\necho File too large >&2\n");
    pretend("ffprobe", "#!/bin/sh\necho 'warning: 7 of 9' >&2\necho nb_read_frames=8\necho 'warning: 9' >&2\n");
    error = (Error){0};
    assert_false(video_encode(&options, NULL, &error));
    assert_error(error, ERROR_SYSTEM, "lacking.mp4: error: the video has 8 frames (expected 9)\nFile too large");
    setenv("PATH", "/usr/bin:/bin", 1);
}

static bool never(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

TEST(a_video_can_be_stopped) {
    VideoOptions options = options_for(temporary_path("stopped.gif"));
    assert_false(video_encode(&options, &(Progress){never, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped");
    assert_int_equal(access(options.path, F_OK), -1);
    assert_nothing_left(temporary_folder);
}

TEST(a_reader_that_has_gone_is_told) {
    int ends[2];
    VideoOptions options = options_for("the pipe");
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(close(ends[0]), 0);
    signal(SIGPIPE, SIG_IGN);
    assert_false(video_write_y4m(&options, ends[1], NULL, &error));
    signal(SIGPIPE, SIG_DFL);
    assert_error(error, ERROR_SYSTEM, "the pipe: error: cannot write: Broken pipe");
    assert_int_equal(close(ends[1]), 0);
}

RUN_TESTS(make, destroy)
