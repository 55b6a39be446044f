/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the seconds that a sequence takes in two processes, from their start until the files are on disk. Last
   argument: "own" for twinbox's encoder, "isal" for ISA-L (igzip) at level 1 without filters. The rest is the same.
   ISA-L gets the same advantages: rows are kept and only changed ones are packed again, it computes the checksums, and
   its output is not copied. */
#include "runs.h"

#include "base/file.h"
#include "base/hash.h"
#include "pictures/render_internal.h"
#include "pictures/render.h"

#include <isa-l.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    WORKERS = 2,
    IHDR_AT = 8,                /* after the signature */
    IDAT_AT = IHDR_AT + 13 + 12 /* a chunk has 12 bytes besides its data */
};

typedef struct IsalSink {
    const char *directory;
    int first, behind;
    uint8_t *rows, *file, *level_buffer;
    size_t rows_size, room; /* room: for compressed rows */
} IsalSink;

static void name_frame(const IsalSink *sink, int frame, char path[512]) {
    snprintf(path, 512, "%s/frame_%06d.png", sink->directory, frame);
}

static void put_number(uint8_t *to, size_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Completes a chunk whose data are at chunk + 8; returns the bytes of the whole chunk. */
static size_t close_chunk(uint8_t *chunk, const char *type, size_t size) {
    put_number(chunk, size);
    memcpy(chunk + 4, type, 4);
    put_number(chunk + 8 + size, crc32_gzip_refl(0, chunk + 4, size + 4));
    return size + 12;
}

static void pack_rows(IsalSink *sink, const Image *image, const bool *changed) {
    size_t width = (size_t)image->width;
    for (size_t y = 0; y < (size_t)image->height; y++) {
        if (changed != NULL && !changed[y]) continue;
        const uint8_t *from = image->pixels + 4 * width * y;
        uint8_t *to = sink->rows + (3 * width + 1) * y;
        *to++ = 0; /* the filter */
        for (size_t x = 0; x < width; x++) memcpy(to + 3 * x, from + 4 * x, 3);
    }
}

static bool compress_rows(IsalSink *sink, size_t *size, Error *error) {
    struct isal_zstream stream;
    isal_deflate_stateless_init(&stream);
    stream.level = 1;
    stream.level_buf = sink->level_buffer;
    stream.level_buf_size = ISAL_DEF_LVL1_DEFAULT;
    stream.gzip_flag = IGZIP_ZLIB;
    stream.end_of_stream = 1;
    stream.next_in = sink->rows;
    stream.avail_in = (uint32_t)sink->rows_size;
    stream.next_out = sink->file + IDAT_AT + 8;
    stream.avail_out = (uint32_t)sink->room;
    if (isal_deflate_stateless(&stream) != COMP_OK) return error_system(error, "isal", "cannot compress a frame");
    *size = stream.total_out;
    return true;
}

static bool write_isal(IsalSink *sink, int frame, const Image *image, const bool *changed, const ImageText *texts,
                       int count, uint64_t *hash, Error *error) {
    char path[512];
    size_t compressed, size = IDAT_AT;
    (void)texts, (void)count;
    pack_rows(sink, image, changed);
    if (!compress_rows(sink, &compressed, error)) return false;
    size += close_chunk(sink->file + size, "IDAT", compressed);
    size += close_chunk(sink->file + size, "IEND", 0);
    if (sink->behind == 0) sink->first = frame;
    sink->behind = frame + 1;
    name_frame(sink, frame, path);
    *hash = hash_xxh3(sink->file, size);
    return file_write_soon(path, sink->file, size, error);
}

static bool close_isal(IsalSink *sink, Error *error) {
    char path[512];
    bool ok = true;
    for (int frame = sink->first; ok && frame < sink->behind; frame++) {
        name_frame(sink, frame, path);
        ok = file_sync(path, error);
    }
    ok = ok && file_sync(sink->directory, error);
    free(sink->rows);
    free(sink->file);
    free(sink->level_buffer);
    return ok;
}

static bool open_isal(IsalSink *sink, const Job *job, Error *error) {
    size_t rows_size = (size_t)job->height * (3 * (size_t)job->width + 1), room = rows_size + rows_size / 8 + 1024;
    *sink = (IsalSink){.directory = job->directory, .rows_size = rows_size, .room = room};
    sink->rows = malloc(rows_size);
    sink->file = malloc(IDAT_AT + room + 24);
    sink->level_buffer = malloc(ISAL_DEF_LVL1_DEFAULT);
    if (sink->rows == NULL || sink->file == NULL || sink->level_buffer == NULL) return error_memory(error, "isal");
    memcpy(sink->file, "\x89PNG\r\n\x1a\n", 8);
    uint8_t *header = sink->file + IHDR_AT;
    put_number(header + 8, (size_t)job->width);
    put_number(header + 12, (size_t)job->height);
    memcpy(header + 16, "\x08\x02\0\0\0", 5); /* 8 bits, RGB, the only methods, not interlaced */
    close_chunk(header, "IHDR", 13);
    return true;
}

static bool draw_range(const Picture *picture, const Job *job, bool own, int first, int behind, Error *error) {
    RenderOptions options = {.width = job->width, .height = job->height};
    FrameSink frames;
    IsalSink isal;
    const bool *changed;
    uint64_t hash;
    Renderer *renderer = renderer_create_planned(picture, &options, error);
    Image *image = renderer == NULL ? NULL : image_create(job->width, job->height, error);
    if (image == NULL || !(own ? sink_open(&frames, job->directory, job->width, job->height, PNG_FAST, error)
                               : open_isal(&isal, job, error)))
        return false;
    bool ok = true;
    for (int frame = first; ok && frame < behind; frame++)
        ok = renderer_draw_next(renderer, moment_stored(frame), image, &changed, error) &&
             (own ? sink_write(&frames, frame, image, changed, NULL, 0, &hash, error)
                  : write_isal(&isal, frame, image, changed, NULL, 0, &hash, error));
    ok = (own ? sink_close(&frames, error) : close_isal(&isal, error)) && ok;
    image_destroy(image);
    renderer_destroy(renderer);
    return ok;
}

static void start_worker(const Picture *picture, const Job *job, bool own, int index) {
    Error error = {0};
    if (fork() != 0) return;
    if (draw_range(picture, job, own, job->frames * index / WORKERS, job->frames * (index + 1) / WORKERS, &error))
        _exit(0);
    fprintf(stderr, "%s\n", error.message);
    _exit(3);
}

int main(int argc, char **argv) {
    Job job = job_read(argc - 1, argv);
    bool own = strcmp(argv[argc - 1], "own") == 0;
    Error error = {0};
    Picture picture;
    const Trajectory *const panels[PANELS] = {job.runs[0], job.runs[1]};
    int ended = 0;
    double start = clock_seconds();
    if (!picture_plan(&picture, panels, PANELS, job.width, job.height, &error)) return 3;
    for (int i = 0; i < WORKERS; i++) start_worker(&picture, &job, own, i);
    for (int status; wait(&status) > 0;) ended += status == 0;
    printf("%.6f\n", clock_seconds() - start);
    job_free(&job);
    return ended == WORKERS ? 0 : 3;
}
