/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scripts in src/cli/completion, each ended by a 0. */
#pragma once

extern const char completion_twinbox_bash[], completion__twinbox[], completion_twinbox_fish[];
