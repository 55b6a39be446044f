/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack BUNDLE SCENE [METHOD...]: writes the bundle of a page, for tests/live/live.mjs. pack MODULE: writes the module. */
#include "base/base.h"
#include "base/file.h"
#include "live/live.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv) {
    Error error = {0};
    void *bundle = NULL;
    size_t size = 0;
    if (argc < 2) return ERROR_INPUT;
    bool ok;
    if (argc == 2)
        ok = file_write(argv[1], live_module_wasm, live_module_wasm_size, &error);
    else
        ok = live_pack(argv[2], (const char *const *)argv + 3, argc - 3, &bundle, &size, &error) &&
             file_write(argv[1], bundle, size, &error);
    free(bundle);
    if (!ok) fprintf(stderr, "%s\n", error.message);
    return ok ? 0 : (int)error.kind;
}
