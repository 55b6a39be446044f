/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Completion of command lines. The scripts for the shells (src/cli/completion) call `twinbox completion words`, which
   answers from the option tables. */
#include "base/base.h"
#include "cli/cli.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "methods/methods.h"
#include "scenes/scenes.h"

#include <ctype.h>
#include <string.h>

enum { COMPLETION_WORD_SIZE = 1024 }; /* a longer word has no completion */

/* The words behind "twinbox"; the last one, maybe empty, is being typed. */
typedef struct CompletionWords {
    int count;
    const char *const *words;
} CompletionWords;

/* What the value of an option, or an argument, may become. */
typedef struct CompletionValue {
    const Option *option;
    const char *begin; /* what stands before the value in the word: "--method=" */
    const char *typed; /* of the value */
    const char *scene; /* the first scene on the command line, or NULL */
} CompletionValue;

/* Prints begin, word and ending as a candidate if it begins with what was typed (behind `begin`). */
static void completion_offer(const char *begin, const char *typed, const char *word, const char *ending,
                             const char *description) {
    char whole[COMPLETION_WORD_SIZE];
    const int length = snprintf(whole, sizeof whole, "%s%s", word, ending);
    if (length < 0 || (size_t)length >= sizeof whole || strncmp(whole, typed, strlen(typed)) != 0) return;
    printf("%s%s\t%.*s\n", begin, whole, (int)strcspn(description, "\n"), description);
}

/* Files: see print_completions(). */
static void offer_entries(const char *begin, const char *endings) { printf("<files>%s\t%s\n", begin, endings); }

static void offer_folders(const char *begin) { printf("<folders>%s\n", begin); }

/* Methods and their settings, from the registry. */

/* A method's text up to the piece that is being typed: "chart:k=5,mo" has the begin "chart:k=5," and the piece "mo". */
typedef struct Piece {
    char begin[COMPLETION_WORD_SIZE];
    const char *text;
} Piece;

static Piece piece_behind(const char *begin, const char *typed, const char *text) {
    Piece piece = {.begin = "", .text = text};
    text_add(piece.begin, sizeof piece.begin, "%s%.*s", begin, (int)(text - typed), typed);
    return piece;
}

static void offer_value(const Piece *piece, const SettingSpec *settings) {
    const char *equals = strchr(piece->text, '=');
    const size_t length = (size_t)(equals - piece->text);
    const Piece value = piece_behind(piece->begin, piece->text, equals + 1);
    for (const SettingSpec *setting = settings; setting != NULL && setting->key != NULL; setting++) {
        if (strlen(setting->key) != length || strncmp(setting->key, piece->text, length) != 0) continue;
        if (strcmp(setting->key, "network") == 0) offer_entries(value.begin, "npz");
        if (strncmp(setting->summary, "on|off", strlen("on|off")) != 0) continue;
        completion_offer(value.begin, value.text, "on", "", setting->summary);
        completion_offer(value.begin, value.text, "off", "", setting->summary);
    }
}

static void offer_settings(const Piece *piece, const SettingSpec *settings) {
    if (strchr(piece->text, '=') != NULL) {
        offer_value(piece, settings);
        return;
    }
    for (const SettingSpec *setting = settings; setting != NULL && setting->key != NULL; setting++)
        completion_offer(piece->begin, piece->text, setting->key, "=", setting->summary);
}

/* A name; with its settings when it is complete. */
static void offer_method_names(const Piece *piece) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        completion_offer(piece->begin, piece->text, method->name, "", method->summary);
        if (strcmp(method->name, piece->text) != 0) continue;
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++) {
            char ending[64];
            snprintf(ending, sizeof ending, ":%s=", setting->key);
            completion_offer(piece->begin, piece->text, method->name, ending, setting->summary);
        }
    }
}

/* The first character of the last method of a list: behind the last comma, unless settings go on behind it. */
static const char *find_last(const char *typed) {
    const char *last = typed;
    for (const char *comma = strchr(typed, ','); comma != NULL; comma = strchr(comma + 1, ','))
        if (method_describe(comma + 1) != NULL) last = comma + 1;
    return last;
}

/* A method with settings, "NAME:KEY=VALUE,KEY=VALUE"; with `list`, several separated by commas. */
static void offer_methods(const char *begin, const char *typed, bool list) {
    const char *method = list ? find_last(typed) : typed, *colon = strchr(method, ':'), *comma = strrchr(method, ',');
    const MethodDescription *known = method_describe(method);
    if (colon != NULL && known != NULL) {
        const Piece setting = piece_behind(begin, typed, comma != NULL ? comma + 1 : colon + 1);
        offer_settings(&setting, known->settings);
    }
    if (colon == NULL || (list && comma != NULL)) {
        const Piece name = piece_behind(begin, typed, list && comma != NULL ? comma + 1 : method);
        offer_method_names(&name);
    }
}

/* Values of options. What a value may be is read from its row: names, the name of the value ("FILE.csv", "on|off",
   "SCENE"), and the endings in the help ("Figure to write: .png, .svg or .pdf"). */

static bool completion_has(const char *text, const char *piece) { return strstr(text, piece) != NULL; }

/* One of the names; with `list`, further ones separated by commas. */
static void offer_names(const CompletionValue *value, const char *const *names, bool list) {
    const char *comma = list ? strrchr(value->typed, ',') : NULL;
    const char *typed = comma != NULL ? comma + 1 : value->typed;
    char begin[COMPLETION_WORD_SIZE] = "";
    text_add(begin, sizeof begin, "%s%.*s", value->begin, (int)(typed - value->typed), value->typed);
    for (int i = 0; names[i] != NULL; i++) completion_offer(begin, typed, names[i], "", "");
}

/* "fast|small", but not "N|FILE.csv": words in lower case. */
static void offer_alternatives(const CompletionValue *value, const char *text) {
    while (*text != '\0') {
        const size_t length = strcspn(text, "|");
        char word[64];
        bool lower = length > 0 && length < sizeof word;
        for (size_t i = 0; i < length; i++) lower = lower && islower((unsigned char)text[i]);
        if (lower) {
            snprintf(word, sizeof word, "%.*s", (int)length, text);
            completion_offer(value->begin, value->typed, word, "", "");
        }
        text += length + (text[length] == '|');
    }
}

static void offer_parameters(const CompletionValue *value) {
    if (value->scene == NULL || strchr(value->typed, '=') != NULL) return;
    Scene *scene = scene_read(installed_path(value->scene), &(Error){0});
    if (scene == NULL) return;
    const SceneParameters all = scene_parameters(scene);
    for (const SceneParameter *parameter = all.items; parameter < all.items + all.count; parameter++) {
        char range[128];
        if (scene_parameter(&all, parameter->name) != parameter) continue;
        snprintf(range, sizeof range, "%g to %g%s%s (the scene's: %g)", parameter->from, parameter->to,
                 parameter->unit[0] != '\0' ? " " : "", parameter->unit, parameter->value);
        completion_offer(value->begin, value->typed, parameter->name, value->option->read == option_set ? "=" : "",
                         range);
    }
    scene_destroy(scene);
}

/* The endings of files in a text, separated by spaces, without the dot. */
static void find_endings(const char *text, char endings[64]) {
    static const char *const known[] = {"npz", "csv", "yaml", "png", "svg", "pdf", "json", "mp4", "webm", "gif", "xml"};
    endings[0] = '\0';
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strlen(known[i]);
        for (const char *dot = strchr(text, '.'); dot != NULL; dot = strchr(dot + 1, '.')) {
            if (strncmp(dot + 1, known[i], length) != 0 || isalnum((unsigned char)dot[1 + length])) continue;
            text_join(endings, 64, " ", "%s", known[i]);
            break;
        }
    }
}

/* Paths only where one is being typed: there are as many as names. */
static void offer_scene(const char *scene, void *context) {
    const CompletionValue *value = context;
    if (strchr(scene, '/') == NULL || strchr(value->typed, '/') != NULL)
        completion_offer(value->begin, value->typed, scene, "", "scene");
}

/* Files that an option takes, by the name of its value. */
static void offer_files(const CompletionValue *value) {
    const Option *option = value->option;
    const char *name = option->value, *help = option->help != NULL ? option->help : "";
    char endings[64], named[64];
    if (completion_has(name, "DIR")) {
        offer_folders(value->begin);
        return;
    }
    find_endings(name, named);
    snprintf(endings, sizeof endings, "%s", named);
    if (endings[0] == '\0') find_endings(help, endings);
    if (completion_has(named, "yaml")) { /* a scene that is written */
        offer_entries(value->begin, named);
    } else if (completion_has(name, "SCENE")) {
        text_add(named, sizeof named, "%syaml%s", named[0] != '\0' ? " " : "",
                 completion_has(name, "RUN") ? " npz" : "");
        offer_entries(value->begin, named);
        installed_scenes(offer_scene, (void *)value);
    } else if (endings[0] == '\0' && completion_has(name, "RUN"))
        offer_entries(value->begin, "npz");
    else if (named[0] != '\0' || completion_has(name, "RUN") || completion_has(name, "FILE") || option->name == NULL)
        offer_entries(value->begin, endings);
}

static void offer_of(const CompletionValue *value) {
    const Option *option = value->option;
    if (option->value == NULL) return;
    if (option->read == option_set || (option->name != NULL && strcmp(option->name, "--vary") == 0))
        offer_parameters(value);
    else if (option->names != NULL)
        offer_names(value, option->names, option->read == option_flags);
    else if (completion_has(option->value, "KEY=VALUE") ||
             (option->name != NULL && strcmp(option->name, "--methods") == 0))
        offer_methods(value->begin, value->typed, !completion_has(option->value, "KEY=VALUE"));
    else {
        offer_alternatives(value, option->value);
        offer_files(value);
    }
}

/* Finds out what the last word is: a command, an option, the value of one, or an argument. */

static void offer_options(const Option *rows, const char *typed) {
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL) completion_offer("", typed, rows->name, "", rows->help);
}

/* The row of "--name" or "--name=value", or NULL. */
static const Option *find_long(const Option *rows, const char *word) {
    const size_t length = strcspn(word, "=");
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL && strlen(rows->name) == length && strncmp(rows->name, word, length) == 0) return rows;
    return NULL;
}

static const Option *find_letter(const Option *rows, char letter) {
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL && rows->letter == letter) return rows;
    return NULL;
}

/* The option whose value the next word is, or NULL. */
static const Option *find_waiting(const Option *rows, const char *word) {
    const Option *row = NULL;
    if (strncmp(word, "--", 2) == 0)
        row = strchr(word, '=') == NULL ? find_long(rows, word) : NULL;
    else if (word[0] == '-' && word[1] != '\0' && word[2] == '\0')
        row = find_letter(rows, word[1]);
    return row != NULL && row->value != NULL ? row : NULL;
}

/* What stands before the last word. */
typedef struct Before {
    const Option *waiting; /* for its value */
    int inputs;
    bool only_inputs; /* after "--" */
    const char *scene;
} Before;

static Before look_before(const CommandSpec *spec, const CompletionWords *words) {
    Before before = {.waiting = NULL};
    for (int i = 0; i + 1 < words->count; i++) {
        const char *word = words->words[i];
        if (before.waiting != NULL)
            before.waiting = NULL;
        else if (strcmp(word, "--") == 0 && !before.only_inputs)
            before.only_inputs = true;
        else if (word[0] == '-' && word[1] != '\0' && !before.only_inputs)
            before.waiting = find_waiting(spec->options, word);
        else if (before.inputs++ == 0 && spec->input.value != NULL && strstr(spec->input.value, "SCENE") != NULL)
            before.scene = word;
    }
    return before;
}

/* `context` has the words behind the command. */
static void completion_complete(const CommandSpec *spec, void *context) {
    const CompletionWords *words = context;
    const char *typed = words->words[words->count - 1], *equals = strchr(typed, '=');
    const Before before = look_before(spec, words);
    char begin[COMPLETION_WORD_SIZE] = "";
    CompletionValue value = {before.waiting, begin, typed, before.scene};
    if (before.waiting == NULL && !before.only_inputs && strncmp(typed, "--", 2) == 0 && equals != NULL) {
        value.option = find_long(spec->options, typed);
        value.typed = equals + 1;
        snprintf(begin, sizeof begin, "%.*s", (int)(equals + 1 - typed), typed);
        if (value.option == NULL || value.option->value == NULL) return;
    } else if (before.waiting == NULL && !before.only_inputs && typed[0] == '-') {
        offer_options(spec->options, typed);
        offer_options(options_of_all, typed);
        completion_offer("", typed, "--help", "", "Give this help list");
        completion_offer("", typed, "--version", "", "Print the version");
        return;
    } else if (before.waiting == NULL) {
        /* Names are for the first argument only. */
        Option input = spec->input;
        if (before.inputs > 0) input.names = NULL;
        value.option = &input;
        if (before.inputs < spec->inputs.most && (input.names == NULL || before.inputs == 0)) offer_of(&value);
        return;
    }
    offer_of(&value);
}

static void complete_command(const char *typed, bool is_first) {
    for (const Command *command = commands; command->name != NULL; command++) {
        if (command->heading != NULL) printf("<group>%s\n", command->heading);
        if (command->summary != NULL) completion_offer("", typed, command->name, "", command->summary);
    }
    if (!is_first) return;
    puts("<group>Help");
    completion_offer("", typed, "help", "", "print the help of a command");
    if (typed[0] != '-') return;
    completion_offer("", typed, "--help", "", "list the commands");
    completion_offer("", typed, "--version", "", "print the version");
}

/* Prints what the last word may become, one line each: the whole word, a tab, a description. A line
   "<files>BEGIN<tab>npz csv" stands for files with these endings, or with any if none is given, whose names follow
   BEGIN in the word; "<folders>BEGIN" stands for folders; "<group>Make" is the heading of the commands that follow, in
   this order. */
static void print_completions(const CompletionWords *words) {
    if (words->count == 0 || strlen(words->words[words->count - 1]) >= COMPLETION_WORD_SIZE) return;
    const bool help = words->count == 2 && strcmp(words->words[0], "help") == 0;
    if (words->count == 1 || help) {
        complete_command(words->words[words->count - 1], !help);
        return;
    }
    for (const Command *command = commands; command->name != NULL; command++) {
        if (strcmp(command->name, words->words[0]) != 0) continue;
        CompletionWords rest = {words->count - 1, words->words + 1};
        options_visit_next(completion_complete, &rest);
        command->run(0, NULL, &(Error){0});
        return;
    }
}

/* A shell and its script; or the words that a script wants to know. */

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
        print_completions(&options.words);
        return true;
    }
    for (int i = 0; i < SCRIPTS && options.words.count == 0; i++)
        if (strcmp(options.shell, scripts[i].shell) == 0) return fputs(scripts[i].script, stdout) >= 0;
    return error_input(error, "completion", "'%s' is neither bash nor zsh nor fish", options.shell);
}
