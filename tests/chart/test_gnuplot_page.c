/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Axes, seeds and series of gnuplot pages. */
#include "testing.h"

#include "chart/gnuplot_axis.h"
#include "chart/gnuplot_seeds.h"

#include <math.h>

typedef struct Sheet {
    GnuplotPage page;
    char *script;
    size_t size;
} Sheet;

static void open_sheet(Sheet *sheet) {
    *sheet = (Sheet){.page = {.width = 100, .height = 100}};
    sheet->page.script = open_memstream(&sheet->script, &sheet->size);
    assert_non_null(sheet->page.script);
    gnuplot_panel_begin(&sheet->page, (GnuplotBox){10, 10, 80, 80}, "");
}

static const char *close_sheet(Sheet *sheet) {
    gnuplot_panel_end(&sheet->page);
    assert_int_equal(fclose(sheet->page.script), 0);
    assert_false(sheet->page.no_memory);
    return sheet->script;
}

static void expect(const char *script, const char *text) {
    if (strstr(script, text) == NULL) fail_msg("no \"%s\" in:\n%s", text, script);
}

/* Three values, then four: the middle one, and the mean of the middle two. */
static void the_median_is_in_the_middle(void **state) {
    (void)state;
    SeedPoint points[] = {{1, 8, 2}, {2, 8, 30}, {3, 8, 4}, {1, 2, 5}, {2, 2, 1}, {3, 2, 3}, {4, 8, 6}};
    GnuplotLook look = gnuplot_look(0, "");
    Sheet sheet;
    open_sheet(&sheet);
    gnuplot_seed_median(&sheet.page, points, 7, &look);
    expect(close_sheet(&sheet), "$d1 << END\n2 3\n8 5\nEND\n");
    free(sheet.script);
}

static void seeds_have_lines_of_their_own(void **state) {
    (void)state;
    SeedPoint points[] = {{2, 8, 30}, {1, 8, 20}, {1, 2, 5}, {2, 2, 1}};
    GnuplotLook look = gnuplot_look(0, "");
    Sheet sheet;
    open_sheet(&sheet);
    gnuplot_seed_lines(&sheet.page, points, 4, &look);
    expect(close_sheet(&sheet), "$d1 << END\n2 5\n8 20\n\n2 1\n8 30\nEND\n");
    free(sheet.script);
}

/* gnuplot fails on a block without points. */
static void empty_series_are_not_plotted(void **state) {
    (void)state;
    GnuplotLook look = gnuplot_look(0, "");
    Sheet sheet;
    open_sheet(&sheet);
    gnuplot_series_begin(&sheet.page);
    gnuplot_point(&sheet.page, NAN, 1);
    gnuplot_point(&sheet.page, 1, NAN);
    gnuplot_bar(&sheet.page, 0, 1, NAN, 1);
    gnuplot_series_end(&sheet.page, &look);
    expect(close_sheet(&sheet), "plot NaN\n");
    free(sheet.script);
}

static void quotes_stay_within_texts(void **state) {
    (void)state;
    Sheet sheet;
    open_sheet(&sheet);
    gnuplot_text(&sheet.page, 25, 50, "left", 7, "the paper's");
    expect(close_sheet(&sheet), "set label 'the paper''s' at screen 0.250000,0.500000 left noenhanced font ',7'\n");
    free(sheet.script);
}

static void an_axis_holds_what_is_drawn(void **state) {
    (void)state;
    GnuplotPage page = {0};
    GnuplotRange range = gnuplot_range();
    const double values[] = {NAN, 0, -1, 10, 2000, 1e30};
    for (int i = 0; i < 6; i++) gnuplot_range_include(&range, values[i]);
    assert_true(range.least == 10 && range.most == 1e30);
    GnuplotAxis axis = gnuplot_axis(range, 1, 1e4, true);
    assert_true(axis.log.low < axis.zero && axis.zero < axis.least && axis.least <= 10 && axis.log.high > 1e4);
    assert_true(gnuplot_axis_clamp(&page, &axis, 10) == 10 && gnuplot_axis_clamp(&page, &axis, 0) == axis.zero);
    assert_true(isnan(gnuplot_axis_clamp(&page, &axis, NAN)));
    assert_false(page.beyond);
    assert_true(gnuplot_axis_clamp(&page, &axis, 1e30) == axis.log.high);
    assert_true(page.beyond);
}

/* Of 40 decades, as of 4, only as many are labelled as fit; 0 has its own tic, the others begin after it. */
static void tics_have_room(void **state) {
    (void)state;
    for (int decades = 4; decades <= 40; decades += 36) {
        GnuplotAxis axis = gnuplot_axis((GnuplotRange){pow(10, -decades), 1}, 1e-50, 1, true);
        Sheet sheet;
        open_sheet(&sheet);
        gnuplot_log_axis(&sheet.page, 'x', &axis, "Weight");
        const char *script = close_sheet(&sheet);
        int named = 0;
        for (const char *at = script; (at = strstr(at, "'10^{")) != NULL; at++) named++;
        assert_in_range(named, decades == 4 ? 5 : 6, 9);
        const char *first = strchr(strstr(script, "set xtics scale"), '\'');
        assert_near(strtod(strchr(first + 1, '\'') + 1, NULL) * pow(10, decades), 1, 1e-9);
        expect(script, "'10^{0}' 1 0");
        expect(script, "set xtics add ('0' ");
        free(sheet.script);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_median_is_in_the_middle),  cmocka_unit_test(seeds_have_lines_of_their_own),
        cmocka_unit_test(empty_series_are_not_plotted), cmocka_unit_test(quotes_stay_within_texts),
        cmocka_unit_test(an_axis_holds_what_is_drawn),  cmocka_unit_test(tics_have_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
