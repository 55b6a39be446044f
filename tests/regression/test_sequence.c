/* SPDX-License-Identifier: GPL-3.0-or-later */
/* File names, and the pairs of two sequences. */
#include "testing.h"

#include "base/file.h"
#include "regression/sequence.h"

/* A folder of empty files with these names, separated by spaces. */
static const char *folder_of(const char *name, const char *files) {
    Error error = {0};
    const char *folder = temporary_path(name);
    assert_ok(file_make_directory(folder, &error), error);
    char list[512], path[512], parent[512];
    snprintf(list, sizeof list, "%s", files);
    for (char *file = strtok(list, " "); file != NULL; file = strtok(NULL, " ")) {
        snprintf(path, sizeof path, "%s/%s", folder, file);
        snprintf(parent, sizeof parent, "%.*s", (int)file_folder_length(path), path);
        assert_ok(file_make_directory(parent, &error), error);
        FILE *out = fopen(path, "w");
        assert_non_null(out);
        fclose(out);
    }
    return folder;
}

static ImageSequence *opened(const char *path) {
    Error error = {0};
    ImageSequence *sequence = image_sequence_open(path, true, false, &error);
    assert_ok(sequence != NULL, error);
    return sequence;
}

/* "a=b a=- -=b a|c|d=b": the pairs of two folders, with further accepted pictures. */
static void assert_pairs(const char *a, const char *b, const char *wanted) {
    Error error = {0};
    ImageSequence *first = opened(a), *second = opened(b);
    int count;
    char found[1024] = "";
    SequencePair *pairs = image_sequence_pair(first, second, &count, &error);
    assert_ok(pairs != NULL, error);
    for (int i = 0; i < count; i++) {
        size_t used = strlen(found);
        used += (size_t)snprintf(found + used, sizeof found - used, "%s%s", i > 0 ? " " : "",
                                 pairs[i].a != NULL ? pairs[i].a->name : "-");
        for (const SequenceFrame *other = pairs[i].a != NULL ? pairs[i].a->next : NULL; other != NULL;
             other = other->next)
            used += (size_t)snprintf(found + used, sizeof found - used, "|%s", other->name);
        snprintf(found + used, sizeof found - used, "=%s", pairs[i].b != NULL ? pairs[i].b->name : "-");
    }
    assert_string_equal(found, wanted);
    free(pairs);
    image_sequence_close(first);
    image_sequence_close(second);
}

TEST(frames_meet_by_stem_and_number) {
    const char *a = folder_of("stems_a", "pyramid_000030.png stack_000000.png stack_000030.png cover.png notes.txt");
    const char *b = folder_of("stems_b", "stack_30.PNG stack_000031.png pyramid_000030.png cover.png .stack_1.png");
    assert_pairs(a, b,
                 "cover.png=cover.png pyramid_000030.png=pyramid_000030.png stack_000000.png=- "
                 "stack_000030.png=stack_30.PNG -=stack_000031.png");
}

/* Two tools name their frames differently. */
TEST(where_there_is_one_stem_numbers_decide) {
    assert_pairs(folder_of("ours", "frame_000002.png frame_000010.png"), folder_of("theirs", "0010.png 0003.png 2.png"),
                 "frame_000002.png=2.png -=0003.png frame_000010.png=0010.png");
}

TEST(a_name_without_number_meets_no_other) {
    assert_pairs(folder_of("cover_a", "cover.png"), folder_of("cover_b", "title.png"), "cover.png=- -=title.png");
}

TEST(each_folder_is_paired_by_itself) {
    assert_pairs(folder_of("deep_a", "x.png p/frame_1.png p/frame_2.png q/frame_1.png p/r/x.png"),
                 folder_of("deep_b", "p/shot-1.png p/shot-2.png q/a_1.png q/b_1.png x.png r/x.png"),
                 "x.png=x.png p/frame_1.png=p/shot-1.png p/frame_2.png=p/shot-2.png p/r/x.png=- -=q/a_1.png "
                 "-=q/b_1.png q/frame_1.png=- -=r/x.png");
}

/* plot-1.png and plot-01.png are two files. */
TEST(equal_names_meet_first) {
    const char *two = folder_of("exact_a", "plot-1.png plot-01.png");
    assert_pairs(two, folder_of("exact_b", "plot-01.png plot-1.png"), "plot-01.png=plot-01.png plot-1.png=plot-1.png");
    assert_pairs(two, folder_of("exact_c", "plot-1.png"), "plot-01.png=- plot-1.png=plot-1.png");
    assert_pairs(two, folder_of("exact_d", "plot-1.png plot-001.png"),
                 "plot-01.png=plot-001.png plot-1.png=plot-1.png");
    assert_pairs(two, folder_of("exact_e", "plot-2.png"), "plot-01.png=- plot-1.png=- -=plot-2.png");
    assert_pairs(folder_of("exact_f", "X.PNG"), folder_of("exact_g", "X.png x.png"), "X.PNG=X.png -=x.png");
}

TEST(names_with_a_second_number_are_accepted_too) {
    assert_pairs(folder_of("more_a", "home.png home.1.png home.10.png home.2.png home.01.png home.0.png home.x.png"),
                 folder_of("more_b", "home.png"),
                 "home.png|home.1.png|home.2.png|home.10.png=home.png home.0.png=- home.01.png=- home.x.png=-");
    assert_pairs(folder_of("frames_a", "s/f_01.png s/f_01.1.png s/f_02.png"),
                 folder_of("frames_b", "s/f_01.png s/f_02.png"),
                 "s/f_01.png|s/f_01.1.png=s/f_01.png s/f_02.png=s/f_02.png");
}

/* Then they are frames of their own, and what lacks is missing. */
TEST(numbered_names_in_both_folders_are_frames) {
    assert_pairs(folder_of("own_a", "home.png home.1.png home.2.png"), folder_of("own_b", "home.png home.1.png"),
                 "home.png=home.png home.1.png=home.1.png home.2.png=-");
    assert_pairs(folder_of("own_c", "home.1.png home.2.png"), folder_of("own_d", "home.png"),
                 "-=home.png home.1.png=- home.2.png=-");
    assert_pairs(folder_of("own_e", "home.png home.1.png"), folder_of("own_f", "other.png"),
                 "home.png=- home.1.png=- -=other.png");
    /* Only expected pictures are accepted. */
    assert_pairs(folder_of("own_g", "home.png"), folder_of("own_h", "home.png home.1.png"),
                 "home.png=home.png -=home.1.png");
}

TEST(two_files_meet_whatever_their_names) {
    char a[300], b[300];
    snprintf(a, sizeof a, "%s/before_7.png", folder_of("files_a", "before_7.png"));
    snprintf(b, sizeof b, "%s/after.png", folder_of("files_b", "after.png"));
    assert_pairs(a, b, "before_7.png=after.png");
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    assert_refused(image_sequence_open(path, true, false, &error), text);
}

TEST(doubtful_folders_are_refused) {
    refuse(folder_of("bytes", "frame_\xFF.png"), "/frame_\\xff.png: error: its name is not UTF-8");
    refuse(folder_of("line", "frame_\x01.png"), "/frame_\\x01.png: error: its name");
    refuse(folder_of("bidi", "frame_\u202Egnp.png"), "/frame_\\u202egnp.png: error: its name");
    refuse(temporary_path("nowhere"), "nowhere: error: cannot be read");
    int count;
    ImageSequence *folder = opened(folder_of("folder", "1.png")), *file = opened(temporary_path("folder/1.png"));
    assert_refused(image_sequence_pair(folder, file, &count, &error), "is a folder, but");
    image_sequence_close(folder);
    image_sequence_close(file);
}

TEST(frames_that_could_be_two_pairs_are_refused) {
    int count;
    ImageSequence *a = opened(folder_of("twice", "frame_1.png frame_01.png")),
                  *b = opened(folder_of("once", "f_1.png"));
    assert_refused(image_sequence_pair(a, b, &count, &error),
                   "twice/frame_1.png: error: has the same number as frame_01.png: which of them belongs");
    assert_refused(image_sequence_pair(b, a, &count, &error),
                   "twice/frame_1.png: error: has the same number as frame_01.png: which of them belongs");
    image_sequence_close(a);
    image_sequence_close(b);
}

TEST(pictures_in_subfolders_are_counted) {
    ImageSequence *sequence =
        image_sequence_open(folder_of("flat", "1.png a/1.png a/b/2.png a/x.txt"), false, false, &error);
    assert_ok(sequence != NULL, error);
    assert_int_equal(sequence->count, 1);
    assert_int_equal(sequence->skipped, 2);
    image_sequence_close(sequence);
}

TEST(names_are_utf8_without_control_characters) {
    static const char *const good[] = {"frame_1.png", "\xC3\xA9", "\xE4\xBD\xA0", "\xF0\x9F\x98\x80", "a b"};
    static const char *const bad[] = {"\n",       "\x7F", "\xC2\x85", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                                      "\xE4\xBD", "\x80", "a\u202Eb"};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) assert_true(name_is_text(good[i]));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) assert_false(name_is_text(bad[i]));
}

RUN_TESTS(NULL, NULL)
