/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches of a dataset. */
#pragma once
#include "dataset/dataset.h"

/* Launches of each scene. */
int dataset_launches_each(const DatasetOptions *options);

/* Fills the launch tables; a fifth of each scene's launches, at least one, is held out. */
Dataset *dataset_of_launches(const DatasetOptions *options, Scene *const *scenes, Error *error);

/* Launch i of the dataset in its scene; shares the scene's bodies. */
Scene dataset_launch(const Dataset *dataset, Scene *const *scenes, int i);
