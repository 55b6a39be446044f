/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Videos of a PNG sequence: by ffmpeg, or raw frames as y4m. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/process.h"
#include "base/numbers.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/png.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ARGUMENTS_MAX = 64, DRAFT_NAME_SIZE = 64, WORDS_SIZE = 1024 };

typedef struct VideoFormat {
    const char *ending, *muxer; /* ffmpeg's name of the format */
    bool subsampled;            /* 4:2:0 subsampling: both sides must be even */
    double max_rate;            /* highest frame rate, Hz; 0: any */
    double usual_rate;          /* the same unless a rate was chosen */
    const char *encoder[24];    /* arguments for ffmpeg */
    const char *ahead;          /* its argument for the number of frames that it looks ahead; NULL: none */
    int ahead_frames;           /* how many of full HD it may keep */
} VideoFormat;

/* Convert to BT.709 and tag the stream: untagged, players guess the matrix from the picture size. FFmpeg 5 takes the
   tags from options, FFmpeg 7 from frames. */
#define BT709                                                                                                      \
    "-vf", "scale=out_color_matrix=bt709,setparams=color_primaries=bt709:color_trc=bt709", "-colorspace", "bt709", \
        "-color_primaries", "bt709", "-color_trc", "bt709"

/* GIFs are for pages, where 800 pixels are wide, and their bytes grow with every pixel that changes. */
#define GIF_SCALE "scale=w='min(800,iw)':h='min(800,ih)':force_original_aspect_ratio=decrease:flags=area"

/* H.264: `veryfast` with crf 16 takes 0.65 of the time that `medium`, the default, takes with 18. Brightness comes as
   near (SSIM); files are 15 to 20% larger. */
static const VideoFormat formats[] = {
    {".mp4",
     "mp4",
     true,
     0,
     0,
     {BT709, "-c:v", "libx264", "-preset", "veryfast", "-crf", "16", "-pix_fmt", "yuv420p", "-movflags", "+faststart"},
     "-rc-lookahead",
     40},
    {".webm",
     "webm",
     true,
     0,
     0,
     /* bitexact: the file has no random number. */
     {BT709, "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-cpu-used", "4", "-pix_fmt", "yuv420p",
      "-fflags", "+bitexact"},
     "-lag-in-frames",
     25},
    /* Viewers slow down frames of 1/100 s to 1/10 s. Without dithering, areas of one colour stay uniform and small. */
    {".gif",
     "gif",
     false,
     50,
     25,
     {"-lavfi", GIF_SCALE "[x];[x][1:v]paletteuse=dither=none", "-fps_mode", "passthrough"},
     NULL,
     0},
};

static const VideoFormat *find_format(const char *path) {
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (file_name_ends_with(path, formats[i].ending)) return &formats[i];
    return NULL;
}

bool video_check_format(const char *path, int width, int height, Error *error) {
    const VideoFormat *format = find_format(path);
    if (format == NULL) return error_input(error, path, "the name of a video must end in .mp4, .webm or .gif");
    return !format->subsampled || (width % 2 == 0 && height % 2 == 0) ||
           error_input(error, path, "width and height must be even for this video format (got %dx%d)", width, height);
}

bool video_check(const char *path, int width, int height, Error *error) {
    struct stat status;
    char folder[PATH_MAX] = ".";
    const size_t length = file_folder_length(path);
    if (!video_check_format(path, width, height, error)) return false;
    if (strlen(path) >= PATH_MAX) return error_input(error, path, "the name is too long");
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) return error_input(error, path, "is not a regular file");
    if (length > 0) snprintf(folder, sizeof folder, "%.*s", (int)length, path);
    if (access(folder, W_OK) == 0) return true;
    if (errno != ENOENT) return error_system(error, path, "cannot write there: %s", strerror(errno));
    return file_make_directory(folder, error); /* a missing folder now, so that an error appears before the drawing */
}

bool video_check_programs(Error *error) {
    static const char *const names[] = {"ffmpeg", "ffprobe"};
    for (int i = 0; i < 2; i++) {
        const char *argv[] = {names[i], "-version", NULL};
        Process process;
        char text[256];
        if (!process_start(&process, argv, error) || !process_finish(&process, text, sizeof text, error)) return false;
    }
    return true;
}

/* Every picture is read back and checked, one after another. */

static Image *read_frame(const VideoOptions *options, int index, Error *error) {
    char path[PATH_MAX];
    if (!sink_frame_path(path, sizeof path, options->directory, index))
        return error_input(error, options->directory, "the name is too long"), NULL;
    return image_read_png(path, error);
}

/* The size of the first picture, which all must have. */
static bool find_size(const VideoOptions *options, int *width, int *height, Error *error) {
    Image *first = read_frame(options, options->first, error);
    if (first == NULL) return false;
    *width = first->width;
    *height = first->height;
    image_destroy(first);
    return true;
}

/* Consumes a picture; false if it needs no more. */
typedef bool WriteFrame(void *context, const Image *image);

/* Passes every stride-th picture to `write`, after checking its size and pixels. Sets *stopped if it returned false. */
static bool feed(const VideoOptions *options, int stride, int width, int height, WriteFrame *write, void *context,
                 bool *stopped, const Progress *progress, Error *error) {
    *stopped = false;
    for (int index = options->first; !*stopped && index <= options->last; index += stride) {
        Image *image = read_frame(options, index, error);
        bool ok = image != NULL;
        if (ok && (image->width != width || image->height != height))
            ok = error_input(error, options->directory, "frame %d is %dx%d, but the first is %dx%d", index,
                             image->width, image->height, width, height);
        if (ok && options->hashes != NULL && image_hash(image) != options->hashes[index - options->first].pixels)
            ok = error_input(error, options->directory, "the pixels of frame %d differ from those drawn", index);
        if (ok) *stopped = !write(context, image);
        image_destroy(image);
        if (!ok) return false;
        if (!progress_report(progress, index - options->first + 1, options->last - options->first + 1))
            return error_interrupted(error, options->path, "stopped");
    }
    return true;
}

/* Arguments of a program, terminated by NULL. */
typedef struct Arguments {
    const char *list[ARGUMENTS_MAX];
    int count;
} Arguments;

static void add(Arguments *arguments, const char *const *more) {
    for (; *more != NULL; more++) arguments->list[arguments->count++] = *more;
    arguments->list[arguments->count] = NULL;
}

#define ADD(arguments, ...) add((arguments), (const char *const[]){__VA_ARGS__, NULL})

/* State of one encoding. */
typedef struct Encoding {
    const VideoOptions *options;
    const VideoFormat *format;
    int width, height, stride;
    /* Drafts (base/file.h), and the names under which ffmpeg opens them. A program that is killed leaves neither. */
    int draft, palette_draft;
    char part[DRAFT_NAME_SIZE], palette[DRAFT_NAME_SIZE];
    char *words; /* [WORDS_SIZE] of ffmpeg, which ends with status 0 also after some failures to write */
    const Progress *progress;
} Encoding;

typedef struct RawTarget {
    Process process;
    uint8_t *rgb;
} RawTarget;

static bool write_raw(void *context, const Image *image) {
    RawTarget *target = context;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) memcpy(target->rgb + 3 * i, image->pixels + 4 * i, 3);
    return process_write(&target->process, target->rgb, 3 * pixels);
}

/* Feeds all pictures to an ffmpeg with these further arguments. */
static bool run_ffmpeg(const Encoding *encoding, const char *const *format_arguments, const char *output,
                       Error *error) {
    enum { FULL_HD = 1920 * 1080, AHEAD_LEAST = 2 };
    const VideoFormat *format = encoding->format;
    const long pixels = (long)encoding->width * encoding->height;
    char size[32], rate[32], ahead[16], seconds[16];
    Arguments arguments = {0};
    snprintf(size, sizeof size, "%dx%d", encoding->width, encoding->height);
    snprintf(rate, sizeof rate, "%.0f/%d", 1000 * encoding->options->frame_rate, 1000 * encoding->stride);
    ADD(&arguments, "ffmpeg", "-y", "-v", "error", "-f", "rawvideo", "-pixel_format", "rgb24");
    ADD(&arguments, "-video_size", size, "-framerate", rate, "-i", "-");
    add(&arguments, format_arguments);
    if (format->ahead != NULL && pixels > FULL_HD) {
        /* An encoder keeps the frames that it looks ahead, and more for each thread. Of frames larger than full HD it
           keeps no more pixels than it may of full HD, in as many threads on every machine; otherwise 3840x2160 takes
           1.7 GB with two cores. */
        const long frames = format->ahead_frames * (long)FULL_HD / pixels;
        snprintf(ahead, sizeof ahead, "%ld", frames > AHEAD_LEAST ? frames : AHEAD_LEAST);
        ADD(&arguments, format->ahead, ahead, "-threads", "4");
    }
    if (format->ahead != NULL) { /* a key frame at least each second: players seek from one to the next */
        snprintf(seconds, sizeof seconds, "%.0f", fmax(1, floor(encoding->options->frame_rate / encoding->stride)));
        ADD(&arguments, "-g", seconds);
    }
    ADD(&arguments, output);
    RawTarget target = {.rgb = malloc(3 * (size_t)pixels)};
    if (target.rgb == NULL) return error_memory(error, encoding->options->path);
    bool stopped, ok = process_start(&target.process, arguments.list, error);
    if (ok && !feed(encoding->options, encoding->stride, encoding->width, encoding->height, write_raw, &target,
                    &stopped, encoding->progress, error)) {
        process_kill(&target.process);
        ok = false;
    }
    free(target.rgb);
    if (!ok || !process_finish(&target.process, encoding->words, WORDS_SIZE, error)) return false;
    return !stopped || error_system(error, "ffmpeg", "stopped reading before the last frame\n%s", encoding->words);
}

/* Counts the frames by decoding the video. */
static bool count_frames(const char *path, int *count, Error *error) {
    Arguments arguments = {0};
    ADD(&arguments, "ffprobe", "-v", "error", "-select_streams", "v:0", "-count_frames", "-show_entries");
    ADD(&arguments, "stream=nb_read_frames", "-of", "default=noprint_wrappers=1", path);
    Process ffprobe;
    char text[8192];
    if (!process_start(&ffprobe, arguments.list, error) || !process_finish(&ffprobe, text, sizeof text, error))
        return false;
    /* Among warnings, of its own or of the loader of programs. */
    static const char key[] = "nb_read_frames=";
    const char *found = strstr(text, key);
    *count = found != NULL ? atoi(found + strlen(key)) : 0;
    return true;
}

static bool encode(const Encoding *encoding, Error *error) {
    static const char filter[] = GIF_SCALE ",palettegen=stats_mode=full";
    static const char *const find[] = {"-vf", filter, "-frames:v", "1", "-c:v", "png", "-f", "image2pipe", NULL};
    const VideoOptions *options = encoding->options;
    const int wanted = (options->last - options->first) / encoding->stride + 1;
    Arguments use = {0};
    /* A GIF has 256 colours: the first pass finds the palette, the second applies it. */
    if (strcmp(encoding->format->ending, ".gif") == 0) {
        if (!run_ffmpeg(encoding, find, encoding->palette, error)) return false;
        ADD(&use, "-f", "png_pipe", "-i", encoding->palette);
    }
    add(&use, encoding->format->encoder);
    ADD(&use, "-f", encoding->format->muxer);
    int count;
    if (!run_ffmpeg(encoding, use.list, encoding->part, error) || !count_frames(encoding->part, &count, error))
        return false;
    if (count != wanted) {
        error_system(error, options->path, "the video has %d frames (expected %d)", count, wanted);
        if (encoding->words[0] != '\0') error_add(error, "\n%s", encoding->words);
        return false;
    }
    return file_draft_publish(encoding->draft, options->path, error);
}

/* Opened by ffmpeg through this process, so that no name is left when that is killed. The prefix "file:" prevents
   ffmpeg from reading the name as that of a protocol. */
static bool open_draft(int *draft, char name[DRAFT_NAME_SIZE], const char *path, Error *error) {
    *draft = file_draft(path, error);
    snprintf(name, DRAFT_NAME_SIZE, "file:/proc/%ld/fd/%d", (long)getpid(), *draft);
    return *draft >= 0;
}

bool video_encode(const VideoOptions *options, const Progress *progress, Error *error) {
    Encoding encoding = {.options = options, .stride = 1, .progress = progress};
    if (!find_size(options, &encoding.width, &encoding.height, error) ||
        !video_check(options->path, encoding.width, encoding.height, error))
        return false;
    encoding.format = find_format(options->path);
    const double most = options->rate_is_chosen ? encoding.format->max_rate : encoding.format->usual_rate;
    /* 1e-3: tolerance for rounding of the frame rate. */
    if (most > 0) encoding.stride = (int)fmax(1, ceil(options->frame_rate / most - 1e-3));
    char words[WORDS_SIZE] = "";
    encoding.words = words;
    encoding.draft = encoding.palette_draft = -1;
    const bool ok = open_draft(&encoding.draft, encoding.part, options->path, error) &&
                    open_draft(&encoding.palette_draft, encoding.palette, options->path, error) &&
                    encode(&encoding, error);
    if (encoding.draft >= 0) close(encoding.draft);
    if (encoding.palette_draft >= 0) close(encoding.palette_draft);
    return ok;
}

/* YUV4MPEG2, a format that video programs read from a pipe. 4:4:4, 8 bits, ITU-R BT.709, limited range, exact
   values rounded to nearest, halves up:

     Y = 16 + 219 L, Cb = 128 + 224 (B - L) / 1.8556, Cr = 128 + 224 (R - L) / 1.5748,
     L = 0.2126 R + 0.7152 G + 0.0722 B

   with R, G, B = channel / 255. The format has no field that marks BT.709. */

static const char frame_line[] = "FRAME\n";
enum { HEADER_SIZE = 128, FRAME_LINE_SIZE = sizeof frame_line - 1 };

/* a / b rounded to the nearest integer; b > 0 and even. */
static int nearest(int a, int b) { return (a + b / 2 + 256 * b) / b - 256; }

typedef struct Y4mTarget {
    int file;
    int cause; /* errno of a failed write */
    size_t size;
    uint8_t *frame;
} Y4mTarget;

static bool write_y4m_frame(void *context, const Image *image) {
    Y4mTarget *target = context;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    memcpy(target->frame, frame_line, FRAME_LINE_SIZE);
    uint8_t *y = target->frame + FRAME_LINE_SIZE, *cb = y + pixels, *cr = cb + pixels;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *rgb = image->pixels + 4 * i;
        /* In 1/10000 of a channel's step. */
        int light = 2126 * rgb[0] + 7152 * rgb[1] + 722 * rgb[2];
        y[i] = (uint8_t)(16 + nearest(219 * light, 255 * 10000));
        cb[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[2] - light), 255 * 18556));
        cr[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[0] - light), 255 * 15748));
    }
    if (file_write_all(target->file, target->frame, target->size)) return true;
    target->cause = errno;
    return false;
}

bool video_write_y4m(const VideoOptions *options, int file, const Progress *progress, Error *error) {
    int width, height;
    char header[HEADER_SIZE];
    if (!find_size(options, &width, &height, error)) return false;
    const size_t size = FRAME_LINE_SIZE + 3 * (size_t)width * (size_t)height;
    uint8_t *frame = malloc(size);
    Y4mTarget target = {.file = file, .size = size, .frame = frame};
    if (frame == NULL) return error_memory(error, options->path);
    const int64_t rate = (int64_t)(1000 * options->frame_rate + 0.5), divisor = greatest_divisor(rate, 1000);
    snprintf(header, sizeof header, "YUV4MPEG2 W%d H%d F%" PRId64 ":%" PRId64 " Ip A1:1 C444 XCOLORRANGE=LIMITED\n",
             width, height, rate / divisor, 1000 / divisor);
    bool stopped = !file_write_all(file, header, strlen(header)), ok = true;
    if (stopped) target.cause = errno;
    if (!stopped) ok = feed(options, 1, width, height, write_y4m_frame, &target, &stopped, progress, error);
    free(frame);
    return ok && (!stopped || error_system(error, options->path, "cannot write: %s", strerror(target.cause)));
}
