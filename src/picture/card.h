/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cards before and after a run: what is shown, and what came of it. */
#pragma once
#include "picture/picture.h"

/* For a moment of kind MOMENT_TITLE or MOMENT_END. */
void card_draw(const Picture *picture, Moment moment, Drawing *drawing);
