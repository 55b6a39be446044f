/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox merge: runs the command of a record once more, which finds all pieces done by its shards. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/options.h"
#include "runs/pieces.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Options {
    const char *output;
    unsigned times;
} Options;

static const char *const times_names[] = {"equal", "first", NULL};

static const Option option_table[] = {{"--times", 0, "KIND",
                                       "Times measured on processors of different models: equal, which refuses them "
                                       "(default), or first, which leaves empty those of other models than the first",
                                       OPTION_ENUM(Options, times, times_names)},
                                      {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "OUTPUT",
              .needed = "the output of the shards is needed: what they had as -o",
              OPTION_PATH(Options, output)},
    .inputs = {1, 1, "output"},
    .help =
        "Join what the shards of a command (--shard) left in OUTPUT/shards: "
        "checks that every piece is there, of this version and of these inputs, and writes what the command writes "
        "without shards, byte for byte. The shards stay; a second merge changes nothing.\n"
        "If pieces are missing, nothing is written: the message names them, standard output has the option for sbatch "
        "that does them, and the exit status is 1.\v"
        "Example: twinbox stability --shard 1/2 -o out/stability\n"
        "         twinbox stability --shard 2/2 -o out/stability\n"
        "         twinbox merge out/stability\n"
        "         sbatch $(twinbox merge out/stability) job.sh"};

/* The commands that can be merged: a record does not run any other. */
static const char *const mergeable[] = {"chart", "paper", "render", "stability"};

static const Command *find_command(const StudyRecord *record, const char *path, Error *error) {
    const char *space = strrchr(record->command.argv[0], ' '), *name = space != NULL ? space + 1 : "";
    bool known = false;
    for (size_t i = 0; i < sizeof mergeable / sizeof *mergeable; i++) known = known || strcmp(name, mergeable[i]) == 0;
    for (const Command *command = commands; known && command->name != NULL; command++)
        if (strcmp(command->name, name) == 0) return command;
    return error_input(error, path, "'%s' is not a command that has shards", record->command.argv[0]), NULL;
}

/* run.json of an output. */
static bool find_record(const char *output, char path[PIECES_PATH_SIZE], Error *error) {
    bool there;
    if (!pieces_record_path(path, output, error) || !file_find(path, &there, error)) return false;
    return there || error_input(error, output, "has no shards: %s is missing", path);
}

/* Goes to the folder in which the shards ran, so that their paths are right. output: absolute if that is another. */
static bool enter_folder(const StudyRecord *record, const char *path, char output[PATH_MAX], Error *error) {
    char here[PATH_MAX], whole[2 * PATH_MAX];
    if (getcwd(here, sizeof here) == NULL) return error_system(error, path, "the current folder has no name");
    if (strcmp(here, record->command.folder) == 0) return true;
    if (output[0] != '/') {
        snprintf(whole, sizeof whole, "%s/%s", here, output);
        if (strlen(whole) >= PATH_MAX) return error_input(error, output, "the path is too long");
        strcpy(output, whole);
    }
    return chdir(record->command.folder) == 0 ||
           error_input(error, path, "the shards ran in the folder '%s', which is not here", record->command.folder);
}

/* Whether the shards' own output, seen from here, is the one to be merged: results may tell it, so it is kept as it was
   given. An output that was moved or copied since has another name. */
static bool is_own_output(const StudyRecord *record, const struct stat *merged) {
    char path[PIECES_PATH_SIZE];
    struct stat own;
    Error ignored = {0};
    return find_record(record->command.output, path, &ignored) && stat(path, &own) == 0 &&
           own.st_dev == merged->st_dev && own.st_ino == merged->st_ino;
}

/* The last -o counts. */
static bool run_command(const StudyRecord *record, const Command *command, char *output, Error *error) {
    const int argc = record->command.argc, more = output != NULL ? 2 : 0;
    char **argv = calloc((size_t)argc + 3, sizeof *argv), option[] = "-o";
    if (argv == NULL) return error_memory(error, record->command.output);
    memcpy(argv, record->command.argv, (size_t)argc * sizeof *argv);
    argv[argc] = output != NULL ? option : NULL;
    argv[argc + 1] = output;
    const bool done = command->run(argc + more, argv, error);
    free(argv);
    return done;
}

static bool merge_study(const StudyRecord *record, const char *path, char output[PATH_MAX], Error *error) {
    struct stat merged;
    const Command *command = find_command(record, path, error);
    if (command == NULL) return false;
    if (stat(path, &merged) != 0) return error_system(error, path, "cannot be read: %s", strerror(errno));
    return enter_folder(record, path, output, error) &&
           run_command(record, command, is_own_output(record, &merged) ? NULL : output, error);
}

bool command_merge(int argc, char **argv, Error *error) {
    Options options = {0};
    StudyRecord record = {0};
    char path[PIECES_PATH_SIZE], output[PATH_MAX], *missing = NULL;
    if (!options_parse(&spec, argc, argv, &options, error) || !find_record(options.output, path, error)) return false;
    if (strlen(options.output) >= sizeof output) return error_input(error, options.output, "the path is too long");
    strcpy(output, options.output);
    const PiecesRun run = {.merge = true, .times_first = options.times == 1, .shards = &missing};
    shard_option_merge(&run);
    const bool ok = study_record_read(&record, path, error) && merge_study(&record, path, output, error);
    shard_option_merge(NULL);
    if (missing != NULL) printf("--array=%s\n", missing);
    free(missing);
    study_record_free(&record);
    return ok;
}
