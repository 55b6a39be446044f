/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/cause.h"

#include <errno.h>
#include <string.h>

bool cause_is_system(int cause) {
    static const int causes[] = {ENOMEM, EMFILE, ENFILE, EIO, EAGAIN, EINTR, ENOBUFS, ESTALE, ETIMEDOUT};
    for (size_t i = 0; i < sizeof causes / sizeof *causes; i++)
        if (cause == causes[i]) return true;
    return false;
}

bool cause_error(int cause, const char *path, Error *error) {
    return cause == ENOMEM ? error_memory(error, path) : error_system(error, path, "cannot read: %s", strerror(cause));
}
