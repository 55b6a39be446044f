/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Mesa's libraries leak is no business of these tests. Include it where a test makes a context. */
#pragma once

/* The leak sanitizer asks for this by name; elsewhere it is just a function that nobody calls. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libOSMesa\nleak:libEGL\nleak:libLLVM\nleak:libgallium\nleak:_dri.so\n";
}
