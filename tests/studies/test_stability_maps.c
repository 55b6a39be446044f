/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of maps, from synthetic tables. */
#include "stability_drawn.h"
#include "owned.h"

#include "pixels/type.h"
#include "studies/stability_internal.h"

/* One cell of each verdict, and one sample in the legend. */
TEST(each_verdict_has_its_tile) {
    char *maps = make_map(1, VERDICTS + 1, 1);
    start_afresh(maps, BORDERS ONE_BORDER);
    free(maps);
    draw();
    for (int look = 0; look < VERDICTS; look++)
        check_svg("expect(count(read('map-grid'), '#%06X'), 2, '%s')\n", verdict_looks[look].fill,
                  verdict_looks[look].name);
    check_svg("svg = read('map-grid')\n"
              "for text in ('settles', 'non-finite', 'not applicable', 'Height (boxes)', 'Ratio', 'engine:k=0'):\n"
              "    expect(texts(svg).count(text), 1, text)\n"
              "assert 'not run' not in texts(svg)\n");
}

/* Two edges: between two cells side by side, and between two cells one above the other, with a gap in their values.
   Missing and not applicable cells have no edges. */
TEST(the_border_separates_holding_from_failing) {
    start_afresh(MAPS "m,engine,,a,,1,b,,1,settles,,,,\nm,engine,,a,,2,b,,1,moves,,,,\nm,engine,,a,,3,b,,1,falls,,,,\n"
                      "m,engine,,a,,1,b,,2,moves,,,,\nm,engine,,a,,3,b,,2,sinks,,,,\n"
                      "m,engine,,a,,1,b,,5,explodes,,,,\nm,engine,,a,,2,b,,5,not applicable,,,,\n",
                 BORDERS ONE_BORDER);
    draw();
    check_svg("svg = read('map-m')\n"
              "expect(count(svg, '#000000'), 2 + 1, 'edges and their sample')\n"
              "for text in ('not run', 'not applicable', 'border of holding'):\n"
              "    expect(texts(svg).count(text), 1, text)\n");
}

#define CELLS(method, left, right) "m," method ",a,,1,b,,1," left ",,,,\nm," method ",a,,2,b,,1," right ",,,,\n"

/* The legend has the verdicts of the panels that stay, too. */
TEST(panels_without_a_border_are_left_out_and_named) {
    start_afresh(MAPS CELLS("engine,k=4", "settles", "falls") CELLS("interior,", "settles", "stands")
                     CELLS("momentum,", "moves", "falls") CELLS("pair-net,", "explodes", "falls")
                         CELLS("pair-net,net=off", "explodes", "not applicable")
                             CELLS("scene-net,", "not applicable", "not applicable"),
                 BORDERS ONE_BORDER);
    draw();
    check_svg("found, words = texts(read('map-m')), caption('map-m')\n"
              "for text in ('engine:k=4', 'momentum', 'settles', 'moves', 'falls'):\n"
              "    expect(found.count(text), 1, text)\n"
              "for text in ('interior', 'pair-net', 'scene-net', 'stands', 'explodes', 'not applicable'):\n"
              "    expect(found.count(text), 0, text)\n"
              "for text in ('Left out, as holding everywhere: interior.', 'Left out, as not applicable: scene-net.',\n"
              "             'Left out, as failing everywhere: pair-net, pair-net:net=off.'):\n"
              "    assert text in words, (text, words)\n");
}

TEST(without_any_border_all_panels_stay) {
    start_afresh(MAPS CELLS("engine,", "settles", "moves") CELLS("nncg,", "falls", "falls"), BORDERS ONE_BORDER);
    draw();
    check_svg("assert {'engine', 'nncg'} < set(texts(read('map-m'))), texts(read('map-m'))\n"
              "assert 'Left out' not in caption('map-m'), caption('map-m')\n");
}

/* The reference is first, and stays without a border; tiles have the number of boxes that fell. */
TEST(maps_of_struck_scenes_have_numbers_and_are_hatched) {
    start_afresh(MAPS "m,engine,,a,,1,b,,1,falls,9,2,3,boxes\nm,engine,,a,,2,b,,1,collapses,9,2,7,boxes\n"
                      "m,nncg,,a,,1,b,,1,stands,9,-1,0.5,m/s\nm,nncg,,a,,2,b,,1,stands,9,-1,0.5,m/s\n"
                      "m,reference,,a,,1,b,,1,stands,9,-1,0,m/s\nm,reference,,a,,2,b,,1,undecided,9,2,8,m\n",
                 BORDERS ONE_BORDER);
    draw();
    check_svg("svg = read('map-m')\n"
              "found = texts(svg)\n"
              "for text in ('3', '7', 'not as the reference', 'engine', 'nncg', 'reference'):\n"
              "    expect(found.count(text), 1, text)\n"
              "place = {t: float(re.search('translate[(]([^ ]*) [^>]*>' + t + '<', svg)[1]) for t in ('engine', "
              "'nncg', 'reference')}\n"
              "assert place['reference'] < place['engine'], place\n"
              "tile, = [a for a in areas(svg, '#EE9A2E') if a[2] - a[0] > 4]\n"
              "lines = re.findall('<path d=\"M([^\"LZ]*)L([^\"LZ]*)\" fill=\"none\" stroke=\"#[0-9A-F]{6}\"', svg)\n"
              "hatched = [line for line in lines if all(tile[0] - 0.1 <= float(p.split()[0]) <= tile[2] + 0.1 for p in "
              "line)]\n"
              "assert len(hatched) > 3 and len(lines) < 2 * len(hatched), (len(hatched), len(lines))\n");
}

/* Three panels are a row. */
TEST(no_place_of_three_panels_is_empty) {
    char *maps = make_map(3, 4, 4);
    start_afresh(maps, BORDERS ONE_BORDER);
    free(maps);
    draw();
    check_svg("root = tree.fromstring(read('map-grid'))\n"
              "titles = [t for t in root.iter('{http://www.w3.org/2000/svg}text') if t.text.startswith('engine:k=')]\n"
              "expect(len(titles), 3, 'titles')\nexpect(len({t.get('y') for t in titles}), 1, 'rows')\n");
}

/* Only the words that occur, each once. */
TEST(captions_explain_their_words) {
    start_afresh(MAPS CELLS("engine,k=4", "settles", "falls") CELLS("engine,\"k=50,warm=off\"", "moves", "falls")
                     CELLS("scene-net,net=off", "settles", "falls") CELLS("unknown,q=1", "settles", "falls"),
                 BORDERS "s,nncg,near=0.5,h,,1,2,falls\n");
    draw();
    check_svg("expect(caption('map-m').split('values. ')[1], 'engine: physics engine, sequential impulses; '\n"
              "       'scene-net: neural network for a scene; k: sweeps over all contacts per step; '\n"
              "       'warm: warm start from the previous step\\'s impulses; net=off: without its learned part.\\n', "
              "'words')\n"
              "expect(caption('borders').split(' first. ')[1], 'nncg: conjugate gradients over sweeps; '\n"
              "       'near: sweeps go on while contacts miss their velocity by this, m/s.\\n', 'words')\n");
}

/* A path of 119 bytes, and characters that are special in SVG; 128 bytes are too many. */
TEST(settings_may_be_paths) {
    char setting[200], maps[1024], borders[1024];
    snprintf(setting, sizeof setting, "network=%0*d/<it's>/net.npz", 103, 0);
    snprintf(maps, sizeof maps, MAPS "m,pair-net,%s,a,,1,b,,2,falls,,,,\n", setting);
    snprintf(borders, sizeof borders, BORDERS "stack,pair-net,%s,height,boxes,10,11,falls\n", setting);
    start_afresh(maps, borders);
    draw();
    check_svg("svg = read('map-m')\n"
              "expect(texts(svg).count('pair-net:network=net.npz'), 1, 'title')\n"
              "expect(texts(read('borders')).count('pair-net:network=net.npz'), 1, 'label')\n");
    snprintf(maps, sizeof maps, MAPS "m,pair-net,%0128d,a,,1,b,,2,falls,,,,\n", 0);
    expect_refused(maps, BORDERS ONE_BORDER, "maps.csv:2:12: error: setting: '");
}

/* For any order of the rows and any distances of the values: ascending, one tic each. */
TEST(axes_name_their_values) {
    start_afresh(MAPS "m,engine,,rate,Hz,480,b_c,,1,falls,,,,\nm,engine,,rate,Hz,20,b_c,,1,falls,,,,\n"
                      "m,engine,,rate,Hz,30.5,b_c,,0.125,falls,,,,\nm,engine,,rate,Hz,20,b_c,,-7,falls,,,,\n",
                 BORDERS ONE_BORDER);
    draw();
    check_svg("found = texts(read('map-m'))\n"
              "at = [found.index(text) for text in ('-7', '0.125', '1', '20', '30.5', '480')]\n"
              "assert at == sorted(at), found\n"
              "assert 'Rate (Hz)' in found and 'B c' in found, found\n");
}

/* Whole, without the folders of files. */
TEST(titles_are_names_and_settings) {
    static const struct {
        const char *method, *setting, *text;
    } cases[] = {{"engine", "", "engine"},
                 {"engine", "k=10,warm=off", "engine:k=10,warm=off"},
                 {"scene-net", "network=../of/networks/a-b.npz,k=4", "scene-net:network=a-b.npz,k=4"},
                 {"scene-net", "k=4,network=<it's>.npz", "scene-net:k=4,network=?it?s?.npz"},
                 {"pair-net", "network=a-long-name-of-a-network.npz", "pair-net:network=a-long-name-of-a-network.npz"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[STABILITY_TEXT_SIZE];
        stability_method_text(text, cases[i].method, cases[i].setting);
        assert_string_equal(text, cases[i].text);
    }
}

#define START "stack,engine,,a,,1,b,,"

TEST(invalid_maps_are_refused_with_their_place) {
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {START "1,dances,,,,\n", "maps.csv:2:25: error: verdict: 'dances' is not one of settles, stands"},
        {"stack,\"engine';system('x')\",,a,,1,b,,1,falls,,,,\n",
         "maps.csv:2:7: error: method: 'engine';system('x')' may only have"},
        {"../stack,engine,,a,,1,b,,1,falls,,,,\n", "maps.csv:2:1: error: map: '../stack' is not a file name"},
        {",engine,,a,,1,b,,1,falls,,,,\n", "maps.csv:2:1: error: map: '' is not a file name"},
        {START "1,falls,,,,\n" START "1,falls,,,,\n", "maps.csv:3:1: error: the cell appears twice (a 1, b 1)"},
        {START "1,falls,,,,\nstack,engine,,c,,1,b,,2,falls,,,,\n", "maps.csv:3:1: error: the parameters differ"},
        {START "1,falls,,,,\nstack,nncg,,a,,1,b,,1,falls,,,,\n" START "2,falls,,,,\n",
         "maps.csv:4:1: error: the rows of this method of map 'stack' are not together"},
        {START "1,falls,,,,\nother,nncg,,a,,1,b,,1,falls,,,,\n" START "2,falls,,,,\n",
         "maps.csv:4:1: error: the rows of map 'stack' are not together"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(printed(MAPS "%s", cases[i].rows), BORDERS ONE_BORDER, cases[i].message);
    }
}

TEST(maps_too_large_are_refused) {
    FREED char *methods = make_map(25, 1, 1), *values = make_map(1, 1, 129);
    expect_refused(methods, BORDERS ONE_BORDER, "maps.csv:26:1: error: more than 24 methods");
    expect_refused(values, BORDERS ONE_BORDER, "maps.csv:130:1: error: more than 128 values");
}

int main(void) {
    temporary_path(""); /* makes the folder */
    return _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
}
