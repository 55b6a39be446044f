/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chains: numbers of a scene file given as products and quotients, from left to right, of decimals and $names of the
   scene's parameters, such as 10*$slope or 1/$rate. No other operators, no parentheses, no blanks. The tree's context
   is the scene's Parameters, or NULL where there are none. */
#pragma once
#include "yaml/yaml_tree.h"

/* Time is linear in the number of factors, and a file of 1.5 MB has room for 750,000. */
enum { CHAIN_MAX_NUMBERS = 16, CHAIN_SHOWN_SIZE = 320 };

/* True if the node's text is more than a decimal: it has '*', '/' or '$'. */
bool chain_is(const YamlTree *tree, int node);

/* The value of a scalar, in double; a decimal is a chain, too. Refused, with its place: text that is not a chain,
   unknown names, division by 0 and infinite intermediate results. Names in the chain are marked as used. */
bool chain_read(const YamlTree *tree, int node, const char *what, double *value, Error *error);

/* A node's number for a message: its text "-1", or "0, from 0*$ratio with ratio = 10". */
typedef struct ChainShown {
    char text[CHAIN_SHOWN_SIZE];
} ChainShown;
ChainShown chain_show(const YamlTree *tree, int node, double value);
