/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Operations on four numbers that are computed together. A comparison with NaN is false: the second choice. */
#pragma once
#include "methods/block_lu.h"

typedef long long Mask4 __attribute__((vector_size(32), aligned(16), may_alias));

static inline Vec4 vec4(double x, double y, double z, double w) { return (Vec4){x, y, z, w}; }
static inline Vec4 all4(double x) { return (Vec4){x, x, x, x}; }
static inline double sum4(Vec4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }
static inline Vec4 choose4(Mask4 mask, Vec4 x, Vec4 y) { return (Vec4)((mask & (Mask4)x) | (~mask & (Mask4)y)); }
static inline Vec4 smaller4(Vec4 x, Vec4 y) { return choose4((Mask4)(x < y), x, y); }
static inline Vec4 larger4(Vec4 x, Vec4 y) { return choose4((Mask4)(x > y), x, y); }
