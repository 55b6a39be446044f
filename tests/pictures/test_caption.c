/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A caption has the method's name as on the command line, then what its description states. */
#include "owned.h"

#include "pictures/pictures_internal.h"
#include "pictures/runs.h"

static const MethodDescription captioned = {.name = "captioned", .caption = "a caption"}, bare = {.name = "bare"};

static const MethodDescription *describe(const char *method) {
    const MethodDescription *const known[] = {&captioned, &bare};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strncmp(known[i]->name, method, strlen(known[i]->name)) == 0) return known[i];
    return NULL;
}

static void assert_caption(const char *method, bool described, const char *name, const char *note) {
    Error error = {0};
    Picture picture;
    OWN(Trajectory) *run = run_make(method, 2);
    const RenderOptions options = {.describe = described ? describe : NULL};
    char found_name[CAPTION_TEXT_SIZE], found_note[CAPTION_TEXT_SIZE];
    assert_ok(picture_plan(&picture, (const Trajectory *[]){run}, 1, 640, 360, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    caption_method(&picture, 0, found_name, found_note);
    assert_string_equal(found_name, name);
    assert_string_equal(found_note, note);
    picture_free(&picture);
}

TEST(a_description_gives_the_caption) {
    assert_caption("captioned:k=3", true, "captioned:k=3", "a caption");
    assert_caption("captioned:network=/far/away/net.npz,k=3", true, "captioned:network=net.npz,k=3", "a caption");
}

TEST(without_a_description_there_is_only_the_name) {
    assert_caption("bare:k=3", true, "bare:k=3", "");
    assert_caption("unknown:network=/far/away/net.npz", true, "unknown:network=net.npz", "");
    assert_caption("captioned:k=3", false, "captioned:k=3", "");
}

RUN_TESTS(NULL, NULL)
