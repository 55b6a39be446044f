/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A shell and its script; or the words that a script wants to know. */
#include "cli/completion.h"

#include "cli/commands.h"
#include "cli/completion_scripts.h"

#include <stdio.h>
#include <string.h>

enum { WORDS_MAX = 1024 };

typedef struct Options {
    const char *shell;
    CompletionWords words;
    const char *texts[WORDS_MAX];
} Options;

static const struct {
    const char *shell, *script;
} scripts[] = {{"bash", completion_twinbox_bash}, {"zsh", completion__twinbox}, {"fish", completion_twinbox_fish}};
enum { SCRIPTS = sizeof scripts / sizeof *scripts };

static bool read_input(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)error;
    Options *options = value;
    if (options->shell == NULL)
        options->shell = text;
    else
        options->texts[options->words.count++] = text;
    return true;
}

static const char *const shells[] = {"bash", "zsh", "fish", NULL};

static const CommandSpec spec = {
    .options = (const Option[]){{0}},
    .input = {.value = "bash|zsh|fish",
              .needed = "a shell is needed: bash, zsh or fish",
              .read = read_input,
              .names = shells},
    .inputs = {1, 1 + WORDS_MAX, "word"},
    .help = "Print the script that completes twinbox's commands, options, methods, settings and scenes in a shell. "
            "An installed twinbox has installed it.\v"
            "Example: source <(twinbox completion bash)\n"
            "         twinbox completion zsh >~/.zfunc/_twinbox\n"
            "         twinbox completion fish | source"};

bool command_completion(int argc, char **argv, Error *error) {
    Options options = {.words.count = 0};
    options.words.words = options.texts;
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (strcmp(options.shell, "words") == 0) {
        completion_print(&options.words);
        return true;
    }
    for (int i = 0; i < SCRIPTS && options.words.count == 0; i++)
        if (strcmp(options.shell, scripts[i].shell) == 0) return fputs(scripts[i].script, stdout) >= 0;
    return error_input(error, "completion", "'%s' is neither bash nor zsh nor fish", options.shell);
}
