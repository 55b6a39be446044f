/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "pieces/pieces_estimate.h"

/* "twinbox stability --plan": pieces, what they take, and how long 10, 1,000 and 100,000 cores need. */
void stability_plan_print(const PiecesEstimate *estimate);
