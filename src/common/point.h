/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once

/* A place in double: metres, millimetres of a page or pixels of a picture, as its user states. */
typedef struct Point {
    double x, y;
} Point;
