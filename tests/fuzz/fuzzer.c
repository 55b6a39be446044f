/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libFuzzer's entry for the target FUZZ_TARGET. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!fuzz_try(FUZZ_TARGET, data, size)) fuzz_fail("no target %s", FUZZ_TARGET);
    return 0;
}
