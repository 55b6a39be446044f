/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"

#define COMMAND_ENTRY(name, summary) {#name, summary, command_##name},
const Command commands[] = {COMMANDS(COMMAND_ENTRY){0}};
