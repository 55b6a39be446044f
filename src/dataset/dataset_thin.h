/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fewer rows, evenly. */
#pragma once
#include "dataset/dataset.h"

/* Keeps rows 0, every, 2 every, ... of the dataset. */
void dataset_thin(Dataset *dataset, int every);
