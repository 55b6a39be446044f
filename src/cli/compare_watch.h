/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox compare --watch. */
#pragma once
#include "cli/compare_options.h"

typedef bool CompareRun(const CompareOptions *options, Error *error);

/* Compares, and again whenever a picture or trajectory below the two inputs has changed and all have been still for half
   a second, until Ctrl-C or SIGTERM. An error, such as a folder that is gone, is printed and does not end it. Returns
   what the last comparison that ended returned, with its error. */
bool compare_watch(const CompareOptions *options, CompareRun *compare, Error *error);
