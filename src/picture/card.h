/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The title card before a run and the end card with its results. */
#pragma once
#include "picture/picture.h"

/* `moment` has kind MOMENT_TITLE or MOMENT_END. */
void card_draw(const Picture *picture, Moment moment, Drawing *drawing);
