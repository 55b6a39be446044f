/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws trajectories in panels side by side, with the same camera. The same trajectories give the same pixels on
   every machine. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <stdint.h>

/* Hashes of a picture's pixels and of its file (XXH3 of the bytes). */
typedef struct PictureHashes {
    uint64_t pixels, file;
} PictureHashes;

/* Result of render_sequence(). */
typedef struct RenderResult {
    int first, last;       /* indices of the files */
    double rate;           /* pictures per second of the film */
    int kept;              /* of these, unchanged from an earlier call */
    char why[256];         /* options->resume: why nothing could be kept; otherwise empty */
    PictureHashes *hashes; /* [last - first + 1]; freed by the caller */
} RenderResult;

/* Writes directory/frame_000000.png, ...: the moments of the longest of 1 to 6 runs, or of the selected
   frames, numbered from the first one; a shorter run shows its last frame. Without slow motion, hold and cards, file
   k is frame k. manifest.json describes the pictures. Child processes draw, so the caller's environment
   and threads are unaffected. Progress counts pictures; if it cancels, the pictures in progress are finished and the
   error is "stopped" (ERROR_INTERRUPTED). `result` may be NULL.
   If that is the whole run, frames of an earlier sequence that would remain beside these are removed.
   options->resume keeps the pictures of an earlier call, even one that was killed, whose files are unchanged, and
   draws all others. If that call had other runs or options or was another version, it draws all. */
bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     RenderResult *result, const Progress *progress, Error *error);

typedef struct Renderer Renderer;

/* Draws single frames in this process; only width, height and context of the options are used. The trajectories must
   outlive the renderer. Sets Mesa's environment variables. */
Renderer *renderer_create(const Trajectory *const *panels, int panel_count, const RenderOptions *options, Error *error);

/* Draws a frame; the image must have the renderer's size. */
bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error);
void renderer_destroy(Renderer *renderer);

/* Converts a PNG sequence to a video: H.264, VP9 and GIF by ffmpeg, or raw frames (y4m) for other programs. */

typedef struct VideoOptions {
    const char *directory;       /* of frame_000000.png ... */
    int first, last;             /* pictures, inclusive */
    double frame_rate;           /* Hz */
    const PictureHashes *hashes; /* [last - first + 1], as drawn; NULL: not checked */
    const char *path;            /* ends in .mp4, .webm or .gif */
    bool rate_is_chosen;         /* not just that of the run */
} VideoOptions;

/* Checks name and size of a video. ERROR_INPUT states the reason. */
bool video_check_format(const char *path, int width, int height, Error *error);

/* The same, and creates its folder if missing. ERROR_INPUT or ERROR_SYSTEM. */
bool video_check(const char *path, int width, int height, Error *error);

/* Checks that ffmpeg and ffprobe can be run. */
bool video_check_programs(Error *error);

/* Every picture is decoded and checked here and passed on raw, as ffmpeg skips missing or damaged PNGs. The video's
   frames are counted before the file appears. A GIF is scaled to at most 800 x 800 pixels and shows every n-th
   picture, at most 25 per second: every third of 60 Hz; up to 50, what its time unit allows, if the rate is chosen. */
bool video_encode(const VideoOptions *options, const Progress *progress, Error *error);

/* Writes the same pictures as y4m to an open file; options->path is its name in messages. The output is written in
   place, not renamed when complete. A closed pipe is an error if SIGPIPE is ignored. */
bool video_write_y4m(const VideoOptions *options, int file, const Progress *progress, Error *error);

/* The order of moments in a video: title card, the run with slow motion around the impact, its last frame held, end
   card. In closed form, without a list.

   In real time, picture p of the run is shown p / rate seconds after its first. The frame there is p * step / per,
   exactly; poses between two frames are interpolated. Without options, step = per = 1 and the pictures are the
   frames. */

typedef struct MomentPlan {
    int first, last;           /* frames of the run, inclusive */
    int slow;                  /* slow-motion factor; 1: none */
    int slow_first, slow_last; /* range of frames; equal if there is no slow motion */
    int title, run, hold, end; /* number of pictures */
    double rate;               /* pictures per second */
    int64_t step, per;         /* in lowest terms: the run advances by step / per frames per picture */
    double speed;              /* s of the run per s of the film, apart from slow motion */
} MomentPlan;

/* Plans these frames. The impact is the first one in any panel; without one there is no slow motion. ERROR_INPUT for
   options out of range, and for a duration that leaves the run less than two pictures. */
bool moments_plan(MomentPlan *plan, const Trajectory *const *panels, int panel_count, int first, int last,
                  const RenderOptions *options, Error *error);

/* The first frame in which any panel's bomb touches a dynamic body; -1: none. */
int moments_impact(const Trajectory *const *panels, int panel_count);

/* The index of the last picture. The first has the index of the first frame: without options, index and frame are
   equal. */
int moments_last(const MomentPlan *plan);

/* The moment of picture `index`, plan->first <= index <= moments_last(). */
Moment moments_at(const MomentPlan *plan, int index);

/* The bodies of one frame on a transparent background, without grid, axes or text: for figures. What their boxes are
   labelled with is text of the figure. */

/* The bodies to draw. */
typedef enum StillParts { STILL_FIXED = 1, STILL_MOVING = 2, STILL_ALL = 3 } StillParts;

typedef struct StillShot {
    const Trajectory *run;
    int frame;
    BodyColors colours; /* of the bodies */
    StillParts parts;
    Camera camera; /* for the whole image */
    LookLabels labels;
    double label_least; /* pixels: smaller letters are not drawn */
} StillShot;

typedef struct Still Still;

/* For images of this size, each side 1 .. RENDER_SIDE_MAX pixels. Sets Mesa's environment variables. */
Still *still_create(int width, int height, Error *error);
void still_destroy(Still *still);

/* Draws into an image of that size, with straight alpha. */
bool still_draw(Still *still, const StillShot *shot, Image *image, Error *error);

/* A label in the picture of that size: its middle and the size of its letters in pixels. */
typedef struct StillLabel {
    char text[64];
    Point at;
    double size;
    uint32_t ink;
} StillLabel;

/* The label of a body; false: it has none. */
bool still_label(const Still *still, const StillShot *shot, int body, StillLabel *label);

/* Output of finished frames. */

enum { SINK_NAME_SIZE = 32 };

/* "frame_000012.png", the file name of a picture. */
void sink_frame_name(char name[SINK_NAME_SIZE], int index);

/* The same with its folder; false if it does not fit in `size` bytes. */
bool sink_frame_path(char *path, size_t size, const char *directory, int index);

/* Whether the file of that picture exists and has these bytes (XXH3); false if the system cannot tell. */
bool sink_frame_is(const char *directory, int index, uint64_t hash);
