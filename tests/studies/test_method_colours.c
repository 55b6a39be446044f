/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method has one colour in film, page, figure and chart, and no two runs of a picture share one. */
#include "charts.h"
#include "player_page.h"
#include "owned.h"
#include "figures/run_figure.h"
#include "pictures/mesa.h"

#include "methods/methods.h"
#include "pictures/player.h"
#include "pictures/render.h"
#include "studies/chart_data.h"
#include "studies/chart_drawing.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"

enum { WIDTH = 1920, HEIGHT = 320, FRAMES = 3 };

/* All methods that have a colour, two further settings, and two others. */
static int list_methods(const char *names[COLOURS_MAX]) {
    int count = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (colours_have(kind->description->name)) names[count++] = kind->description->name;
    names[count++] = "scene-net:net=off";
    names[count++] = "engine:warm=off";
    names[count++] = "planck";
    names[count++] = "box2d";
    return count;
}

/* Pixels of this colour in a part of an image. */
static int count_pixels(const Image *image, Rect part, uint32_t colour) {
    int count = 0;
    for (int y = part.top; y < part.bottom; y++)
        for (int x = part.left; x < part.right; x++) {
            const uint8_t *p = image->pixels + 4 * (y * image->width + x);
            count += ((uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2]) == colour;
        }
    return count;
}

/* Each panel has its run's colour on its boxes and no other's. */
static void check_film(const Trajectory *const *runs, const RunColours *colours, int count, LookTheme theme) {
    RenderOptions options = {.width = WIDTH, .height = HEIGHT, .last = -1, .jobs = 1, .look.theme = theme};
    OWN(Image) *image = image_sized(WIDTH, HEIGHT);
    Picture picture;
    Error error = {0};
    assert_ok(picture_plan(&picture, runs, count, WIDTH, HEIGHT, &error), error);
    Renderer *renderer = renderer_create(runs, count, &options, &error);
    assert_ok(renderer != NULL && renderer_draw(renderer, 1, image, &error), error);
    for (int panel = 0; panel < count; panel++)
        for (int run = 0; run < count; run++) {
            const uint32_t fill = theme == LOOK_DARK ? colours[run].dark.fill : colours[run].light.fill;
            const int pixels = count_pixels(image, picture.layout.panels[panel], fill);
            if ((pixels > 20) != (panel == run))
                fail_msg("%d pixels of %s in the panel of %s", pixels, runs[run]->method, runs[panel]->method);
        }
    renderer_destroy(renderer);
    picture_free(&picture);
}

static void check_page(const Trajectory *const *runs, const RunColours *colours, int count) {
    const char *path = temporary_path("page.html");
    PlayerResult result;
    Error error = {0};
    assert_ok(player_write(runs, count, &(PlayerOptions){.last = -1}, path, &result, &error), error);
    FREED char *data = page_data(path);
    const char *next = data;
    for (int run = 0; run < count; run++) {
        uint32_t light, dark;
        next = strstr(next + 1, "\"colours\"");
        assert_non_null(next);
        assert_int_equal(sscanf(strstr(next, "\"light\""), "\"light\": {\"fill\": \"#%6x\"", &light), 1);
        assert_int_equal(sscanf(strstr(next, "\"dark\""), "\"dark\": {\"fill\": \"#%6x\"", &dark), 1);
        assert_int_equal(light, colours[run].light.fill);
        assert_int_equal(dark, colours[run].dark.fill);
    }
}

/* The strip's row of a run has its colour and no other's. */
static void check_figure(Trajectory *const *runs, const RunColours *colours, int count) {
    Sketch sketch;
    FigureSpec spec = spec_of(runs, 0);
    spec.run_count = count;
    for (int i = 0; i < count; i++) spec.runs[i] = runs[i], spec.paths[i] = "run.npz";
    spec.time_count = 1, spec.times[0] = 1 / 60.0;
    draw_kind(&sketch, "strip", &spec);
    for (int row = 0; row < count; row++) {
        const Image *image = nth_mark(&sketch, MARK_IMAGE, row)->image;
        const Rect whole = {0, 0, image->width, image->height};
        for (int run = 0; run < count; run++)
            assert_int_equal(count_pixels(image, whole, colours[run].light.fill) > 20, row == run);
    }
    sketch_free(&sketch);
}

/* Of at_once runs each: the last picture has the four whose colours depend on what is beside them, so no other has any
   of these. */
static int next_picture(int first, int at_once, int last) {
    if (first + at_once >= last) return first < last ? last : last + 1;
    return first + 2 * at_once > last ? last - at_once : first + at_once;
}

TEST(film_page_and_figure_have_the_colours_of_methods) {
    const char *names[COLOURS_MAX];
    RunColours all[COLOURS_MAX];
    const int count = list_methods(names);
    assert_ok(colours_assign(names, count, NULL, all, &error), error);
    const int at_once = 4, last = count - at_once;
    for (int first = 0; first <= last; first = next_picture(first, at_once, last)) {
        Trajectory *runs[RENDER_PANELS_MAX];
        for (int i = 0; i < at_once; i++) runs[i] = run_make(names[first + i], FRAMES);
        const RunColours *colours = &all[first];
        RunColours own[RENDER_PANELS_MAX];
        if (first == last) { /* without the engine, its setting has its colour */
            assert_ok(colours_assign(names + first, at_once, NULL, own, &error), error);
            assert_int_equal(own[1].light.fill, 0x0072B2);
            colours = own;
        }
        check_film((const Trajectory *const *)runs, colours, at_once, LOOK_LIGHT);
        check_film((const Trajectory *const *)runs, colours, at_once, LOOK_DARK);
        check_page((const Trajectory *const *)runs, colours, at_once);
        check_figure(runs, colours, at_once);
        for (int i = 0; i < at_once; i++) trajectory_destroy(runs[i]);
    }
}

/* A line of each, highlighted in turn. */
TEST(a_chart_of_all_methods_has_no_colour_twice) {
    const char *names[COLOURS_MAX];
    RunColours colours[COLOURS_MAX];
    char lines[8192] = "";
    size_t size, used = 0;
    const int count = list_methods(names);
    for (int i = 0; i < count; i++) {
        const size_t head = strcspn(names[i], ":");
        const char *words = names[i][head] != '\0' ? names[i] + head + 1 : "";
        for (int mark = 1; mark <= 2; mark++) {
            const int us = 10 * mark + i;
            used += (size_t)snprintf(lines + used, sizeof lines - used,
                                     "stack,%.*s,\"%s%sk=%d\",closed,impact,40,%d,,%g,,,,,,,,\n", (int)head, names[i],
                                     words, words[0] != '\0' ? "," : "", mark, us, 1.0 / mark + 0.01 * i);
        }
    }
    assert_ok(colours_assign(names, count, NULL, colours, &error), error);
    const char *path = write_chart(lines);
    CsvTable table;
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    for (int i = 0; i < count; i++) {
        Chart chart;
        assert_ok(chart_gather(&chart, &table, "stack", path, &(ChartLook){.highlight = names[i]}, &error), error);
        int line = 0;
        while (line < chart.line_count && strcmp(chart.lines[line].key, names[i]) != 0) line++;
        assert_true(line < chart.line_count);
        assert_int_equal(chart_line_style(&chart.lines[line]).colour, colours[i].light.fill);
        for (int k = 0; k < i; k++) assert_int_not_equal(colours[i].light.fill, colours[k].light.fill);
        chart_free(&chart);
    }
    csv_table_free(&table);
    assert_ok(chart_plot(path, "stack", temporary_folder, &(ChartLook){.highlight = "momentum"}, &error), error);
    FREED char *svg = read_whole(temporary_path("chart-stack.svg"), &size);
    static const char *const strokes[] = {"\"#0072B2", "\"#D07CB1", "\"#009E73"}; /* engine, interior, momentum */
    for (int i = 0; i < 3; i++)
        if (strstr(svg, strokes[i]) == NULL) fail_msg("the chart lacks %s", strokes[i]);
}

RUN_TESTS(NULL, NULL)
