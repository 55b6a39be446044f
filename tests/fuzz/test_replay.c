/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every target on its stored inputs, which no reader may fail on. With arguments, TARGET FILE...: a target on these
   files, such as one that libFuzzer has found. */
#include "testing.h"

#include "base/file.h"
#include "fuzz.h"

#include <dirent.h>

enum { INPUT_MAX = 1 << 20 };

static const char *const targets[] = {
#define FUZZ_NAME(name) #name,
    FUZZ_TARGETS(FUZZ_NAME)};

enum { TARGETS = sizeof targets / sizeof *targets };

static void replay_file(const char *target, const char *path) {
    size_t size;
    Error error = {0};
    char *data = file_read(path, INPUT_MAX, &size, &error);
    assert_ok(data != NULL, error);
    uint8_t *copy = malloc(size); /* without the NUL that file_read() adds */
    assert_true(copy != NULL || size == 0);
    if (size > 0) memcpy(copy, data, size);
    free(data);
    assert_true(fuzz_try(target, copy, size));
    free(copy);
}

static void replay_corpus(void **state) {
    const char *target = *state;
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s", SOURCE_DIR, target);
    DIR *folder = opendir(path);
    if (folder == NULL) fail_msg("%s is missing", path);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s/%s", SOURCE_DIR, target, entry->d_name);
        fprintf(stderr, "%s\r", path); /* the last one is the finding */
        replay_file(target, path);
        count++;
    }
    closedir(folder);
    assert_in_range(count, 1, 25000);
}

int main(int argc, char **argv) {
    struct CMUnitTest tests[TARGETS];
    for (int i = 2; i < argc; i++) replay_file(argv[1], argv[i]);
    if (argc > 1) return 0;
    for (int i = 0; i < TARGETS; i++)
        tests[i] = (struct CMUnitTest){targets[i], replay_corpus, NULL, NULL, (void *)(uintptr_t)targets[i]};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
