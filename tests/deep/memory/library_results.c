/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What libraries store in memory of twinbox: the memory sanitizer does not see their stores, so it is told of them
   here. The linker hands twinbox's calls to these functions. A program that does not use a library does not link it:
   the calls are weak. */
#include <gsl/gsl_fit.h>
#include <gsl/gsl_multilarge_nlinear.h>
#include <jansson.h>
#include <png.h>
#include <sanitizer/msan_interface.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <yaml.h>
#include <zip.h>
#include <zlib.h>

#pragma weak png_get_rowbytes

/* A library's own variables lie where functions of twinbox had theirs: what is below this frame counts as
   initialised. */
static void begin_call(void) {
    enum { DEPTH = 1 << 16 };
    char *here = __builtin_frame_address(0);
    __msan_unpoison(here - DEPTH, DEPTH);
    __msan_scoped_disable_interceptor_checks();
}

/* RESULT(type, function, parameters, arguments, what it stores) */
#define RESULT(type, function, parameters, arguments, stored) \
    __attribute__((weak)) type __real_##function parameters;  \
    type __wrap_##function parameters;                        \
    type __wrap_##function parameters {                       \
        begin_call();                                         \
        type result = __real_##function arguments;            \
        __msan_scoped_enable_interceptor_checks();            \
        stored;                                               \
        return result;                                        \
    }
#define NO_RESULT(function, parameters, arguments, stored)   \
    __attribute__((weak)) void __real_##function parameters; \
    void __wrap_##function parameters;                       \
    void __wrap_##function parameters {                      \
        begin_call();                                        \
        __real_##function arguments;                         \
        __msan_scoped_enable_interceptor_checks();           \
        stored;                                              \
    }
#define STORED(pointer) ((pointer) != NULL ? __msan_unpoison((pointer), sizeof *(pointer)) : (void)0)

__attribute__((no_sanitize("memory"))) static void stored_text(const char *text) {
    size_t length = 0;
    while (text[length] != '\0') length++;
    __msan_unpoison(text, length + 1);
}

/* zlib: what lies before next_out. */
static void stored_stream(z_stream *stream, unsigned char *before) {
    __msan_unpoison(stream, sizeof *stream);
    if (before != NULL && stream->next_out > before) __msan_unpoison(before, (size_t)(stream->next_out - before));
}
#define STREAM(function)                                         \
    __attribute__((weak)) int __real_##function(z_streamp, int); \
    int __wrap_##function(z_streamp stream, int flush);          \
    int __wrap_##function(z_streamp stream, int flush) {         \
        unsigned char *before = stream->next_out;                \
        int status = __real_##function(stream, flush);           \
        stored_stream(stream, before);                           \
        return status;                                           \
    }
STREAM(inflate)
STREAM(deflate)
RESULT(int, inflateInit2_, (z_streamp stream, int bits, const char *version, int size), (stream, bits, version, size),
       stored_stream(stream, NULL))
RESULT(int, deflateInit_, (z_streamp stream, int level, const char *version, int size), (stream, level, version, size),
       stored_stream(stream, NULL))
RESULT(int, deflateInit2_,
       (z_streamp stream, int level, int method, int bits, int memory, int strategy, const char *version, int size),
       (stream, level, method, bits, memory, strategy, version, size), stored_stream(stream, NULL))
RESULT(int, uncompress, (Bytef * out, uLongf *size, const Bytef *in, uLong in_size), (out, size, in, in_size), {
    STORED(size);
    __msan_unpoison(out, *size);
})
RESULT(int, deflateReset, (z_streamp stream), (stream), stored_stream(stream, NULL))

RESULT(zip_int64_t, zip_fread, (zip_file_t * file, void *data, zip_uint64_t size), (file, data, size),
       if (result > 0) __msan_unpoison(data, (size_t)result))
RESULT(int, zip_stat_index, (zip_t * archive, zip_uint64_t index, zip_flags_t flags, zip_stat_t *status),
       (archive, index, flags, status), {
           STORED(status);
           if (result == 0 && (status->valid & ZIP_STAT_NAME) != 0) stored_text(status->name);
       })
RESULT(int, zip_close, (zip_t * archive), (archive), )
RESULT(zip_t *, zip_fdopen, (int file, int flags, int *cause), (file, flags, cause), STORED(cause))

RESULT(json_t *, json_loadb, (const char *text, size_t size, size_t flags, json_error_t *failure),
       (text, size, flags, failure), STORED(failure))

RESULT(png_uint_32, png_get_text, (png_const_structrp png, png_inforp info, png_textp *texts, int *count),
       (png, info, texts, count), {
           STORED(texts);
           STORED(count);
       })
/* png_read_row() is not told the size of a row. */
static _Thread_local size_t row_size;
NO_RESULT(png_read_update_info, (png_structrp png, png_inforp info), (png, info),
          row_size = png_get_rowbytes(png, info))
NO_RESULT(png_read_row, (png_structrp png, png_bytep row, png_bytep shown), (png, row, shown),
          __msan_unpoison(row, row_size))
NO_RESULT(png_read_info, (png_structrp png, png_inforp info), (png, info), )
NO_RESULT(png_write_info, (png_structrp png, png_const_inforp info), (png, info), )

/* libpng takes its own memory, and not that of functions of twinbox, also in calls that are not among these. */
#define PNG_CREATE(function)                                                                                      \
    RESULT(png_structp, function,                                                                                 \
           (png_const_charp version, png_voidp problem, png_error_ptr fail, png_error_ptr warn, png_voidp memory, \
            png_malloc_ptr allocate, png_free_ptr release),                                                       \
           (version, problem, fail, warn, NULL, NULL, NULL), ((void)memory, (void)allocate, (void)release))
PNG_CREATE(png_create_read_struct_2)
PNG_CREATE(png_create_write_struct_2)

/* jansson fills what a function of twinbox gives it. */
static json_malloc_t take;
static void *take_initialised(size_t size) {
    void *block = take(size);
    if (block != NULL) __msan_unpoison(block, size);
    return block;
}
NO_RESULT(json_set_alloc_funcs, (json_malloc_t allocate, json_free_t release), (take_initialised, release),
          take = allocate == take_initialised ? malloc : allocate)

RESULT(int, yaml_parser_initialize, (yaml_parser_t * parser), (parser), STORED(parser))
RESULT(int, yaml_parser_parse, (yaml_parser_t * parser, yaml_event_t *event), (parser, event), {
    STORED(parser);
    STORED(event);
    if (result != 0 && event->type == YAML_SCALAR_EVENT)
        __msan_unpoison(event->data.scalar.value, event->data.scalar.length + 1);
})

/* clang 14 knows other names of these than today's C library has. */
RESULT(int, stat, (const char *path, struct stat *status), (path, status), STORED(status))
RESULT(int, lstat, (const char *path, struct stat *status), (path, status), STORED(status))
RESULT(int, fstat, (int file, struct stat *status), (file, status), STORED(status))
RESULT(int, fstatat, (int folder, const char *path, struct stat *status, int flags), (folder, path, status, flags),
       STORED(status))

RESULT(gsl_multilarge_nlinear_parameters, gsl_multilarge_nlinear_default_parameters, (void), (), STORED(&result))
RESULT(int, gsl_fit_linear,
       (const double *x, size_t x_step, const double *y, size_t y_step, size_t count, double *c0, double *c1,
        double *cov00, double *cov01, double *cov11, double *sum),
       (x, x_step, y, y_step, count, c0, c1, cov00, cov01, cov11, sum), {
           STORED(c0);
           STORED(c1);
           STORED(cov00);
           STORED(cov01);
           STORED(cov11);
           STORED(sum);
       })
