/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"

const Command commands[] = {{"simulate", "run a scene by one method and store the trajectory", command_simulate},
                            {"render", "draw runs side by side into a PNG sequence and a video", command_render},
                            {"compare", "tell where two trajectories or PNG sequences part", command_compare},
                            {"approve", "accept what a report of compare has shown", command_approve},
                            {"diverge", "tell why two trajectories part, and how fast", command_diverge},
                            {"figure", "draw a figure for a paper from runs", command_figure},
                            {"dataset", "record what the engine's solver does to each touching pair", command_dataset},
                            {"train", "train the network of a method", command_train},
                            {"chart", "chart speed against accuracy for every method", command_chart},
                            {"paper", "reproduce the paper, from seed to report", command_paper},
                            {"stability", "find where each method fails", command_stability},
                            {"problem", "write the contact problem of one step", command_problem},
                            {"solve", "solve one contact problem by many methods, with their errors", command_solve},
                            {"methods", "list the methods and their settings", command_methods},
                            {0}};
