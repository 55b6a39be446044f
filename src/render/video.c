/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/video.h"

#include "common/file.h"
#include "common/process.h"
#include "image/image.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

bool video_check(const char *path, int width, int height, Error *error) {
    size_t length = strlen(path);
    if (length <= 4 || strcmp(path + length - 4, ".mp4") != 0)
        return error_input(error, path, "the name of a video ends in .mp4");
    if (length >= PATH_SIZE - 32) return error_input(error, path, "the name is too long");
    if (width % 2 != 0 || height % 2 != 0)
        return error_input(error, path, "a video needs even width and height (got %dx%d)", width, height);
    return true;
}

static Image *read_frame(const VideoOptions *options, int frame, Error *error) {
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/frame_%06d.png", options->directory, frame) >= (int)sizeof path) {
        error_input(error, options->directory, "the name is too long");
        return NULL;
    }
    return image_read_png(path, error);
}

static bool write_frame(Process *ffmpeg, const Image *image, uint8_t *rgb) {
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) memcpy(rgb + 3 * i, image->pixels + 4 * i, 3);
    return process_write(ffmpeg, rgb, 3 * pixels);
}

/* Sends all frames; all must be of the first one's size. *stopped is set where ffmpeg stopped reading. */
static bool send_frames(Process *ffmpeg, const VideoOptions *options, int width, int height, bool *stopped,
                        const Progress *progress, Error *error) {
    uint8_t *rgb = malloc(3 * (size_t)width * (size_t)height);
    if (rgb == NULL) return error_memory(error, options->path);
    bool ok = true;
    for (int frame = options->first; ok && !*stopped && frame <= options->last; frame++) {
        Image *image = read_frame(options, frame, error);
        ok = image != NULL;
        if (ok && (image->width != width || image->height != height))
            ok = error_input(error, options->directory, "frame %d is %dx%d, the first one %dx%d", frame, image->width,
                             image->height, width, height);
        if (ok) *stopped = !write_frame(ffmpeg, image, rgb);
        image_destroy(image);
        if (ok && !progress_report(progress, frame - options->first + 1, options->last - options->first + 1))
            ok = error_input(error, options->path, "stopped");
    }
    free(rgb);
    return ok;
}

/* Frames that a decoder finds in the video. */
static bool count_frames(const char *path, int *count, Error *error) {
    const char *argv[] = {"ffprobe",
                          "-v",
                          "error",
                          "-select_streams",
                          "v:0",
                          "-count_frames",
                          "-show_entries",
                          "stream=nb_read_frames",
                          "-of",
                          "csv=p=0",
                          path,
                          NULL};
    Process ffprobe;
    char text[256];
    if (!process_start(&ffprobe, argv, error) || !process_finish(&ffprobe, text, sizeof text, error)) return false;
    *count = atoi(text);
    return true;
}

static bool run_ffmpeg(const VideoOptions *options, const char *part, int width, int height, const Progress *progress,
                       Error *error) {
    char size[32], rate[32];
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.0f/1000", 1000 * options->frame_rate);
    /* BT.709 said and meant: players otherwise guess the matrix by the size of the picture. */
    const char *argv[] = {"ffmpeg",
                          "-y",
                          "-v",
                          "error",
                          "-f",
                          "rawvideo",
                          "-pixel_format",
                          "rgb24",
                          "-video_size",
                          size,
                          "-framerate",
                          rate,
                          "-i",
                          "-",
                          "-vf",
                          "scale=out_color_matrix=bt709",
                          "-colorspace",
                          "bt709",
                          "-color_primaries",
                          "bt709",
                          "-color_trc",
                          "bt709",
                          "-c:v",
                          "libx264",
                          "-crf",
                          "18",
                          "-pix_fmt",
                          "yuv420p",
                          "-movflags",
                          "+faststart",
                          part,
                          NULL};
    Process ffmpeg;
    if (!process_start(&ffmpeg, argv, error)) return false;
    bool stopped = false;
    if (!send_frames(&ffmpeg, options, width, height, &stopped, progress, error)) {
        process_kill(&ffmpeg);
        return false;
    }
    char text[1024];
    if (!process_finish(&ffmpeg, text, sizeof text, error)) return false;
    return !stopped || error_system(error, "ffmpeg", "stopped reading before the last frame\n%s", text);
}

static bool encode_to(const VideoOptions *options, const char *part, const Progress *progress, Error *error) {
    Image *first = read_frame(options, options->first, error);
    if (first == NULL) return false;
    int width = first->width, height = first->height, wanted = options->last - options->first + 1, count;
    image_destroy(first);
    if (!video_check(options->path, width, height, error) ||
        !run_ffmpeg(options, part, width, height, progress, error) || !count_frames(part, &count, error))
        return false;
    if (count != wanted) return error_system(error, options->path, "the video has %d frames of %d", count, wanted);
    return rename(part, options->path) == 0 || error_system(error, options->path, "%s", strerror(errno));
}

bool video_encode(const VideoOptions *options, const Progress *progress, Error *error) {
    char part[PATH_SIZE];
    snprintf(part, sizeof part, "%.*s.%ld.part.mp4", PATH_SIZE - 32, options->path, (long)getpid());
    bool ok = encode_to(options, part, progress, error);
    if (!ok) unlink(part);
    return ok;
}
