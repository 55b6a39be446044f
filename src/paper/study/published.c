/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/published.h"

const PublishedScore published_scores[PUBLISHED_SCORES] = {
    {0, 0.105798, 0.106044},   {10, 0.051244, 0.051222},   {50, 0.015246, 0.015388},
    {100, 0.007767, 0.007789}, {1000, 0.001212, 0.001225}, {2000, 0.000728, 0.000730},
};
