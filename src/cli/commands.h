/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "cli/command.h"

int command_simulate(int argc, char **argv, Error *error);
int command_render(int argc, char **argv, Error *error);
int command_compare(int argc, char **argv, Error *error);
int command_approve(int argc, char **argv, Error *error);
int command_diverge(int argc, char **argv, Error *error);
int command_figure(int argc, char **argv, Error *error);
int command_dataset(int argc, char **argv, Error *error);
int command_train(int argc, char **argv, Error *error);
int command_chart(int argc, char **argv, Error *error);
int command_paper(int argc, char **argv, Error *error);
int command_stability(int argc, char **argv, Error *error);
int command_problem(int argc, char **argv, Error *error);
int command_solve(int argc, char **argv, Error *error);
int command_methods(int argc, char **argv, Error *error);
