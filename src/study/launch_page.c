/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/launch_page.h"

#include <limits.h>
#include <math.h>

/* Phases with points: impact and after. */
static const char *const phase_words[] = {"impact", "after", NULL};

#define TEXT(member, size) \
    { #member, CSV_TEXT, .offset = offsetof(LaunchPage, member), .maximum = (size)-1 }
#define COUNT(member, least) \
    { #member, CSV_INTEGER, .offset = offsetof(LaunchPage, member), .minimum = least, .maximum = INT_MAX }
#define NUMBER(member, kind, most)                                                                                    \
    {                                                                                                                 \
#member, kind, .offset = offsetof(LaunchPage, member), .minimum = -(double)(most), .maximum = (double)(most), \
                       .digits = 9                                                                                    \
    }
#define ERROR(member) \
    { #member, CSV_NUMBER, .offset = offsetof(LaunchPage, member), .maximum = INFINITY }

static const CsvColumn columns[] = {
    TEXT(scene, CHART_NAME_SIZE),
    TEXT(method, CHART_NAME_SIZE),
    TEXT(setting, CHART_SETTING_SIZE),
    {"phase", CSV_WORD, .offset = offsetof(LaunchPage, phase), .words = phase_words},
    COUNT(launch, 1),
    NUMBER(x, CSV_FLOAT, INFINITY),
    NUMBER(rotation, CSV_FLOAT, INFINITY),
    NUMBER(spin, CSV_FLOAT, INFINITY),
    NUMBER(mass, CSV_FLOAT, INFINITY),
    COUNT(launch_frame, 0),
    ERROR(error_worst),
    ERROR(error),
    NUMBER(time, CSV_NUMBER, INFINITY),
    COUNT(frame, 0),
    COUNT(body, -1),
    TEXT(page, CSV_PATH_SIZE),
    COUNT(bytes, 0),
};

const CsvLayout launch_page_layout =
    CSV_LAYOUT("chart_pages", columns, LaunchPage, .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);
