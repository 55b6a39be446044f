/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"

const Command commands[] = {{"simulate", "run a scene with one method and store the trajectory", command_simulate},
                            {"render", "draw runs side by side as PNG frames and videos", command_render},
                            {"compare", "compare two trajectories or two PNG sequences", command_compare},
                            {"approve", "accept the changes that a report of compare shows", command_approve},
                            {"diverge", "find why two trajectories diverge, and how fast", command_diverge},
                            {"figure", "draw a figure for a paper from runs", command_figure},
                            {"dataset", "record what the engine's solver does to each touching pair", command_dataset},
                            {"train", "train the network of a method", command_train},
                            {"chart", "measure speed against accuracy for every method", command_chart},
                            {"paper", "reproduce the paper, from seed to report", command_paper},
                            {"stability", "find where each method fails", command_stability},
                            {"problem", "write the contact problem of one step to a file", command_problem},
                            {"solve", "solve one contact problem with many methods and score them", command_solve},
                            {"methods", "list the methods and their settings", command_methods},
                            {0}};
