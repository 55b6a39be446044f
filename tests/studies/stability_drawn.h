/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Synthetic tables of a stability study, and their figures. */
#pragma once
#include "python.h"

#include "studies/stability.h"

#include "base/file.h"

#include <sys/stat.h>

#define MAPS "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,frame,body,value,unit\n"
#define BORDERS "study,method,setting,parameter,unit,holds_at,fails_at,verdict\n"
#define UNCONVERGED \
    "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,steps,not_converged,residual\n"
#define ONE_CELL "stack,engine,k=10,ratio,,1,height,boxes,2,falls,100,1,0.5,m\n"
#define ONE_BORDER "stack,engine,k=10,height,boxes,10,11,falls\n"

static inline void write_table(const char *name, const char *text) {
    Error error = {0};
    assert_ok(file_write_soon(temporary_path(name), text, strlen(text), &error), error);
}

static inline void start_afresh(const char *maps, const char *borders) {
    remove_temporary_folder();
    assert_int_equal(mkdir(temporary_folder, 0700), 0);
    write_table("maps.csv", maps);
    write_table("stability.csv", borders);
    write_table("unconverged.csv", UNCONVERGED);
}

static inline void draw(void) {
    Error error = {0};
    assert_ok(stability_figures_write(temporary_folder, NULL, NULL, &error), error);
}

/* Defines areas(svg, "#RRGGBB"): filled areas of a colour, each [left, top, right, bottom] in mm; count(svg,
   "#RRGGBB"); texts(svg); caption(name); and cells("Title", colour): the parts of this colour in a row of the borders
   figure, from the left; holds, falls, ...: colours. */
#define SVG_FUNCTIONS                                                                                          \
    "import sys, re, xml.etree.ElementTree as tree\n"                                                          \
    "def read(name): return open(sys.argv[1] + '/' + name + '.svg').read()\n"                                  \
    "def caption(name): return open(sys.argv[1] + '/' + name + '.txt').read()\n"                               \
    "def areas(svg, colour):\n"                                                                                \
    "    paths = re.findall('<path d=\"M([^\"]*)Z\" fill=\"%s\"' % colour, svg)\n"                             \
    "    corners = [[tuple(map(float, p.split())) for p in path.split('L')] for path in paths]\n"              \
    "    return [[min(x), min(y), max(x), max(y)] for x, y in (zip(*c) for c in corners if len(c) == 4)]\n"    \
    "def count(svg, colour): return len(areas(svg, colour))\n"                                                 \
    "def texts(svg):\n"                                                                                        \
    "    found = tree.fromstring(svg).iter('{http://www.w3.org/2000/svg}text')\n"                              \
    "    return [' '.join(''.join(e.itertext()).split()) for e in found]\n"                                    \
    "holds, falls, sinks, explodes, pale = '#A3CBE5', '#EE9A2E', '#CF6414', '#6E1650', '#F2F0E6'\n"            \
    "def cells(title, colour):\n"                                                                              \
    "    svg = read('borders')\n"                                                                              \
    "    y = float(re.search('<text transform=\"translate[(][^ ]* ([^)]*)[)][^>]*>' + title + '<', svg)[1])\n" \
    "    return sorted(area for area in areas(svg, colour) if area[1] < y < area[3])\n"                        \
    "def expect(found, wanted, what):\n"                                                                       \
    "    assert found == wanted, (what, found, wanted)\n"

/* Runs a program with these functions on the figures. */
static inline void check_svg(const char *format, ...) PRINTF_LIKE(1, 2);
static inline void check_svg(const char *format, ...) {
    char program[8192];
    va_list arguments;
    strcpy(program, SVG_FUNCTIONS);
    va_start(arguments, format);
    vsnprintf(program + strlen(program), sizeof program - strlen(program), format, arguments);
    va_end(arguments);
    run_python(program, temporary_folder);
}

/* Nothing is drawn of an invalid table. */
static inline void expect_refused(const char *maps, const char *borders, const char *message) {
    Error error = {0};
    start_afresh(maps, borders);
    assert_refused(stability_figures_write(temporary_folder, NULL, NULL, &error), message);
    assert_int_equal(access(temporary_path("borders.png"), F_OK), -1);
    assert_int_equal(access(temporary_path("map-stack.png"), F_OK), -1);
}

/* A map of methods x `across` x `up` cells of the verdicts in turn. */
static inline char *make_map(int methods, int across, int up) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fputs(MAPS, file);
    for (int method = 0; method < methods; method++)
        for (int cell = 0; cell < across * up; cell++)
            fprintf(file, "grid,engine,k=%d,ratio,,%g,height,boxes,%d,%s,,,,\n", method, pow(10, cell % across),
                    3 + cell / across, verdict_words[cell % CELL_MISSING]);
    assert_int_equal(fclose(file), 0);
    return text;
}
