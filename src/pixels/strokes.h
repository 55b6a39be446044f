/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of arrows. C and the script of a page that plays runs have this one table: base/tools/embed.cmake makes
   constants of JavaScript of its lines. So each is a `static const` number that both languages write alike. */
#pragma once

static const double HEAD = 4.2;       /* length of an arrow's head / thickness */
static const double MIN_HEAD = 3;     /* the same for short arrows */
static const double HEAD_SHARE = 0.6; /* of a short arrow's length that is its head */
static const double MIN_LENGTH = 2;   /* of an arrow / thickness */
static const double HALO = 1.0;       /* pixels on each side; at least a third of the thickness */
static const double NO_HALO = 1.0;    /* pixels; lines up to this thickness have no halo, which would be all to see */
static const double HALO_RISE = 2.5;  /* of the halo, pixels per pixel of thickness from there */
static const double HEAD_SPACING = 0.85; /* between two heads / their length */
static const double HEAD_SINE = 0.5;     /* of half the angle between the head's sides, 30 degrees */
static const double HEAD_COSINE = 0.8660254037844386;
static const double MAX_COORDINATE = 1e9; /* pixels; no visible body is farther away */
