/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/render_shards.h"

#include "common/standard_io.h"

#include <string.h>

bool render_key(StudyKey *key, const Panels *panels, const DrawVideos *videos, const char *costs, Error *error) {
    if (!study_key_begin(key, error)) return false;
    for (int i = 0; i < panels->count; i++)
        if (!study_key_add_input(key, panels->inputs[i], trajectory_hash(panels->runs[i]), error)) return false;
    for (int i = 0; i < videos->count; i++) study_key_add(key, videos->paths[i], strlen(videos->paths[i]));
    return costs == NULL || study_key_add_file(key, costs, error);
}

bool render_check_again(const char *path, Error *error) {
    return path == NULL || !path_is_standard(path) ||
           error_input(error, "--shard", "the merge cannot read standard input again; give the run as a file");
}

bool render_store_runs(void *context, Error *error) {
    const RunsPlace *place = context;
    return panels_store(place->panels, place->directory, error);
}
