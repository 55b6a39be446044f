/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of a stability study, from tables made up here. */
#include "python.h"

#include "figure/stability_figures.h"

#include "common/file.h"
#include "figure/stability_table.h"

#include <math.h>
#include <sys/stat.h>

#define MAPS "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,frame,body,value,unit\n"
#define BORDERS "study,method,setting,parameter,unit,holds_at,fails_at,verdict\n"
#define ONE_CELL "stack,engine,k=10,ratio,,1,height,boxes,2,falls,100,1,0.5,m\n"
#define ONE_BORDER "stack,engine,k=10,height,boxes,10,11,falls\n"

static void write_table(const char *name, const char *text) {
    Error error = {0};
    assert_ok(file_write_soon(temporary_path(name), text, strlen(text), &error), error);
}

static void start_afresh(const char *maps, const char *borders) {
    remove_temporary_folder();
    assert_int_equal(mkdir(temporary_folder, 0700), 0);
    write_table("maps.csv", maps);
    write_table("stability.csv", borders);
}

static void draw(void) {
    Error error = {0};
    assert_ok(stability_figures_write(temporary_folder, &error), error);
}

static char *read_file(const char *name, size_t *size) {
    Error error = {0};
    char *data = file_read(temporary_path(name), 1 << 24, size, &error);
    assert_ok(data != NULL, error);
    return data;
}

/* A map of methods x `across` x `up` cells of the verdicts in turn. */
static char *make_map(int methods, int across, int up) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fputs(MAPS, file);
    for (int method = 0; method < methods; method++)
        for (int cell = 0; cell < across * up; cell++)
            fprintf(file, "grid,engine,k=%d,ratio,,%g,height,boxes,%d,%s,,,,\n", method, pow(10, cell % across),
                    3 + cell / across, verdict_words[cell % LOOK_MISSING]);
    assert_int_equal(fclose(file), 0);
    return text;
}

/* Defines count(svg, "#RRGGBB"): filled areas of a colour; and texts(svg). */
#define SVG_FUNCTIONS                                                                         \
    "import sys, re, xml.etree.ElementTree as tree\n"                                         \
    "def read(name): return open(sys.argv[1] + '/' + name + '.svg').read()\n"                 \
    "def count(svg, colour):\n"                                                               \
    "    rgb = 'rgb(%3d, %3d, %3d)' % tuple(int(colour[i:i + 2], 16) for i in (1, 3, 5))\n"   \
    "    return sum(rgb in part and part.startswith('polygon') for part in svg.split('<'))\n" \
    "def texts(svg):\n"                                                                       \
    "    found = tree.fromstring(svg).iter('{http://www.w3.org/2000/svg}text')\n"             \
    "    return [' '.join(''.join(e.itertext()).split()) for e in found]\n"                   \
    "def expect(found, wanted, what):\n"                                                      \
    "    assert found == wanted, (what, found, wanted)\n"

/* One cell of each verdict, and one sample in the legend. */
static void each_verdict_has_its_tile(void **state) {
    (void)state;
    char *maps = make_map(1, 3, 3), program[4096];
    start_afresh(maps, BORDERS ONE_BORDER);
    free(maps);
    draw();
    size_t used = (size_t)snprintf(program, sizeof program, "%ssvg = read('map-grid')\n", SVG_FUNCTIONS);
    for (int look = 0; look < VERDICTS; look++)
        used += (size_t)snprintf(program + used, sizeof program - used, "expect(count(svg, '%s'), 2, '%s')\n",
                                 verdict_looks[look].fill, verdict_looks[look].name);
    snprintf(program + used, sizeof program - used,
             "for text in ('settles', 'non-finite', 'not applicable', 'Height (boxes)', 'Ratio', 'engine, k=0'):\n"
             "    expect(texts(svg).count(text), 1, text)\n"
             "assert 'not run' not in texts(svg)\n");
    run_python(program, temporary_folder);
}

/* Two edges: between two cells side by side, and between two one above the other with a row's gap in their values. A cell
   without a row and one that is not applicable have none. */
static void the_border_parts_holding_from_failing(void **state) {
    (void)state;
    start_afresh(MAPS "m,engine,,a,,1,b,,1,settles,,,,\nm,engine,,a,,2,b,,1,sways,,,,\nm,engine,,a,,3,b,,1,falls,,,,\n"
                      "m,engine,,a,,1,b,,2,creeps,,,,\nm,engine,,a,,3,b,,2,sinks,,,,\n"
                      "m,engine,,a,,1,b,,5,explodes,,,,\nm,engine,,a,,2,b,,5,not applicable,,,,\n",
                 BORDERS ONE_BORDER);
    draw();
    run_python(SVG_FUNCTIONS "svg = read('map-m')\n"
                             "expect(count(svg, '#000000'), 2 + 1, 'edges and their sample')\n"
                             "for text in ('not run', 'not applicable', 'border of holding'):\n"
                             "    expect(texts(svg).count(text), 1, text)\n",
               temporary_folder);
}

/* Every cell that was run has a link over its tile and nowhere else. */
static void cells_link_to_their_clips(void **state) {
    (void)state;
    start_afresh(
        MAPS "m,engine,\"k=4,warm=off\",a,,1,b,,0.5,falls,,,,\nm,engine,\"k=4,warm=off\",a,,2e3,b,,0.5,settles,,,,\n"
             "m,engine,\"k=4,warm=off\",a,,1,b,,7,not applicable,,,,\n",
        BORDERS ONE_BORDER);
    draw();
    run_python(
        SVG_FUNCTIONS
        "svg = read('map-m')\n"
        "root, space = tree.fromstring(svg), '{http://www.w3.org/2000/svg}'\n"
        "scale = float(re.search(r'scale.([0-9.]+)', svg[svg.index('<a '  ) - 60:]).group(1))\n"
        "def edges(fill):\n"
        "    x, y = zip(*(map(float, p.split(',')) for p in re.search(\"rgb.%s.' points = '([^']*)'\" % fill, svg)\n"
        "        .group(1).split()))\n"
        "    return [min(x), min(y), max(x), max(y)]\n"
        "for fill, x, verdict in (('238, 154,  46', '1', 'falls'), ('234, 243, 250', '2000', 'settles')):\n"
        "    link = [a for a in root.iter(space + 'a') if a.find(space + 'title').text ==\n"
        "            'm:engine:k=4,warm=off:%s,0.5 %s' % (x, verdict)][0]\n"
        "    target = link.get('{http://www.w3.org/1999/xlink}href')\n"
        "    expect(target, 'clips/m-engine_k=4_warm=off-%s_0.5.mp4' % x, 'target')\n"
        "    at = [scale * float(link.find(space + 'rect').get(k)) for k in ('x', 'y', 'width', 'height')]\n"
        "    place = [at[0], at[1], at[0] + at[2], at[1] + at[3]]\n"
        "    assert all(abs(a - b) < 1 for a, b in zip(place, edges(fill))), (place, edges(fill))\n"
        "expect(len(list(root.iter(space + 'a'))), 2, 'links')\n",
        temporary_folder);
}

/* Whatever the order of the rows and the distance of the values: rising, and each a tic. */
static void axes_name_their_values(void **state) {
    (void)state;
    start_afresh(MAPS "m,engine,,rate,Hz,480,b_c,,1,falls,,,,\nm,engine,,rate,Hz,20,b_c,,1,falls,,,,\n"
                      "m,engine,,rate,Hz,30.5,b_c,,0.125,falls,,,,\nm,engine,,rate,Hz,20,b_c,,-7,falls,,,,\n",
                 BORDERS ONE_BORDER);
    draw();
    run_python(SVG_FUNCTIONS "found = texts(read('map-m'))\n"
                             "at = [found.index(text) for text in ('-7', '0.125', '1', '20', '30.5', '480')]\n"
                             "assert at == sorted(at), found\n"
                             "assert 'Rate (Hz)' in found and 'B c' in found, found\n",
               temporary_folder);
}

static void titles_are_cut_where_they_tell_the_least(void **state) {
    (void)state;
    static const struct {
        const char *method, *setting, *text;
        size_t most;
    } cases[] = {{"engine", "", "engine", 20},
                 {"engine", "k=10,warm=off", "engine, k=10, warm=off", 22},
                 {"learned-momentum", "k=10,warm=off", "learned..., k=10, warm=off", 26},
                 {"learned-momentum", "k=10,warm=off", "learned-momentum,...", 20},
                 {"learned-momentum", "", "learned...", 10}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[STABILITY_TEXT_SIZE];
        stability_method_text(text, cases[i].most, cases[i].method, cases[i].setting);
        assert_string_equal(text, cases[i].text);
    }
}

static void many_methods_and_large_grids_are_drawn(void **state) {
    (void)state;
    static const struct { int methods, across, up; } cases[] = {{24, 3, 2}, {2, 1, 1}, {5, 2, 60}, {10, 8, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *maps = make_map(cases[i].methods, cases[i].across, cases[i].up), program[1024];
        start_afresh(maps, BORDERS ONE_BORDER);
        free(maps);
        draw();
        int cells = cases[i].across * cases[i].up;
        snprintf(program, sizeof program,
                 "%ssvg = read('map-grid')\nexpect(count(svg, '%s'), %d, 'settles')\n"
                 "expect(sum(t.startswith('engine, k=') for t in texts(svg)), %d, 'panels')\n",
                 SVG_FUNCTIONS, verdict_looks[0].fill,
                 cases[i].methods * ((cells + LOOK_MISSING - 1) / LOOK_MISSING) + 1, cases[i].methods);
        run_python(program, temporary_folder);
    }
}

static void the_same_tables_give_the_same_files(void **state) {
    (void)state;
    static const char *const names[] = {"map-grid.png", "map-grid.svg", "map-grid.txt",
                                        "borders.png",  "borders.svg",  "borders.txt"};
    char *maps = make_map(2, 4, 4), *data[2][6];
    size_t size[2][6];
    for (int run = 0; run < 2; run++) {
        start_afresh(maps, BORDERS ONE_BORDER);
        draw();
        for (int i = 0; i < 6; i++) data[run][i] = read_file(names[i], &size[run][i]);
    }
    for (int i = 0; i < 6; i++) {
        assert_int_equal(size[0][i], size[1][i]);
        assert_memory_equal(data[0][i], data[1][i], size[0][i]);
        free(data[0][i]);
        free(data[1][i]);
    }
    free(maps);
}

/* CIE 1931, from sRGB's primaries: what a grey print keeps of a colour. */
static double luminance(const char *colour) {
    unsigned rgb = (unsigned)strtoul(colour + 1, NULL, 16);
    double sum = 0;
    static const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int i = 0; i < 3; i++) {
        double value = (rgb >> (16 - 8 * i) & 255u) / 255.0;
        sum += weights[i] * (value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4));
    }
    return sum;
}

/* CIE 1976 L*, 0 to 100. */
static double lightness(const char *colour) { return 116 * cbrt(luminance(colour)) - 16; }

static void the_worse_the_darker(void **state) {
    (void)state;
    for (int look = 1; look < VERDICTS; look++) {
        double step = lightness(verdict_looks[look - 1].fill) - lightness(verdict_looks[look].fill);
        if (step < 6) fail_msg("%s is darker than the one before by %g only", verdict_looks[look].name, step);
    }
    assert_true(lightness(verdict_looks[VERDICT_CREEPS].fill) > 75);
    assert_true(lightness(verdict_looks[VERDICT_FALLS].fill) < 72);
}

/* WCAG 2.1 asks 3:1 of graphics. The dot of what settles is to be overlooked. */
static void symbols_stand_out_and_differ(void **state) {
    (void)state;
    for (int look = VERDICT_SWAYS; look < VERDICTS; look++) {
        double fill = luminance(verdict_looks[look].fill) + 0.05, ink = luminance(verdict_looks[look].ink) + 0.05;
        if (fmax(fill, ink) / fmin(fill, ink) < 3) fail_msg("%s: too little contrast", verdict_looks[look].name);
        for (int other = 0; other < look; other++)
            assert_true(verdict_looks[other].symbol != verdict_looks[look].symbol ||
                        verdict_looks[look].size > 2 * verdict_looks[other].size);
    }
}

static void looks_are_those_of_the_verdicts(void **state) {
    (void)state;
    for (int verdict = 0; verdict < VERDICTS; verdict++) {
        assert_string_equal(verdict_looks[verdict].name, verdict_name((Verdict)verdict));
        assert_string_equal(verdict_words[verdict], verdict_name((Verdict)verdict));
    }
    assert_string_equal(verdict_words[LOOK_NOT_APPLICABLE], verdict_looks[LOOK_NOT_APPLICABLE].name);
    assert_null(verdict_words[LOOK_MISSING]);
}

/* Of a method that holds to 15, fails from 16 to 19, holds from 20 to 25 and fails from 26: no bar is where it fails. The
   other holds throughout, and its bar tells where the panel ends. */
static void bars_end_at_the_next_border(void **state) {
    (void)state;
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,15,16,falls\na,engine,,h,,20,19,sinks\na,engine,,h,,25,26,falls\n"
                                        "a,nncg,,h,,30,,settles\n");
    draw();
    run_python(SVG_FUNCTIONS
               "bars = re.findall(\"polygon fill = 'rgb.163, 203, 229.' points = '([^']*)'\", read('borders'))\n"
               "ends = [sorted({float(p.split(',')[0]) for p in bar.split()}) for bar in bars][:4]\n"
               "left, right = ends[3]\n"
               "expect(ends[1], ends[2], 'both bars of what holds from 20 to 25')\n"
               "assert left == ends[0][0] < ends[0][1] < ends[1][0] < ends[1][1] < right, ends\n",
               temporary_folder);
}

/* Beyond 30 luck decides, to the end of the range: the bar ends there, and the tile stands at the far end; on an axis of
   which smaller values are harder that is the left one. Of b luck is all there is. */
static void where_luck_decides_no_bar_is_drawn(void **state) {
    (void)state;
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,30,,falls\na,nncg,,h,,20,40,sinks\nb,engine,,r,,,,falls\n"
                                        "b,nncg,,r,,60,50,sinks\nc,engine,,r,,60,,falls\nc,nncg,,r,,80,50,sinks\n");
    draw();
    char program[2048];
    snprintf(program, sizeof program,
             "%sdef ends(rgb): return [sorted({float(p.split(',')[0]) for p in bar.split()}) for bar in\n"
             "    re.findall(\"polygon fill = 'rgb.%%s.' points = '([^']*)'\" %% rgb, read('borders'))]\n"
             "bars, falls, sinks = ends('163, 203, 229'), ends('238, 154,  46'), ends('207, 100,  20')\n"
             "expect(len(bars), 2 + 1 + 2 + 2, 'bars and their samples')\n"
             "assert bars[0][1] < falls[0][0] and bars[0][0] == bars[1][0], (bars, falls)\n"
             "assert sinks[0][1] <= falls[0][0], 'the far end is beyond the last value'\n"
             "assert falls[2][1] < sinks[2][0] + 1 < bars[3][0] < bars[4][0], (bars, falls, sinks)\n",
             SVG_FUNCTIONS);
    run_python(program, temporary_folder);
}

/* Studies without a map, and a map alone. */
static void a_table_without_rows_has_no_figure(void **state) {
    (void)state;
    start_afresh(MAPS, BORDERS ONE_BORDER);
    draw();
    assert_int_equal(access(temporary_path("borders.png"), R_OK), 0);
    start_afresh(MAPS ONE_CELL, BORDERS);
    draw();
    assert_int_equal(access(temporary_path("borders.png"), F_OK), -1);
    assert_int_equal(access(temporary_path("map-stack.png"), R_OK), 0);
}

static void borders_are_drawn_as_the_table_has_them(void **state) {
    (void)state;
    start_afresh(MAPS ONE_CELL,
                 BORDERS "height,engine,k=10,height,boxes,10,11,falls\nheight,momentum,,height,boxes,15,16,falls\n"
                         "height,momentum,,height,boxes,20,19,sinks\nheight,nncg,,height,boxes,40,,settles\n"
                         "height,pair-net,,height,boxes,,2,explodes\nheight,scene-net,,height,boxes,,,not applicable\n"
                         "time_step,engine,k=10,rate,Hz,60,50,falls\ntime_step,nncg,,rate,Hz,20,,creeps\n");
    draw();
    char program[4096];
    snprintf(program, sizeof program,
             "%ssvg = read('borders')\n"
             "expect(count(svg, '#A3CBE5'), 4 + 2 + 2, 'bars')\n"
             "expect(count(svg, '%s'), 3 + 1, 'falls')\nexpect(count(svg, '%s'), 1 + 1, 'explodes')\n"
             "expect(count(svg, '%s'), 1 + 1, 'sinks')\n"
             "for text in ('Time step', 'Rate (Hz)', 'engine, k=10', 'never holds', 'not applicable'):\n"
             "    expect(texts(svg).count(text), 1, text)\n",
             SVG_FUNCTIONS, verdict_looks[VERDICT_FALLS].fill, verdict_looks[VERDICT_EXPLODES].fill,
             verdict_looks[VERDICT_SINKS].fill);
    run_python(program, temporary_folder);
}

/* Of nothing but what has no values, of one value, of zero and below, of forty decades. */
static void odd_borders_are_drawn(void **state) {
    (void)state;
    static const char *const rows[] = {"a,engine,,x,,,,not applicable\n", "a,engine,,x,,0,,settles\n",
                                       "a,engine,,x,m,-5,-5,falls\n",     "a,engine,,x,,1e-20,1e20,falls\n",
                                       "a,engine,,x,,-1e30,1e30,falls\n", "a,engine,,x,,3,3.0000001,falls\n"};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char borders[256];
        snprintf(borders, sizeof borders, BORDERS "%s", rows[i]);
        start_afresh(MAPS ONE_CELL, borders);
        draw();
    }
}

/* Nothing is drawn of a table that is refused. */
static void expect_refused(const char *maps, const char *borders, const char *message) {
    Error error = {0};
    start_afresh(maps, borders);
    assert_false(stability_figures_write(temporary_folder, &error));
    assert_error(error, ERROR_INPUT, message);
    assert_int_equal(access(temporary_path("borders.png"), F_OK), -1);
    assert_int_equal(access(temporary_path("map-stack.png"), F_OK), -1);
}

#define START "stack,engine,,a,,1,b,,"

static void maps_out_of_order_are_refused_with_their_place(void **state) {
    (void)state;
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {START "1,dances,,,,\n", "maps.csv:2:25: error: unknown verdict (got dances)"},
        {START "one,falls,,,,\n", "maps.csv:2:23: error: y must be a number"},
        {START ",falls,,,,\n", "maps.csv:2:23: error: y must be"},
        {START "inf,falls,,,,\n", "maps.csv:2:23: error: y must be"},
        {START "1,falls,1e9,,,\n", "maps.csv:2:31: error: frame cannot be 1e9"},
        {START "1,falls,,,\n", "maps.csv:2:1: error: 13 fields where the header has 14"},
        {"stack,\"engine';system('x')\",,a,,1,b,,1,falls,,,,\n", "maps.csv:2:7: error: method cannot be drawn"},
        {"../stack,engine,,a,,1,b,,1,falls,,,,\n", "maps.csv:2:1: error: '../stack' cannot be the name of a map"},
        {",engine,,a,,1,b,,1,falls,,,,\n", "maps.csv:2:1: error: '' cannot be the name of a map"},
        {START "1,falls,,,,\n" START "1,falls,,,,\n", "maps.csv:3:1: error: this cell was there before (a 1, b 1)"},
        {START "1,falls,,,,\nstack,engine,,c,,1,b,,2,falls,,,,\n", "maps.csv:3:1: error: other parameters"},
        {START "1,falls,,,,\nstack,nncg,,a,,1,b,,1,falls,,,,\n" START "2,falls,,,,\n",
         "maps.csv:4:1: error: this method of map stack was there before"},
        {START "1,falls,,,,\nother,nncg,,a,,1,b,,1,falls,,,,\n" START "2,falls,,,,\n",
         "maps.csv:4:1: error: map stack was there before"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char maps[1024];
        snprintf(maps, sizeof maps, MAPS "%s", cases[i].rows);
        expect_refused(maps, BORDERS ONE_BORDER, cases[i].message);
    }
    expect_refused("map,method\nstack,engine\n", BORDERS ONE_BORDER, "maps.csv:1:1: error: there is no column setting");
}

static void maps_too_large_are_refused(void **state) {
    (void)state;
    char *methods = make_map(25, 1, 1), *values = make_map(1, 1, 65);
    expect_refused(methods, BORDERS ONE_BORDER, "maps.csv:26:1: error: more than 24 methods");
    expect_refused(values, BORDERS ONE_BORDER, "maps.csv:66:1: error: more than 64 values");
    free(methods);
    free(values);
}

static void borders_out_of_order_are_refused_with_their_place(void **state) {
    (void)state;
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {"s,engine,,h,,one,2,falls\n", "stability.csv:2:14: error: holds_at must be a number"},
        {"s,engine,,h,,1,2,\n", "stability.csv:2:18: error: unknown verdict"},
        {"s,engine,,h,,1,2,settles\n", "stability.csv:2:1: error: 'settles' does not fit the values"},
        {"s,engine,,h,,,,settles\n", "stability.csv:2:1: error: 'settles' does not fit the values"},
        {"s,engine,,h,,,2,sways\n", "stability.csv:2:1: error: 'sways' does not fit the values"},
        {"s,engine,,h,,1,2,not applicable\n", "stability.csv:2:1: error: 'not applicable' cannot have a value"},
        {"s,engine,,h,,1,2,falls\ns,nncg,,h,m,1,2,falls\n", "stability.csv:3:1: error: another parameter than study s"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char borders[1024];
        snprintf(borders, sizeof borders, BORDERS "%s", cases[i].rows);
        expect_refused(MAPS ONE_CELL, borders, cases[i].message);
    }
}

int main(void) {
    temporary_path(""); /* makes the folder */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_verdict_has_its_tile),
        cmocka_unit_test(the_border_parts_holding_from_failing),
        cmocka_unit_test(cells_link_to_their_clips),
        cmocka_unit_test(axes_name_their_values),
        cmocka_unit_test(titles_are_cut_where_they_tell_the_least),
        cmocka_unit_test(many_methods_and_large_grids_are_drawn),
        cmocka_unit_test(the_same_tables_give_the_same_files),
        cmocka_unit_test(the_worse_the_darker),
        cmocka_unit_test(symbols_stand_out_and_differ),
        cmocka_unit_test(looks_are_those_of_the_verdicts),
        cmocka_unit_test(borders_are_drawn_as_the_table_has_them),
        cmocka_unit_test(bars_end_at_the_next_border),
        cmocka_unit_test(where_luck_decides_no_bar_is_drawn),
        cmocka_unit_test(a_table_without_rows_has_no_figure),
        cmocka_unit_test(odd_borders_are_drawn),
        cmocka_unit_test(maps_out_of_order_are_refused_with_their_place),
        cmocka_unit_test(maps_too_large_are_refused),
        cmocka_unit_test(borders_out_of_order_are_refused_with_their_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
