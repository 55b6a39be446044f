/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"
#include "chart/equal_time_plot.h"
int main(int argc, char **argv) { (void)argc; Error e={0}; bool d; if(!equal_time_plot(argv[1], argv[2], &d, &e)) puts(e.message); return 0; }
