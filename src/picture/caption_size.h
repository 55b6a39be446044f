/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once

/* Of a title, a caption or a name, bytes with the NUL. */
enum { CAPTION_SIZE = 256 };
