/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of errors at equal time, of an invented chart. */
#include "python.h"

#include "studies/chart_table.h"
#include "studies/equal_time.h"

#define SAMPLE SOURCE_DIR "/tests/studies/equal_time.csv"

static const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

/* All runs of block are unstable; the ratio of net=off in the wall is 5100 / 0.2, of momentum in the tall scene 0.584 /
   0.001. */
TEST(learned_methods_stand_beside_their_twins) {
    EqualTimeFigure figure;
    assert_ok(equal_time_plot(SAMPLE, folder(), &figure, &error), error);
    assert_true(figure.drawn);
    assert_string_equal(figure.left_out.text, "block");
    run_python(
        "import sys, xml.etree.ElementTree as tree\n"
        "root = tree.parse(sys.argv[1]).getroot()\n"
        "texts = [''.join(e.itertext()).strip() for e in root.iter('{http://www.w3.org/2000/svg}text')]\n"
        "texts = [t for t in texts if t]\n"
        "rows = ['×20', '×20', '1/20', '×10', '×50'] + ['×2.0', '1/2.0', '–', '1', '>', '10', '4'] + ['×580', "
        "'1/580']\n"
        "names = 'engine|momentum|interior|scene-|net|scene-|net|net=off'.split('|')\n"
        "assert texts[:len(rows + names) + 3] == rows + names + ['tower', 'wall', 'tall'], texts\n"
        /* The cells are the column ratio of the table beside the figure, in two digits. */
        "import collections, csv\n"
        "def cell(ratio):\n"
        "    most = max(ratio, 1 / ratio)\n"
        "    number = f'{float(f\"{most:.2g}\"):.{1 if most < 9.95 else 0}f}'\n"
        "    return '1' if most < 1.05 else ('1/' if ratio < 1 else '×') + number\n"
        "table = csv.DictReader(open(sys.argv[1][:-4] + '_methods.csv'))\n"
        "cells = collections.Counter(cell(float(row['ratio'])) for row in table if row['ratio'] and "
        "float(row['ratio']) < 9e3)\n"
        "assert len(cells) > 5 and not cells - collections.Counter(texts), (cells, texts)\n"
        "assert 'left out: block' in texts, texts\n"
        "for wanted in ('in the time of momentum with 50 sweeps per step', '– slower, or unstable before the impact',\n"
        "               'white: both below 0.0001 m/s'):\n"
        "    assert texts.count(wanted) == 1, (wanted, texts)\n"
        "assert not any('block:' in text.replace('out: block', '') or 'nncg' in text or '…' in text for text in "
        "texts), texts\n"
        "caption = open(sys.argv[1][:-3] + 'txt', encoding='utf-8').read()\n"
        "for wanted in (' rival: any other method without a network;', ' Left out, as without a ratio: block.',\n"
        "               ' interior: interior-point steps;', ' scene-net: neural network for a scene;',\n"
        "               ' net=off: without its learned part.'):\n"
        "    assert caption.count(wanted) == 1, (wanted, caption)\n",
        temporary_path("equal_time.svg"));
}

/* One method alone has no rival: there are tables, but no figure. */
TEST(a_method_without_rivals_has_no_figure) {
    EqualTimeFigure figure = {.drawn = true};
    const char *path = temporary_path("alone.csv");
    CsvTable chart;
    assert_ok(csv_table_read(&chart, SAMPLE, &chart_layout, &error), error);
    assert_ok(csv_table_write(path, &chart_layout, chart.rows, 1, &error), error);
    csv_table_free(&chart);
    assert_ok(equal_time_plot(path, folder(), &figure, &error), error);
    assert_false(figure.drawn);
}

RUN_TESTS(NULL, NULL)
