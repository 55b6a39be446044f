/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

#include "paper/report_internal.h"

static void write_picture(const char *name) {
    Error error = {0};
    OWN(Image) *image = image_sized(5, 3);
    assert_ok(image_write_png(image, temporary_path(name), NULL, 0, &error), error);
}

static char *write_page(const char *markdown) {
    Error error = {0};
    char *text;
    size_t size;
    const HtmlPage page = {markdown, "p { margin: 0; }\n", temporary_folder};
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_ok(html_page_write(&page, out, &error), error);
    fclose(out);
    return text;
}

static void expect_within(const char *markdown, const char *expected) {
    FREED char *page = write_page(markdown);
    if (strstr(page, expected) == NULL) fail_msg("the page lacks \"%s\":\n%s", expected, page);
}

static void expect_without(const char *markdown, const char *unwanted) {
    FREED char *page = write_page(markdown);
    if (strstr(page, unwanted) != NULL) fail_msg("the page has \"%s\":\n%s", unwanted, page);
}

TEST(headings_make_title_and_contents) {
    expect_within("# A & *b*\n", "<title>A &amp; b</title>");
    expect_within("# A\n\n## B\n\n## `c` & d\n",
                  "<ol>\n<li><a href=\"#part-1\">B</a></li>\n<li><a href=\"#part-2\">c &amp; d</a></li>\n</ol>");
    expect_within("# A\n\n## B\n\n## C\n", "<div id=\"part-2\"><h2>C</h2>\n</div>");
    expect_without("# A\n\n### B\n", "<nav");
}

TEST(tables_can_be_scrolled) {
    expect_within("### B\n\n| a | b |\n|---|---:|\n| 1 | \\| |\n",
                  "<div class=\"table\" role=\"region\" tabindex=\"0\" aria-label=\"B\">\n<table>");
    expect_within("| a | b |\n|---|---:|\n| 1 | \\| |\n", "<td style=\"text-align: right\">|</td>");
}

TEST(pictures_are_embedded) {
    (void)temporary_path("");
    write_picture("a.png");
    expect_within("![\"x\" & y](a.png)\n\n**Figure 1.** z\n\nbehind\n",
                  "<figure><img width=\"5\" height=\"3\" style=\"max-width:3px\" alt=\"&quot;x&quot; &amp; y\" "
                  "src=\"data:image/png;base64,iVBORw0KGgo");
    expect_within("![x](a.png)\n\n**Figure 1.** z\n\nbehind\n",
                  "<figcaption><p><strong>Figure 1.</strong> z</p>\n</figcaption></figure>\n<p>behind</p>");
    expect_within("![x](a.png)\n", "<figcaption></figcaption></figure>");
    FILE *out = fopen("/dev/null", "w");
    assert_non_null(out);
    const HtmlPage page = {"![x](b.png)\n", "", temporary_folder};
    assert_refused(html_page_write(&page, out, &error), "b.png: error: cannot open");
    fclose(out);
}

TEST(html_in_the_text_is_left_out) {
    expect_without("<script>alert(1)</script>\n", "<script");
    expect_without("a <b>c</b>\n", "<b>");
    expect_without("[a](javascript:alert)\n", "javascript");
    expect_within("a &lt;b> & \\*c\\*\n", "<p>a &lt;b&gt; &amp; *c*</p>");
}

RUN_TESTS(NULL, NULL)
