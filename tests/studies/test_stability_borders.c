/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The borders figure, from synthetic tables; and what it has in common with maps. */
#include "files.h"
#include "stability_drawn.h"

#include "pixels/type.h"

TEST(borders_are_drawn_as_in_the_table) {
    start_afresh(MAPS ONE_CELL,
                 BORDERS "height,engine,k=10,height,boxes,10,11,falls\nheight,momentum,,height,boxes,15,16,falls\n"
                         "height,momentum,,height,boxes,20,19,sinks\nheight,nncg,,height,boxes,40,,settles\n"
                         "height,pair-net,,height,boxes,,2,explodes\nheight,scene-net,,height,boxes,,,not applicable\n"
                         "time_step,engine,k=10,rate,Hz,60,50,falls\ntime_step,nncg,,rate,Hz,20,,creeps\n"
                         "time_step,scene-net,,rate,Hz,60,50,falls\n");
    draw();
    check_svg(
        "svg = read('borders')\n"
        "expect(count(svg, '#A3CBE5'), 4 + 3 + 2, 'bars')\n"
        "expect(count(svg, '#%06X'), 4 + 1, 'falls')\nexpect(count(svg, '#%06X'), 1 + 1, 'explodes')\n"
        "expect(count(svg, '#%06X'), 1 + 1, 'sinks')\n"
        "for text in ('Height', 'Stack at long steps', 'Rate (Hz)', 'engine:k=10', 'never holds', 'not applicable'):\n"
        "    expect(texts(svg).count(text), 1, text)\n",
        verdict_looks[VERDICT_FALLS].fill, verdict_looks[VERDICT_EXPLODES].fill, verdict_looks[VERDICT_SINKS].fill);
}

/* A method that holds to 15, fails from 16 to 19, holds from 20 to 25 and fails from 26: no bar where it fails. The
   other method holds throughout; its bar shows the panel's width. */
TEST(bars_end_at_the_next_border) {
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,15,16,falls\na,engine,,h,,20,19,sinks\na,engine,,h,,25,26,falls\n"
                                        "a,nncg,,h,,30,,settles\n");
    draw();
    check_svg("ends = [[bar[0], bar[2]] for bar in areas(read('borders'), '#A3CBE5')][:4]\n"
              "left, right = ends[3]\n"
              "expect(ends[1], ends[2], 'both bars of what holds from 20 to 25')\n"
              "assert left == ends[0][0] < ends[0][1] < ends[1][0] < ends[1][1] < right, ends\n");
}

/* Undecided beyond 30 to the end of the range: the bar ends there and the tile is at the far end, which is the left one
   if smaller values are harder. All values of b are undecided. */
TEST(undecided_values_have_no_bar) {
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,30,,falls\na,nncg,,h,,20,40,sinks\nb,engine,,r,,,,falls\n"
                                        "b,nncg,,r,,60,50,sinks\nc,engine,,r,,60,,falls\nc,nncg,,r,,80,50,sinks\n");
    draw();
    check_svg("def ends(colour): return [[area[0], area[2]] for area in areas(read('borders'), colour)]\n"
              "bars, falls, sinks = ends('#A3CBE5'), ends('#EE9A2E'), ends('#CF6414')\n"
              "expect(len(bars), 2 + 1 + 2 + 2, 'bars and their samples')\n"
              "assert bars[0][1] < falls[0][0] and bars[0][0] == bars[1][0], (bars, falls)\n"
              "assert sinks[0][1] <= falls[0][0], 'the far end is beyond the last value'\n"
              "assert falls[2][1] < sinks[2][0] + 0.4 < bars[3][0] < bars[4][0], (bars, falls, sinks)\n");
}

/* A method that no study applies to has no row; one that some study applies to has. */
TEST(methods_that_do_not_apply_are_left_out_and_named) {
    start_afresh(MAPS ONE_CELL, BORDERS
                 "a,pair-net,,h,,,,not applicable\na,scene-net,net=off,h,,,,not applicable\na,engine,,h,,3,4,falls\n"
                 "b,pair-net,,h,,,,not applicable\nb,scene-net,net=off,h,,,,not applicable\n"
                 "b,engine,,h,,,,not applicable\n");
    draw();
    check_svg("found = texts(read('borders'))\n"
              "assert 'engine' in found and 'not applicable' in found, found\n"
              "assert not any('-net' in text for text in found if not text.startswith('Left out')), found\n"
              "assert 'Left out, as not applicable: pair-net, scene-net:net=off.' in caption('borders')\n");
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,3,4,falls\na,pair-net,,h,,,1,falls\n");
    draw();
    check_svg("assert 'pair-net' in texts(read('borders'))\n"
              "assert 'Left out' not in caption('borders') and 'not applicable' not in texts(read('borders'))\n");
}

/* The numbers below a panel: text with a place from the left. */
#define NUMBERS                                               \
    "def number(text):\n"                                     \
    "    try: return float(text)\n"                           \
    "    except ValueError: return None\n"                    \
    "numbers = [number(t) for t in texts(read('borders'))]\n" \
    "numbers = [n for n in numbers if n is not None]\n"

/* Heights of the study are 2 to 40, on a linear scan; of its rows, 11 to 16. */
TEST(an_axis_has_the_range_of_its_study) {
    start_afresh(MAPS ONE_CELL, BORDERS "stack_height,engine,,height,boxes,11,16,falls\n");
    draw();
    check_svg(NUMBERS "expect(sorted(numbers), [2] + list(range(5, 41, 5)), 'numbers')\n");
    start_afresh(MAPS ONE_CELL, BORDERS "time_step,engine,,rate,Hz,51,49,falls\n");
    draw();
    check_svg(NUMBERS "expect((min(numbers), max(numbers)), (20, 480), 'ends')\n");
    /* The name of a study, but another parameter: another program's, whose range is not known. */
    start_afresh(MAPS ONE_CELL, BORDERS "stack_height,engine,,depth,boxes,11,16,falls\n");
    draw();
    check_svg(NUMBERS "assert 7 < min(numbers) and max(numbers) < 25, numbers\n"
                      "assert 'Stack height' in texts(read('borders'))\n");
}

#define UNCONVERGED_RUN(map, method, x, y, rest) map "," method ",,h,," x ",v,," y ",settles," rest "\n"

/* Once for all methods, with what all values have together; a map names both values. */
TEST(where_the_reference_did_not_converge_is_named) {
    start_afresh(MAPS "m,engine,,h,,2,v,,3,settles,,,,\nm,engine,,h,,2,v,,4,falls,,,,\n",
                 BORDERS "s,engine,,h,,1,2,falls\ns,nncg,,h,,1,2,falls\nt,nncg,,h,,1,2,falls\n");
    draw();
    check_svg("for name in ('borders', 'map-m'):\n"
              "    assert 'converge' not in caption(name) + str(texts(read(name))), caption(name)\n");
    write_table("unconverged.csv", UNCONVERGED UNCONVERGED_RUN("s", "engine", "2", "", "100,7,2e-08,3")
                                       UNCONVERGED_RUN("s", "engine", "5", "", "300,1,0.02,")
                                           UNCONVERGED_RUN("s", "nncg", "2", "", "100,7,2e-08,3")
                                               UNCONVERGED_RUN("m", "engine", "2", "4", "50,50,,1"));
    draw();
    check_svg("for name, where in (('borders', 's at h 2, 5 (8 of 400 steps, residual up to 0.02 m/s).'),\n"
              "                    ('map-m', 'm at h/v 2/4 (50 of 50 steps, residual not finite).')):\n"
              "    line = 'The reference did not converge: ' + where\n"
              "    assert any(text[:40] == line[:40] for text in texts(read(name))), name\n"
              "    expect(caption(name).count('%s ' + line), 1, name)\n",
              stability_unconverged_words);
}

/* Of a scene file: "Scene high, by height", and not the name of the study. */
TEST(studies_of_a_scene_have_their_range_and_title) {
    const char *scene = temporary_path("high.yaml"), *const vary[] = {"height=3:30", "bomb_mass"};
    StabilityOwn own;
    start_afresh(MAPS ONE_CELL, BORDERS "high_height,engine,,height,boxes,11,16,falls\n"
                                        "high_bomb_mass,engine,,bomb_mass,kg,5,6,falls\n");
    write_table("high.yaml", "parameters:\n  height: {value: 5, from: 1, to: 50, unit: boxes, whole: on}\n"
                             "  bomb_mass: {value: 5, from: 1, to: 50, unit: kg}\n"
                             "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 60\nbodies:\n"
                             "  - {static: true, size: [100, 20], position: [0, -10]}\n"
                             "  - {pattern: stack, count: $height, spacing: [0, 1], mass: $bomb_mass, size: [1, 1], "
                             "position: [0, 0.5]}\n");
    assert_ok(stability_own_make(&own, scene, vary, 2, true, &error), error);
    assert_ok(stability_figures_write(temporary_folder, &own, NULL, &error), error);
    check_svg(NUMBERS
              "assert {3, 30, 1, 50} < set(numbers), numbers\n"
              "for text in ('Scene high, by height', 'Scene high, by bomb mass', 'Height (boxes)', 'Bomb mass (kg)'):\n"
              "    expect(texts(read('borders')).count(text), 1, text)\n");
}

/* In the columns of a full figure, 32 mm wide. A title is no name of a table. */
TEST(titles_of_studies_fit_and_read_as_English) {
    for (int i = 0; i < stability_study_count; i++) {
        const char *title = stability_studies[i].title;
        if (!(type_width(title, 8) < 32)) fail_msg("'%s' is %.3g mm wide", title, type_width(title, 8));
        assert_true(title[0] >= 'A' && title[0] <= 'Z' && strchr(title, '_') == NULL);
    }
}

/* Only rows without values; one value; zero and negative values; forty decades. */
TEST(unusual_ranges_are_drawn) {
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

TEST(invalid_borders_are_refused_with_their_place) {
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {"s,engine,,h,,one,2,falls\n", "stability.csv:2:14: error: holds_at: 'one' is not a number"},
        {"s,engine,,h,,1,2,\n", "stability.csv:2:18: error: verdict: the field is empty"},
        {"s,engine,,h,,1,2,settles\n", "stability.csv:2:1: error: 'settles' contradicts the values"},
        {"s,engine,,h,,,,settles\n", "stability.csv:2:1: error: 'settles' contradicts the values"},
        {"s,engine,,h,,,2,moves\n", "stability.csv:2:1: error: 'moves' contradicts the values"},
        {"s,engine,,h,,1,2,not applicable\n", "stability.csv:2:1: error: 'not applicable' cannot have values"},
        {"s,engine,,h,,1,2,falls\ns,nncg,,h,m,1,2,falls\n",
         "stability.csv:3:1: error: the study 's' had another parameter before"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char borders[1024];
        snprintf(borders, sizeof borders, BORDERS "%s", cases[i].rows);
        expect_refused(MAPS ONE_CELL, borders, cases[i].message);
    }
}

static char *read_file(const char *name, size_t *size) { return read_whole(temporary_path(name), size); }

TEST(the_same_tables_give_the_same_files) {
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

/* Borders without maps, and maps without borders. */
TEST(a_table_without_rows_has_no_figure) {
    start_afresh(MAPS, BORDERS ONE_BORDER);
    draw();
    assert_int_equal(access(temporary_path("borders.png"), R_OK), 0);
    start_afresh(MAPS ONE_CELL, BORDERS);
    draw();
    assert_int_equal(access(temporary_path("borders.png"), F_OK), -1);
    assert_int_equal(access(temporary_path("map-stack.png"), R_OK), 0);
}

int main(void) {
    temporary_path(""); /* makes the folder */
    return _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
}
