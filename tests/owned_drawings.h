/* SPDX-License-Identifier: GPL-3.0-or-later */
/* As owned.h, of what is drawn. */
#pragma once
#include "owned.h"

#include "pictures/picture.h"
#include "pixels/gl.h"

OWNED_VALUE(Drawing, drawing_free)
OWNED_VALUE(Picture, picture_free)
