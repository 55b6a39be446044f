/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of a study stay within bounds: of one page, and of all together. */
#include "made.h"
#include "files.h"

#include "cli/page_set.h"
#include "studies/piece_tables.h"

/* Two boxes that stand still for so many frames. */
static Trajectory *make_run(int frames) {
    Trajectory *run = run_sized(frames, 2);
    strcpy(run->scene, "still");
    strcpy(run->method, "none");
    run->dt = 0.0625f;
    run->no_contacts = true;
    for (int body = 0; body < 2; body++) run->size[body] = vec2(1, 1);
    for (int i = 0; i < 2 * frames; i++) {
        run->position[i] = vec2((float)(i % 2) * 2, 0.5f);
        run->velocity[i] = vec2(0, 0);
        run->angle[i] = run->angular_velocity[i] = 0;
    }
    return run;
}

static PageFile write_run(const PageSet *set, const char *name, int frames, const PlayerOptions *options) {
    Error error = {0};
    PageFile file;
    OWN(Trajectory) *run = make_run(frames);
    assert_ok(page_set_write(set, name, (const Trajectory *const[]){run}, 1, options, &file, &error), error);
    return file;
}

static char *read_page(const PageFile *file) {
    Error error = {0};
    char path[PAGE_NAME_SIZE + 64];
    assert_ok(file_path(path, sizeof path, &error, "%s/%s", temporary_folder, file->path), error);
    return text_of(path);
}

/* A set without parts, to write single pages. */
static PageSet begin(void) {
    Error error = {0};
    const PageSet set = {.folder = temporary_folder};
    temporary_path(""); /* makes the folder */
    assert_ok(file_make_directory(temporary_path("pages"), &error), error);
    return set;
}

/* 48 bytes a frame: 8 MB are 174,762 frames. What is not asked for does not count. */
TEST(a_long_run_has_every_second_frame) {
    const PageSet set = begin();
    const struct {
        int frames;
        PlayerOptions options;
        const char *every;
    } cases[] = {{174000, {.last = -1}, "\"every\": 1,"},
                 {175000, {.last = -1}, "\"every\": 2,"},
                 {175000, {.first = 2000, .last = -1}, "\"every\": 1,"},
                 {175000, {.last = 100}, "\"every\": 1,"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const PageFile file = write_run(&set, "a long/run", cases[i].frames, &cases[i].options);
        assert_string_equal(file.path, "pages/a_long_run.html");
        FREED char *text = read_page(&file);
        if (strstr(text, cases[i].every) == NULL) fail_msg("case %d: not %s", (int)i, cases[i].every);
        assert_int_equal(strlen(text), file.bytes);
    }
}

typedef struct TestRow {
    int number;
    const char *page;
    int bytes;
} TestRow;

static const CsvColumn columns[] = {
    {"number", CSV_INTEGER, .offset = offsetof(TestRow, number), .maximum = 9},
    {"page", CSV_TEXT, .offset = offsetof(TestRow, page), .maximum = 100},
    {"bytes", CSV_INTEGER, .offset = offsetof(TestRow, bytes), .maximum = 1000},
};
static const CsvLayout layout = CSV_LAYOUT("listed", columns, TestRow, .max_rows = 100);

/* Part 0 writes rows of two pages, one of them twice, and one without; part 1 another page. */
static const TestRow rows[] = {{1, "pages/a.html#t=1&body=2", 100},
                               {2, "pages/a.html#t=5", 100},
                               {3, "pages/b.html#t=1", 20},
                               {4, "", 0},
                               {5, "pages/c.html#t=1", 3}};

/* Where the second part fails once, and what the set has counted at its parts. */
typedef struct Work {
    PageSet *set;
    bool fails;
    int done[2];
    int64_t bytes[2];
} Work;

static bool write_part(void *context, int part, FILE *lines, const Progress *progress, Error *error) {
    (void)progress;
    Work *work = context;
    work->done[part]++;
    work->bytes[part] = work->set->bytes;
    if (part == 1 && work->fails) return error_input(error, "part", "fails");
    for (int i = part == 0 ? 0 : 4; i < (part == 0 ? 4 : 5); i++)
        assert_ok(piece_tables_print(lines, &layout, -1, &rows[i], error), *error);
    return true;
}

/* An interrupted set continues with the part that it was at, and counts the pages of those before it. */
TEST(pages_are_counted_once) {
    Work work = {.fails = true};
    for (int round = 0; round < 2; round++) {
        PageSet set = begin();
        set = (PageSet){.folder = set.folder, .layout = &layout, .parts = 2, .write = write_part, .context = &work};
        work.set = &set;
        assert_int_equal(page_set_make(&set, 1, NULL, &error), round == 1);
        assert_int_equal(work.bytes[1], 120);
        work.fails = false;
        if (round == 0) continue;
        assert_true(set.pages == 3 && set.bytes == 123 && set.left_out == 1);
        assert_ok(page_set_end(&set, &error), error);
    }
    assert_true(work.done[0] == 1 && work.done[1] == 2);
    assert_file(temporary_path("listed.csv"),
                "number,page,bytes\n1,pages/a.html#t=1&body=2,100\n2,pages/a.html#t=5,100\n"
                "3,pages/b.html#t=1,20\n4,,0\n5,pages/c.html#t=1,3\n");
}

TEST(beyond_the_limit_pages_are_left_out) {
    PageSet set = begin();
    char link[PAGE_LINK_SIZE];
    set.bytes = PAGE_SET_MAX_BYTES - 1;
    PageFile file = write_run(&set, "last", 3, &(PlayerOptions){.last = -1});
    page_set_link(link, &file, 0.125, 1, 1);
    assert_string_equal(link, "pages/last.html#t=0.125&body=1&run=1");
    page_set_link(link, &file, 0.125, -1, 1);
    assert_string_equal(link, "pages/last.html#t=0.125");
    set.bytes += file.bytes;
    file = write_run(&set, "beyond", 3, &(PlayerOptions){.last = -1});
    assert_true(file.path[0] == '\0' && file.bytes == 0);
    assert_int_equal(access(temporary_path("pages/beyond.html"), F_OK), -1);
    page_set_link(link, &file, 0.125, 1, 1);
    assert_string_equal(link, "");
}

RUN_TESTS(NULL, NULL)
