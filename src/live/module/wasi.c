/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What wasi-libc would import from its host. With these functions the module has no imports, so it cannot do more than
   compute. */
#include <locale.h>
#include <wasi/api.h>

/* Streams of the C library link to its standard output and error, which nothing here writes to. */
__wasi_errno_t __wasi_fd_close(__wasi_fd_t fd) { return (void)fd, __WASI_ERRNO_BADF; }

__wasi_errno_t __wasi_fd_seek(__wasi_fd_t fd, __wasi_filedelta_t by, __wasi_whence_t from, __wasi_filesize_t *to) {
    return (void)fd, (void)by, (void)from, (void)to, __WASI_ERRNO_BADF;
}

__wasi_errno_t __wasi_fd_write(__wasi_fd_t fd, const __wasi_ciovec_t *data, size_t count, __wasi_size_t *written) {
    return (void)fd, (void)data, (void)count, (void)written, __WASI_ERRNO_BADF;
}

/* In wasi-libc of 2024, its caller is in one object with close(). */
__wasi_errno_t __wasi_fd_renumber(__wasi_fd_t fd, __wasi_fd_t to) { return (void)fd, (void)to, __WASI_ERRNO_BADF; }

/* Numbers are read in the C locale, and there is no other here. The locales of wasi-libc read the environment. */
locale_t newlocale(int mask, const char *name, locale_t base) {
    static char only;
    return (void)mask, (void)name, (void)base, (locale_t)&only;
}

locale_t uselocale(locale_t locale) { return locale; }

void freelocale(locale_t locale) { (void)locale; }
