/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack BUNDLE SCENE [METHOD...]: writes the bundle of a page, for tests/live/live.mjs. pack MODULE networks|plain:
   writes a module. */
#include "base/base.h"
#include "base/file.h"
#include "live/live.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    Error error = {0};
    void *bundle = NULL;
    size_t size = 0;
    if (argc < 3) return ERROR_INPUT;
    const LiveModule module = live_module(strcmp(argv[2], "networks") == 0);
    bool ok;
    if (strcmp(argv[2], "networks") == 0 || strcmp(argv[2], "plain") == 0)
        ok = file_write(argv[1], module.bytes, module.size, &error);
    else
        ok = live_pack(argv[2], (const char *const *)argv + 3, argc - 3, &bundle, &size, &error) &&
             file_write(argv[1], bundle, size, &error);
    free(bundle);
    if (!ok) fprintf(stderr, "%s\n", error.message);
    return ok ? 0 : (int)error.kind;
}
