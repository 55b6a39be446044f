/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress_bar.h"
#include "cli/shard_option.h"
#include "cli/train/train.h"
#include "npz/output_check.h"

#include <string.h>

bool train_take_shard(TrainRequest *request, int argc, char **argv, Error *error) {
    const int i = train_find_option(request->kind, "--shard");
    if (i < 0)
        return !shard_option_is_merge() ||
               error_input(error, "--kind", "%s has no shards that could be merged", request->kind->name);
    const char *text = request->values[i];
    request->values[i] = NULL;
    return shard_option_take(&request->run, text, argc, argv, error);
}

bool train_is_shard(const TrainRequest *request) {
    return request->run.request.shard.count > 1 || request->run.request.array.step > 0;
}

/* Hashes everything that determines the network: the command without its paths, and the file that it reads. */
static bool find_key(const TrainRequest *request, StudyKey *key, Error *error) {
    TrainRequest options = *request;
    char command[TRAIN_COMMAND_SIZE];
    options.input = NULL;
    options.output = "";
    train_describe(&options, command, sizeof command);
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, command, strlen(command));
    return request->input == NULL || study_key_add_file(key, request->input, error);
}

static bool do_pieces(const TrainRequest *request, const PiecePlan *plan, Pieces *pieces, Error *error) {
    const bool ok = pieces_do(pieces, plan, progress_bar_begin("recorded launches"), error);
    progress_bar_end();
    if (ok && pieces->mode == PIECES_SHARD) shard_option_print(pieces, request->output);
    return ok;
}

bool train_pieces(const TrainRequest *request, const PiecePlan *plan, Pieces *pieces, Error *error) {
    StudyKey key = {0};
    if (train_is_shard(request) && !output_is_file(request->output))
        return error_input(error, request->output,
                           "shards need the name of a file, beside which their pieces are kept");
    const bool ok = find_key(request, &key, error) &&
                    pieces_open(pieces, request->output, true, &key, &request->run, error) &&
                    (pieces->mode == PIECES_WHOLE || do_pieces(request, plan, pieces, error));
    study_key_free(&key);
    return ok;
}
