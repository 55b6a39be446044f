/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is wrong with the syntax of a YAML file, for those who write scenes, not parsers. */
#pragma once

/* Our words for a problem that libyaml reports; its own for rare ones. `at`: the first character that is wrong. */
const char *syntax_words(const char *problem, char at);
