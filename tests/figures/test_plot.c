/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Axes, ticks, series and legends of plots. */
#include "testing.h"

#include "figures/plot.h"
#include "figures/sketch.h"

#include "pixels/type.h"

TEST(an_axis_has_room_for_its_values) {
    PlotAxis axis = plot_log_axis(1, 1000, "");
    assert_true(axis.low < 1 && axis.low > 0.5 && axis.high > 1000 && axis.high < 2000);
    /* One value has a decade around it. */
    axis = plot_log_axis(30, 30, "");
    assert_near(log10(axis.high / axis.low), 1, 1e-12);
    assert_near(sqrt(axis.high * axis.low), 30, 1e-9);
    axis = (PlotAxis){.scale = PLOT_LOG, .low = 1, .high = 100, .from = 10, .to = 30};
    assert_near(plot_axis_place(&axis, 1), 10, 1e-12);
    assert_near(plot_axis_place(&axis, 10), 20, 1e-12);
    assert_near(plot_axis_place(&axis, 100), 30, 1e-12);
    axis = (PlotAxis){.low = 4, .high = -4, .from = 10, .to = 30};
    assert_near(plot_axis_place(&axis, 2), 15, 1e-12);
    axis.low = axis.high; /* one value is in the middle */
    assert_near(plot_axis_place(&axis, -4), 20, 1e-12);
}

TEST(an_axis_holds_what_is_drawn) {
    bool beyond = false;
    PlotRange range = plot_range();
    const double values[] = {NAN, 0, -1, INFINITY, 10, 2000, 1e30};
    for (int i = 0; i < 7; i++) plot_range_include(&range, values[i]);
    assert_true(range.least == 10 && range.most == 1e30);
    const PlotAxis axis = plot_range_axis(range, 1, 1e4, true, "");
    assert_true(axis.low < axis.zero && axis.zero < axis.least && axis.least <= 10 && axis.high > 1e4);
    assert_true(plot_axis_clamp(&axis, 10, &beyond) == 10 && plot_axis_clamp(&axis, 0, &beyond) == axis.zero);
    assert_true(isnan(plot_axis_clamp(&axis, NAN, &beyond)));
    assert_true(plot_axis_clamp(&axis, -INFINITY, &beyond) == axis.low);
    assert_true(plot_axis_clamp(&axis, INFINITY, &beyond) == axis.high);
    assert_false(beyond);
    assert_true(plot_axis_clamp(&axis, 1e30, &beyond) == axis.high);
    assert_true(beyond);
}

/* "5 10 20", powers as "2e-3"; minor ticks are counted in *minor. */
static const char *numbers_of(PlotAxis axis, double length, bool across, int *minor) {
    static char text[1024];
    static PlotTicks ticks;
    axis.from = 20, axis.to = 20 + length;
    plot_ticks_choose(&ticks, &axis, 7.5, across);
    text[0] = '\0';
    *minor = 0;
    for (int i = 0; i < ticks.count; i++) {
        const PlotTick *tick = &ticks.items[i];
        *minor += tick->minor;
        if (tick->minor) continue;
        const size_t used = strlen(text);
        if (tick->digit > 0)
            snprintf(text + used, sizeof text - used, "%de%d ", tick->digit, tick->power);
        else
            snprintf(text + used, sizeof text - used, "%s ", tick->text);
    }
    return text;
}

static void expect_numbers(PlotAxis axis, double length, bool across, int minor, const char *expected) {
    int found;
    assert_string_equal(numbers_of(axis, length, across, &found), expected);
    assert_int_equal(found, minor);
}

static PlotAxis log_from(double low, double high) {
    return (PlotAxis){.scale = PLOT_LOG, .low = low, .high = high, .least = low};
}

TEST(short_axes_have_ticks_at_1_2_5) {
    expect_numbers(log_from(4.5, 22), 50, true, 4, "5 10 20 ");
    expect_numbers(log_from(4.5, 22), 6, true, 6, "10 "); /* no room for three */
    PlotAxis powers = log_from(4.5, 22);
    powers.powers = true;
    expect_numbers(powers, 50, true, 4, "5e0 1e1 2e1 ");
}

TEST(long_axes_have_ticks_at_decades) {
    /* 0.008, 0.009; 8 each in the three decades; 10 is the last but 2 to 9 */
    expect_numbers(log_from(0.008, 12), 50, true, 2 + 3 * 8, "0.01 0.1 1 10 ");
    expect_numbers(log_from(0.008, 12), 10, true, 0 + 2, "0.01 1 ");
}

/* Of 40 decades, as of 4, only as many have numbers as fit; 0 has its own tick, the others begin after it. */
TEST(ticks_have_room) {
    for (int decades = 4; decades <= 40; decades += 36) {
        int minor, named = 0;
        const PlotAxis axis = plot_range_axis((PlotRange){pow(10, -decades), 1}, 1e-50, 1, true, "");
        const char *text = numbers_of(axis, 80, true, &minor);
        for (const char *at = text; (at = strstr(at, "1e")) != NULL; at++) named++;
        assert_in_range(named, decades == 4 ? 5 : 6, decades == 4 ? 5 : 14);
        assert_memory_equal(text, "0 1e-", 5);
        if (decades == 4) assert_non_null(strstr(text, "1e-4 "));
        assert_non_null(strstr(text, "1e0 "));
    }
}

TEST(linear_ticks_are_round_and_do_not_touch) {
    expect_numbers(plot_linear_axis(0, 1.3, ""), 60, true, 0, "0.0 0.2 0.4 0.6 0.8 1.0 1.2 ");
    expect_numbers(plot_linear_axis(0, 1030, ""), 45, true, 0, "0 200 400 600 800 1000 ");
    expect_numbers(plot_linear_axis(0, 1030, ""), 10, true, 0, "0 1000 ");
    expect_numbers(plot_linear_axis(0, 1030, ""), 9, false, 0, "0 500 1000 ");
    expect_numbers(plot_linear_axis(-2e-5, 3e-5, ""), 60, true, 0, "−0.00002 0.00000 0.00002 ");
    expect_numbers(plot_linear_axis(-1e30, 1e30, ""), 60, true, 0, "-1e+30 -5e+29 0 5e+29 1e+30 ");
    expect_numbers(plot_linear_axis(7, 7, ""), 60, true, 0, "7 ");
    PlotAxis doubling = plot_linear_axis(0.8, 160, "");
    doubling.scale = PLOT_DOUBLING;
    expect_numbers(doubling, 60, true, 0, "1 2 4 8 16 32 64 128 ");
    expect_numbers(doubling, 15, true, 0, "1 8 64 ");
}

/* A page of one panel, from (10, 10) to (90, 90), with x and y from 0 to 8. Series i of the table draws row r there. */
typedef struct Table {
    int rows, series;
    PlotLook looks[4];
    PlotPoint points[4][8];
} Table;

static bool point_of(const void *of, int panel, int series, int row, PlotPoint *out) {
    (void)panel;
    *out = ((const Table *)of)->points[series][row];
    return true;
}

static void draw_table(PlotPage *page, const Table *table) {
    Error error = {0};
    PlotPanel panel = {
        .box = {10, 10, 80, 80}, .x = plot_linear_axis(0, 8, "Across"), .y = plot_linear_axis(0, 8, "Up")};
    const PlotSpec spec = {.width = 100,
                           .height = 100,
                           .panels = &panel,
                           .looks = table->looks,
                           .panel_count = 1,
                           .series = table->series,
                           .rows = table->rows,
                           .point = point_of,
                           .of = table,
                           .legend_columns = 2,
                           .legend_left = 2,
                           .legend_top = 4,
                           .caption = "What is seen."};
    *page = (PlotPage){0};
    assert_ok(plot_draw(page, &spec, "test", &error), error);
}

/* The open paths in this colour, "(20 30)(40 50); ", without the sample of the legend. */
static const char *lines_of(const PlotPage *page, uint32_t colour) {
    static char text[2048];
    const Sketch *sketch = &page->sketch;
    text[0] = '\0';
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        const Point *points = sketch->points + mark->first;
        if (mark->kind != MARK_PATH || mark->closed || mark->pen.line != colour || points[0].y < 10) continue;
        for (size_t k = 0; k < mark->count; k++) sprintf(text + strlen(text), "(%g %g)", points[k].x, points[k].y);
        strcat(text, "; ");
    }
    return text;
}

static int count_closed(const PlotPage *page, uint32_t fill) {
    int count = 0;
    for (size_t i = 0; i < page->sketch.mark_count; i++) {
        const SketchMark *mark = &page->sketch.marks[i];
        count += mark->kind == MARK_PATH && mark->closed && mark->pen.fill == fill;
    }
    return count;
}

static bool has_text(const PlotPage *page, const char *text) {
    for (size_t i = 0; i < page->sketch.mark_count; i++)
        if (page->sketch.marks[i].kind == MARK_TEXT &&
            strcmp(page->sketch.texts + page->sketch.marks[i].text, text) == 0)
            return true;
    return false;
}

static PlotLook line_look(uint32_t colour, const char *name) {
    return (PlotLook){.name = name, .style = {.colour = colour}, .line = 2};
}

/* Three values, then four: the middle one, and the mean of the middle two; below it a thin line for each seed. */
TEST(the_median_is_in_the_middle_of_the_seeds) {
    Table table = {.rows = 7,
                   .series = 1,
                   .looks = {line_look(0x112233, "seeds")},
                   .points = {{{8, 2, 1}, {8, 7, 2}, {8, 4, 3}, {2, 5, 1}, {2, 1, 2}, {2, 3, 3}, {8, 6, 4}}}};
    PlotPage page;
    table.looks[0].medians = true;
    draw_table(&page, &table);
    assert_string_equal(lines_of(&page, 0x112233), "(30 40)(90 60); ");
    plot_page_free(&page);
    table.looks[0].seeds = true;
    draw_table(&page, &table);
    assert_string_equal(lines_of(&page, 0x112233), "(30 60)(90 30); (30 20)(90 80); (30 40)(90 50); (30 40)(90 60); ");
    plot_page_free(&page);
}

/* NaN is no point, a series without points has no place in the legend, and lines are interrupted between groups. */
TEST(series_are_drawn_as_they_look) {
    const PlotLook stems = {.name = "stems", .style = {.colour = 0x445566}, .line = 1, .marks = true, .stems = true};
    const PlotLook band = {.name = "band", .style = {.colour = 0x778899}, .band = true};
    Table table = {.rows = 4,
                   .series = 4,
                   .looks = {line_look(0x112233, "line"), line_look(0xAABBCC, "nothing"), stems, band},
                   .points = {{{1, 1, 0}, {2, 2, 0}, {3, 3, 1}, {4, 4, 1}},
                              {{NAN, 1, 0}, {1, NAN, 0}, {NAN, NAN, 0}, {NAN, 0, 0}},
                              {{1, 4, 0}, {5, 2, 0}, {NAN, 1, 0}, {NAN, 1, 0}},
                              {{-INFINITY, 2, 0}, {INFINITY, 4, 0}, {NAN, 0, 0}, {NAN, 0, 0}}}};
    PlotPage page;
    draw_table(&page, &table);
    assert_string_equal(lines_of(&page, 0x112233), "(20 20)(30 30); (40 40)(50 50); ");
    assert_string_equal(lines_of(&page, 0xAABBCC), "");
    assert_string_equal(lines_of(&page, 0x445566), "(20 10)(20 50); (60 10)(60 30); ");
    assert_int_equal(count_closed(&page, 0x445566), 2 + 1); /* marks, and in the legend */
    assert_int_equal(count_closed(&page, 0x778899), 1 + 1);
    const Point *corners = page.sketch.points + page.sketch.marks[0].first; /* the last series is the lowest */
    assert_true(corners[0].x == 10 && corners[0].y == 30 && corners[2].x == 90 && corners[2].y == 50);
    assert_true(has_text(&page, "line") && has_text(&page, "stems") && has_text(&page, "band"));
    assert_true(has_text(&page, "Across") && has_text(&page, "Up") && has_text(&page, "8"));
    assert_false(has_text(&page, "nothing"));
    assert_string_equal(page.caption, "What is seen.\n");
    plot_page_free(&page);
}

/* From the first series, which is on top, to the last; but those above come after all others. */
TEST(the_first_series_is_on_top) {
    Table table = {.rows = 2, .series = 3};
    for (int i = 0; i < 3; i++) {
        table.looks[i] = line_look(0x100000u + (uint32_t)i, NULL);
        table.points[i][0] = (PlotPoint){1, i, 0}, table.points[i][1] = (PlotPoint){2, i, 0};
    }
    table.looks[2].above = true;
    PlotPage page;
    draw_table(&page, &table);
    static const uint32_t order[] = {0x100001, 0x100000, 0x100002};
    for (int i = 0; i < 3; i++) assert_int_equal(page.sketch.marks[i].pen.line, order[i]);
    plot_page_free(&page);
}

/* All look equally large: each area is near that of a circle; crosses reach as far. */
TEST(marks_have_one_size) {
    for (int symbol = 0; symbol < METHOD_SYMBOLS; symbol++) {
        Sketch sketch;
        double area = 0;
        sketch_begin(&sketch, 10, 10);
        plot_mark(&sketch, (Point){5, 5}, &(PlotStyle){.symbol = symbol, .colour = 1}, 2, 1);
        assert_int_equal(sketch.mark_count, 1);
        for (size_t i = 0; i < sketch.point_count; i++) {
            const Point a = sketch.points[i], b = sketch.points[(i + 1) % sketch.point_count];
            area += (a.x * b.y - b.x * a.y) / 2;
        }
        assert_in_range(lround(100 * area / (M_PI * 4)), 72, 105);
        sketch_free(&sketch);
    }
    /* Fifteen styles follow each other before one comes again. */
    for (int i = 0; i < 15; i++)
        for (int k = 0; k < i; k++)
            assert_true(plot_style(i).symbol != plot_style(k).symbol || plot_style(i).open != plot_style(k).open);
}

/* The number of a custom tick may have two lines; an axis without a label has none. */
TEST(ticks_are_drawn_as_given) {
    static PlotTicks ticks;
    Sketch sketch;
    PlotPanel panel = {.box = {10, 10, 80, 80}, .x = plot_linear_axis(0, 8, ""), .y = plot_linear_axis(0, 8, NULL)};
    plot_tick_add(&ticks, 2, false, "pyramid,\nsettled");
    panel.x.ticks = &ticks;
    panel.x.outside = true;
    plot_panel_place(&panel);
    sketch_begin(&sketch, 100, 100);
    plot_panel_draw(&sketch, &panel);
    int texts = 0;
    for (size_t i = 0; i < sketch.mark_count; i++) {
        const SketchMark *mark = &sketch.marks[i];
        if (mark->kind != MARK_TEXT) continue;
        assert_string_equal(sketch.texts + mark->text, texts == 0 ? "pyramid," : "settled");
        assert_true(mark->at.x == 30 && mark->at.y < 10);
        texts++;
    }
    assert_int_equal(texts, 2);
    sketch_free(&sketch);
}

TEST(powers_are_as_wide_as_they_say) {
    static const TextAlign aligns[] = {TEXT_LEFT, TEXT_CENTER, TEXT_RIGHT};
    for (int i = 0; i < 3; i++) {
        Sketch sketch;
        sketch_begin(&sketch, 100, 100);
        sketch_power_of_ten(&sketch, (Point){50, 50}, &(TextStyle){8, aligns[i], 0, 0, false}, 2, -3);
        const SketchMark *base = &sketch.marks[0], *exponent = &sketch.marks[1];
        const double width = sketch_power_width(8, 2, -3);
        assert_string_equal(sketch.texts + base->text, "2·10");
        assert_string_equal(sketch.texts + exponent->text, "−3");
        assert_string_equal(sketch.texts + base->reads, "2·10⁻³");
        assert_near(exponent->at.x, 50 + width * (1 - i / 2.0), 1e-9);
        assert_near(base->at.x - type_width("2·10", 8), 50 - width * i / 2.0, 1e-9);
        sketch_free(&sketch);
    }
}

RUN_TESTS(NULL, NULL)
