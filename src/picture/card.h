/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The title card before a run and the end card with its results. */
#pragma once
#include "picture/picture.h"
#include "picture/text_lines.h"

/* The title of a card, MOMENT_TITLE or MOMENT_END, in its lines. */
TextLines card_head(const Picture *picture, MomentKind kind);

/* `moment` has kind MOMENT_TITLE or MOMENT_END. */
void card_draw(const Picture *picture, Moment moment, Drawing *drawing);
