/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expected pictures against actual ones, frame by frame, and why they differ: the renderer changed where pixels differ
   and the states of the bodies do not, the physics where states differ. States are told by trajectories beside the
   frames, those of the same name in both folders, and by the texts "State" of our pictures; where there are neither, it is
   only known that pictures differ. */
#pragma once
#include "common/progress.h"
#include "image/mask.h"
#include "image/sequence.h"
#include "trajectory/trajectory.h"

typedef struct RegressionOptions {
    int max_difference; /* of a channel, 0..255, and */
    double max_share;   /* of the pixels that are not masked, 0..1: frames that keep to both pass */
    const Mask *mask;
    int64_t max_pixels; /* of a picture; larger ones are refused before anything is inflated */
} RegressionOptions;

typedef enum RegressionSide { EXPECTED, ACTUAL, SIDES } RegressionSide;

typedef enum PixelVerdict {
    PIXELS_EQUAL,
    PIXELS_WITHIN, /* other ones, within the options */
    PIXELS_DIFFER,
    PIXELS_RESIZED,
    PIXELS_MISSING, /* there is no actual picture */
    PIXELS_EXTRA    /* there is no expected one */
} PixelVerdict;

/* What is drawn of one frame may hang on the whole run: the camera, a scale. So where the run differs elsewhere, and no
   frame of the sequence has equal states and equal pixels, the renderer is not blamed for a frame of equal states. */
typedef enum StateVerdict { STATES_UNKNOWN, STATES_EQUAL, STATES_DIFFER, STATES_DIFFER_ELSEWHERE } StateVerdict;

/* What a file was when it was read. */
typedef struct RegressionFile {
    uint64_t hash; /* XXH3 of its bytes */
    size_t size;
    int width, height; /* of a picture, where it was decoded: files equal byte by byte are not */
} RegressionFile;

typedef struct RegressionFrame {
    const SequenceFrame *at[SIDES]; /* one is NULL for a frame that is missing or extra */
    RegressionFile files[SIDES];
    PixelVerdict pixels;
    StateVerdict states;
    int panel; /* the first whose text "State" differs, from 1; else 0 */
    ImageDifference difference;
    double flip;      /* measured by the report (image/flip.h); else NAN */
    bool run_differs; /* a trajectory of its scene does, in whatever frame */
    bool shown;       /* in the report */
    char *refusal;    /* why a picture could not be read; ends the whole */
} RegressionFrame;

/* A trajectory that lies in both folders. */
typedef struct RegressionRun {
    char *name;
    RegressionFile files[SIDES];
    TrajectoryDifference difference;
    char scene[TRAJECTORY_NAME_SIZE];
    int frames;    /* of both together; 0 where nothing differs */
    bool *differs; /* [frames] */
} RegressionRun;

typedef struct Regression {
    RegressionOptions options;
    ImageSequence *sequences[SIDES];
    int count, run_count;
    RegressionFrame *frames;                  /* by stem, then number */
    RegressionRun *runs;                      /* by name */
    int failed;                               /* frames */
    int by_verdict[6];                        /* frames, by PixelVerdict */
    int renderer, physics, unknown;           /* frames in which this changed, or it is not known what */
    int first_renderer, first_physics, first; /* the first such frames, and of all that failed; -1: none */
    int run_failed, first_run; /* trajectories that differ, and that which does so in the earliest frame; -1 */
} Regression;

/* Compares two folders, or two files, by all threads. Files that are equal byte by byte are not decoded. False with error
   set (the first, by the order of frames) where a file cannot be read or progress asks to stop; then nothing is to be
   freed. */
bool regression_run(Regression *regression, const char *expected, const char *actual, const RegressionOptions *options,
                    const Progress *progress, Error *error);
void regression_free(Regression *regression);

bool regression_passed(const Regression *regression);
bool frame_failed(const RegressionFrame *frame);
const char *frame_name(const RegressionFrame *frame); /* of the expected file, or of the extra one */

/* "equal", "within tolerance", "renderer changed", "physics changed", "pictures differ", "missing", "extra" */
const char *frame_verdict(const RegressionFrame *frame);

/* The figures of a frame, or how a run differs, in words. */
typedef struct RegressionText {
    char text[512];
} RegressionText;
RegressionText frame_words(const RegressionFrame *frame);
RegressionText run_words(const RegressionRun *run);

/* The verdict of the whole: "equal", or what changed and what is missing; and where it begins, one line each. */
RegressionText regression_verdict(const Regression *regression);
RegressionText regression_begin(const Regression *regression);
