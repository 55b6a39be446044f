/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of a scene file that are chains: products and quotients, from left to right, of decimals and $names of the
   scene's parameters, such as 10*$slope or 1/$rate. No other operators, no parentheses, no blanks. */
#pragma once
#include "scene/yaml_tree.h"

/* A chain takes as long as it has numbers, and a file of 1.5 MB has room for three quarters of a million. */
enum { CHAIN_MAX_NUMBERS = 16, CHAIN_SHOWN_SIZE = 320 };

/* True where the node's text has a sign of a chain that is more than a decimal. */
bool chain_is(const YamlTree *tree, int node);

/* The value of a scalar, in double; a decimal alone is a chain, too. Refused, at its place: what is no chain, unknown
   names, division by 0, and what leaves the finite numbers on the way. Names found are marked as used. */
bool chain_read(const YamlTree *tree, int node, const char *what, double *value, Error *error);

/* What a node's number is, for a message: "-1" as it stands there, or "0, from 0*$ratio with ratio = 10". */
typedef struct ChainShown {
    char text[CHAIN_SHOWN_SIZE];
} ChainShown;
ChainShown chain_show(const YamlTree *tree, int node, double value);
