/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The borders figure, from synthetic tables; and what it has in common with maps. */
#include "stability_drawn.h"

#include "pixels/type.h"

/* Methods are rows of a few studies, sorted by what holds. Range of the heights: 2 to 40. */
TEST(borders_are_drawn_as_in_the_table) {
    start_afresh(MAPS ONE_CELL,
                 BORDERS "height,engine,k=10,height,boxes,10,11,falls\nheight,momentum,,height,boxes,15,16,falls\n"
                         "height,momentum,,height,boxes,20,19,sinks\nheight,nncg,,height,boxes,40,,settles\n"
                         "height,pair-net,,height,boxes,,2,explodes\nheight,scene-net,,height,boxes,,,not applicable\n"
                         "time_step,engine,k=10,rate,Hz,60,50,falls\ntime_step,nncg,,rate,Hz,20,,moves\n"
                         "time_step,scene-net,,rate,Hz,60,50,falls\n");
    draw();
    check_svg("svg = read('borders')\n"
              "for name, parts in (('nncg', [2, 0, 0, 0]), ('engine:k=10', [2, 2, 0, 0]), ('momentum', [2, 1, 1, 0]),\n"
              "                    ('scene-net', [1, 1, 0, 0]), ('pair-net', [0, 0, 0, 1])):\n"
              "    expect([len(cells(name, c)) for c in (holds, falls, sinks, explodes)], parts, name)\n"
              "for text in ('Height', 'Stack at long steps', '480 to 20 Hz', 'not applicable', '15'):\n"
              "    expect(texts(svg).count(text), 1, text)\n"
              "names = [t for t in texts(svg) if t in ('nncg', 'momentum', 'engine:k=10', 'pair-net', 'scene-net')]\n"
              "expect(names, ['nncg', 'engine:k=10', 'momentum', 'scene-net', 'pair-net'], 'order')\n");
}

/* A method that holds to 15, fails from 16 to 19, holds from 20 to 25 and fails from 26, in a range of 15 to 30; the
   other holds throughout. Between 15 and 16 it is undecided. */
TEST(parts_end_at_the_borders) {
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,15,16,falls\na,engine,,h,,20,19,sinks\na,engine,,h,,25,26,falls\n"
                                        "a,nncg,,h,,30,,settles\n");
    draw();
    check_svg("(left, _, right, _), = cells('nncg', holds)\n"
              "def ends(colour):\n"
              "    return [[round((x - left) / (right - left) * 15 + 15, 1) for x in (part[0], part[2])]\n"
              "            for part in cells('engine', colour)]\n"
              "expect(ends(holds), [[15, 15], [20, 25]], 'holds')\n"
              "expect(ends(falls), [[16, 17.5], [26, 30]], 'falls')\n"
              "expect(ends(sinks), [[17.5, 19]], 'sinks')\n"
              "expect(ends(pale), [[15, 30]], 'undecided, below the others')\n");
}

/* 14 boxes stand and 15 fall: nothing is undecided. A range of 2 to 40 boxes. */
TEST(between_neighbours_nothing_is_undecided) {
    start_afresh(MAPS ONE_CELL, BORDERS "stack_height,engine,,height,boxes,14,15,falls\n");
    draw();
    check_svg("expect(cells('engine', holds)[0][2], cells('engine', falls)[0][0], 'parts')\n"
              "expect('undecided' in texts(read('borders')), False, 'legend')\n");
}

/* Undecided beyond 30 to the end of the range, which is the left one if smaller values are harder; all values of b. */
TEST(undecided_values_are_pale) {
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,h,,30,,falls\na,nncg,,h,,20,40,sinks\nb,engine,,r,,,,falls\n"
                                        "b,nncg,,r,,60,50,sinks\nc,engine,,r,,60,,falls\nc,nncg,,r,,80,50,sinks\n");
    draw();
    check_svg("expect((len(cells('engine', falls)), len(cells('nncg', sinks))), (0, 3), 'fails')\n"
              "shares = [sum(part[2] - part[0] for part in cells('engine', holds) if cell[0] <= part[0] < cell[2])\n"
              "          / (cell[2] - cell[0]) for cell in cells('engine', pale)]\n"
              "expect(sorted(round(share, 2) for share in shares), [0, 0.5, 0.67], 'shares')\n"
              "expect(texts(read('borders')).count('undecided'), 1, 'legend')\n");
}

/* Of more studies than three, methods are columns. The reference is first; as far as it holds counts, not the whole
   range. A study without it counts over the whole range. */
TEST(methods_are_counted_beside_the_reference) {
    start_afresh(MAPS ONE_CELL,
                 BORDERS "a,engine,,h,,10,20,falls\na,nncg,,h,,20,30,falls\na,reference,,h,,20,30,falls\n"
                         "b,engine,,h,,2,3,falls\nb,nncg,,h,,9,10,falls\nc,nncg,,h,,1,2,falls\n"
                         "d,nncg,,h,,3,,settles\n");
    draw();
    check_svg("found = texts(read('borders'))\n"
              "names = [t for t in found if t in ('reference', 'nncg', 'engine')]\n"
              "expect(names, ['reference', 'nncg', 'engine'], 'order')\n"
              "at = found.index('As far as the reference, of 4')\n"
              "expect(found[at + 1:at + 3], ['2', '0'], 'counts')\n");
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

/* Heights of the study are 2 to 40, rates 480 to 20; of its rows, 11 to 16. Names with parameters that the study does
   not have are another program's. */
TEST(a_range_is_that_of_its_study) {
    static const struct {
        const char *row, *range, *title;
    } cases[] = {{"stack_height,engine,,height,boxes,11,16,falls\n", "2 to 40 boxes", "Stack"},
                 {"time_step,engine,,rate,Hz,51,49,falls\n", "480 to 20 Hz", "Stack at long steps"},
                 {"stack_height,engine,,depth,,11,16,falls\n", "depth 11 to 16", "Stack height"},
                 {"x,engine,,y,m,-1,-2.5,falls\n", "−1 to −2.5 m", "X"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *borders = printed(BORDERS "%s", cases[i].row);
        start_afresh(MAPS ONE_CELL, borders);
        draw();
        check_svg("found = texts(read('borders'))\nassert '%s' in found and '%s' in found, found\n", cases[i].range,
                  cases[i].title);
    }
}

#define STRUCK "a,engine,,m,,12,13,collapses\na,reference,,m,,20,21,falls\n"

/* The engine falls from 13 on, the reference from 21 on, as nncg does; momentum explodes there and admm stands. */
TEST(what_is_not_as_the_reference_is_hatched) {
    static const char strokes[] =
        "def strokes(title):\n"
        "    (left, low, right, high), = [c for c in cells(title, pale)]\n"
        "    lines = re.findall('<path d=\"M([^\"LZ]*)L([^\"LZ]*)\" fill=\"none\" stroke=\"#[0-9A-F]{6}\"', svg)\n"
        "    x = [float(end.split()[0]) for line in lines for end in line\n"
        "         if all(low - 0.01 <= float(p.split()[1]) <= high + 0.01 for p in line)]\n"
        "    x = [12 + 18 * (each - left) / (right - left) for each in x]\n"
        "    return [round(min(x)), round(max(x))] if x else []\n";
    start_afresh(MAPS ONE_CELL, BORDERS STRUCK "a,nncg,,m,,20,21,falls\na,momentum,,m,,20,21,explodes\n"
                                               "a,admm,,m,,30,,stands\n");
    draw();
    check_svg("svg = read('borders')\n%s"
              "for name, part in (('engine', [13, 20]), ('nncg', []), ('momentum', [21, 30]), ('admm', [21, 30])):\n"
              "    expect(strokes(name), part, name)\n"
              "expect(texts(svg).count('not as the reference'), 1, 'legend')\n"
              "expect([t for t in texts(svg) if t in ('engine', 'reference', 'admm')], ['reference', 'admm', "
              "'engine'], 'order')\n"
              "assert '%s' in caption('borders')\n",
              strokes, stability_struck_words);
    /* What was not struck is not compared. */
    start_afresh(MAPS ONE_CELL, BORDERS "a,engine,,m,,12,13,falls\na,reference,,m,,20,21,falls\n");
    draw();
    check_svg("expect(texts(read('borders')).count('not as the reference'), 0, 'legend')\n"
              "assert '%s' not in caption('borders')\n",
              stability_struck_words);
}

#define UNCONVERGED_RUN(map, method, x, y, rest) map "," method ",,h,," x ",v,," y ",settles," rest "\n"

/* Once for all methods, with what all values have together; a map names both values. */
TEST(where_the_reference_did_not_converge_is_named) {
    start_afresh(MAPS "m,engine,,h,,2,v,,3,settles,,,,\nm,engine,,h,,2,v,,4,falls,,,,\n",
                 BORDERS "s,engine,,h,,1,2,falls\ns,nncg,,h,,1,2,falls\nt,nncg,,h,,1,2,falls\n");
    draw();
    check_svg("for name in ('borders', 'map-m'):\n"
              "    assert 'converge' not in caption(name) + str(texts(read(name))), caption(name)\n");
    write_table("unconverged.csv", UNCONVERGED UNCONVERGED_RUN("s", "engine", "2", "", "100,7,0.02")
                                       UNCONVERGED_RUN("s", "engine", "5", "", "300,1,2e-08")
                                           UNCONVERGED_RUN("s", "nncg", "2", "", "100,7,2e-08")
                                               UNCONVERGED_RUN("m", "engine", "2", "4", "50,50,"));
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
    check_svg("for text in ('Scene high, by height', 'Scene high, by bomb mass', '3 to 30 boxes', '1 to 50 kg'):\n"
              "    expect(texts(read('borders')).count(text), 1, text)\n");
}

/* Beside its range, in less than half of the page. A title is no name of a table. */
TEST(titles_of_studies_fit_and_read_as_English) {
    for (int i = 0; i < stability_study_count; i++) {
        const char *title = stability_studies[i].title;
        if (!(type_width(title, 8) < 32)) fail_msg("'%s' is %.3g mm wide", title, type_width(title, 8));
        assert_true(title[0] >= 'A' && title[0] <= 'Z' && strchr(title, '_') == NULL);
    }
}

TEST(invalid_borders_are_refused_with_their_place) {
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {"s,engine,,h,,1,2,settles\n", "stability.csv:2:1: error: 'settles' contradicts the values"},
        {"s,engine,,h,,,,settles\n", "stability.csv:2:1: error: 'settles' contradicts the values"},
        {"s,engine,,h,,,2,moves\n", "stability.csv:2:1: error: 'moves' contradicts the values"},
        {"s,engine,,h,,1,2,not applicable\n", "stability.csv:2:1: error: 'not applicable' cannot have values"},
        {"s,engine,,h,,1,2,falls\ns,nncg,,h,m,1,2,falls\n",
         "stability.csv:3:1: error: the study 's' had another parameter before"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(MAPS ONE_CELL, printed(BORDERS "%s", cases[i].rows), cases[i].message);
    }
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
