/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ignores leaks in Mesa's libraries. Include it in tests that create a context. */
#pragma once

/* Called by the leak sanitizer; unused otherwise. */
__attribute__((weak)) const char *__lsan_default_suppressions(void); /* files of one program share it */
const char *__lsan_default_suppressions(void) {
    return "leak:libOSMesa\nleak:libEGL\nleak:libLLVM\nleak:libgallium\nleak:_dri.so\n";
}
