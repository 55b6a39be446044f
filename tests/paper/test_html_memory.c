/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whichever allocation fails, also of cmark-gfm, which aborts by itself: a page is written whole, or memory is
   named. */
#include "made.h"
#include "library_allocations.h"

#include "paper/report_internal.h"

static char whole[1 << 14];

static const char markdown[] =
    "# A & *b*\n\n## `c` & d\n\n| a | b |\n|---|---:|\n| 1 | \\| |\n\n![\"x\" & y](a.png)\n\n"
    "**Figure 1.** z\n\n- one [link](b.md)\n- two\n\n> quoted &copy;\n";

static bool write_page(Error *error) {
    static char text[sizeof whole];
    const HtmlPage page = {markdown, "p { margin: 0; }\n", temporary_folder};
    const int failing = failing_allocation;
    failing_allocation = 0;
    FILE *out = fmemopen(text, sizeof text, "w");
    assert_non_null(out);
    setvbuf(out, NULL, _IONBF, 0);
    failing_allocation = failing;
    const bool done = html_page_write(&page, out, error);
    fclose(out);
    if (!done) return false;
    if (whole[0] == '\0') strcpy(whole, text);
    assert_string_equal(text, whole);
    return true;
}

TEST(a_page_is_whole_or_memory_is_short) {
    Image *image = image_sized(5, 3);
    assert_ok(image_write_png(image, temporary_path("a.png"), NULL, 0, &error), error);
    image_destroy(image);
    assert_memory_is_named(write_page);
    assert_non_null(strstr(whole, "<figcaption><p><strong>Figure 1.</strong> z</p>"));
    assert_non_null(strstr(whole, "<table>"));
}

RUN_TESTS(NULL, NULL)
