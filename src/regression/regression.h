/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A comparison of two folders, or of two files:

     Regression regression;
     RegressionOptions options = {.max_pixels = IMAGE_MAX_PIXELS};
     if (!regression_run(&regression, "expected", "actual", &options, NULL, error)) ...
     bool passed = regression_passed(&regression);
     for (int i = 0; i < regression.count; i++) puts(frame_words(&regression.frames[i]).text);
     regression_free(&regression);

   Compares expected with actual pictures, frame by frame, and finds the cause of differences: the physics changed if
   the states of the bodies differ, the renderer if only pixels differ. States are compared by trajectories of the same
   name in both folders and by the "State" texts in the pictures. Without either the cause is unknown. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "regression/image_compare.h"
#include "regression/limits.h"
#include "regression/mask.h"
#include "regression/naming.h"
#include "regression/png_display.h"
#include "regression/sequence.h"
#include "regression/view.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

typedef struct RegressionOptions {
    Tolerance tolerance; /* replaces what the rules give */
    PoseTolerance poses; /* of runs; beside pictures only if `tolerance` is not given: one option states either */
    const char *rules;   /* a file; NULL: RULES_NAME in the expected folder, if it is there */
    const Mask *mask;    /* for all frames, beside the masks of the rules; or NULL */
    int64_t max_pixels;  /* of a picture; larger ones are refused before decompression */
    bool flat;           /* without subfolders */
    bool strict;         /* files that display differently fail (png_display.h), and pictures that are no PNG files */
} RegressionOptions;

typedef enum RegressionSide { EXPECTED, ACTUAL, SIDES } RegressionSide;

typedef enum PixelVerdict {
    PIXELS_EQUAL,
    PIXELS_WITHIN, /* within tolerance */
    PIXELS_DIFFER,
    PIXELS_RESIZED, /* the difference is that of the overlap */
    PIXELS_MISSING, /* no actual picture */
    PIXELS_EXTRA,   /* no expected picture */
    PIXELS_UNREAD   /* a picture cannot be read, or its masks hide everything */
} PixelVerdict;

enum { PIXEL_VERDICTS = PIXELS_UNREAD + 1 };

/* A frame's picture may depend on the whole run, through the camera or a scale. STATES_DIFFER_ELSEWHERE: states are
   equal in this frame but not in the whole run, and no frame of the sequence has equal states and equal pixels; a
   difference of pixels is then not attributed to the renderer. */
typedef enum StateVerdict { STATES_UNKNOWN, STATES_EQUAL, STATES_DIFFER, STATES_DIFFER_ELSEWHERE } StateVerdict;

/* Frames that differ for the same reason. */
enum { CAUSE_RANGES = 4 };
typedef struct RegressionCause {
    char what[512];              /* "body 7 moved" */
    double most;                 /* pixels, of movements; 0: none */
    int order;                   /* in which causes were found */
    int count;                   /* frames */
    int range_count, last;       /* of successive frames; the last frame */
    int ranges[CAUSE_RANGES][2]; /* the first and the last frame of each */
    char frames[112];            /* "frames 5 to 29", "frame 3", "frames 0, 2 to 4, ..." */
    bool of_view;                /* the camera differs */
} RegressionCause;

enum { CAUSES_MAX = 32 };

/* A file as it was when compared. */
typedef struct RegressionFile {
    uint64_t hash;     /* XXH3 of its bytes */
    size_t size;       /* of the file; while pictures are compared, of what is in memory (PngFile) */
    int width, height; /* of a picture */
} RegressionFile;

typedef struct RegressionFrame {
    const SequenceFrame *base;      /* has the frame's name: the expected file, or the actual one of an extra frame */
    const SequenceFrame *at[SIDES]; /* NULL on one side for a missing or extra frame; where several pictures are
                                       accepted (base->next), the one that passes or is closest */
    RegressionFile files[SIDES];
    bool alone; /* no numbered frame of a sequence, but a case of its own */
    PixelVerdict pixels;
    bool sizes_alone; /* PIXELS_RESIZED, and the overlap is less than 1/16 of the larger picture: it is not compared */
    StateVerdict states;
    bool states_failed; /* STATES_DIFFER, and no limit that is given lets them: regression_judge_states() */
    int panel;          /* first panel, from 1, whose "State" text differs; else 0 */
    ImageDifference difference;
    PngDisplay metadata; /* that differs; only for different files */
    bool metadata_failed;
    bool run_differs;      /* a trajectory of its scene differs in any frame */
    bool other_view;       /* the cameras of its pictures differ, so their regions have no names */
    FrameChanges *changes; /* of different pixels; else NULL */
    bool shown;            /* in the report */
    double seconds;        /* that its comparison took, wall time */
    char *read_error;      /* of PIXELS_UNREAD: why; then no other member but the files' names says anything */
} RegressionFrame;

/* A trajectory of both folders, or of one. */
typedef struct RegressionRun {
    char *name;
    char *paths[SIDES]; /* where the files are, or would be */
    RegressionFile files[SIDES];
    bool alone[SIDES]; /* only this folder has it; there is no difference then */
    TrajectoryDifference difference;
    bool within;       /* the poses are within the tolerance in all frames, of which both runs have equally many */
    PartedBody beyond; /* where they first are not; frame -1: nowhere, or there is no tolerance */
    char scene[TRAJECTORY_NAME_SIZE];
    char verdicts[SIDES][TRAJECTORY_VERDICT_SIZE]; /* that the files state; empty: none */
    char *read_error; /* why it cannot be compared, or NULL; then no member but the names and files says anything */
    int frames;       /* of the longer one; 0 if equal */
    bool *differs;    /* [frames] */
    double seconds;
} RegressionRun;

typedef struct Regression {
    RegressionOptions options;
    ImageSequence *sequences[SIDES];
    Rules *rules; /* or NULL */
    int count, run_count;
    bool film;                      /* there is a sequence of numbered frames */
    RegressionFrame *frames;        /* by stem, then number */
    RegressionRun *runs;            /* by name */
    int failed;                     /* frames */
    int by_verdict[PIXEL_VERDICTS]; /* frames by what they count as: PIXELS_DIFFER also those that fail for their states
                                       or metadata alone, so that all from there on are those that fail */
    int renderer, physics, unknown; /* frames by cause of the difference */
    int view, elsewhere;            /* the same: the camera differs; the run does, but not in this frame */
    int first_renderer;             /* first frame of a sequence in which the renderer changed; -1: none */
    int run_failed, first_run;      /* trajectories that fail, and the one that differs first (-1: none) */
    int run_within;                 /* trajectories that are not equal, but within the tolerance */
    int runs_unread;                /* trajectories that cannot be compared: they fail */
    Shown shown;
    int cause_count, causes_left_out; /* more than CAUSES_MAX */
    RegressionCause *causes;          /* different cameras first, then by first frame */
    int metadata, first_metadata;     /* frames whose metadata differs, and the first of them (-1: none) */
    int metadata_failed;              /* frames that fail for nothing else */
    int runs_alone[SIDES]; /* trajectories that only this folder has, if no pictures are compared: they fail */
    int runs_left_out;     /* beside pictures: .npz files that only the expected folder has */
    int runs_foreign;      /* .npz files that are a trajectory in neither folder */
    int other_accepted;    /* frames that pass by another accepted picture than the one of their name */
    double seconds;        /* of the whole comparison */
} Regression;

/* Compares two folders, or two files, with all threads. Identical files are checked (pixels/png.h), but not decoded.
   Frames and trajectories that cannot be read get this verdict, and the others theirs. False with error set if a folder
   cannot be read, or if progress stops the comparison; then nothing needs to be freed. */
bool regression_run(Regression *regression, const char *expected, const char *actual, const RegressionOptions *options,
                    const Progress *progress, Error *error);
void regression_free(Regression *regression);

/* A run (.npz), or a trace (.csv), as it is compared. */
Trajectory *regression_read_run(const char *path, Error *error);

bool regression_passed(const Regression *regression);

/* False with error set if frames or trajectories could not be compared: the first by their order, and how many more. */
bool regression_was_read(const Regression *regression, Error *error);

/* Why a frame, or behind them a trajectory, cannot be compared; NULL if it was. */
const char *regression_unread(const Regression *regression, int i);
bool frame_failed(const RegressionFrame *frame);
bool run_failed(const RegressionRun *run);
const char *
run_verdict(const RegressionRun *run); /* "equal", "within tolerance", "physics changed", "missing", "extra" or
                                          "not comparable" */
const char *frame_name(const RegressionFrame *frame); /* of `base` */
double frame_severity(const RegressionFrame *frame); /* differing pixels; infinite where sizes differ or a file lacks */

/* The [failed] frames, the worst first; malloc'ed. NULL with error set if out of memory. */
const RegressionFrame **regression_failures(const Regression *regression, Error *error);

/* "equal", "within tolerance", "renderer changed", "physics changed" (states of this frame differ), "view changed" (the
   camera does), "run changed" (states of other frames do), "pictures differ", "metadata changed", "missing", "extra" */
const char *frame_verdict(const RegressionFrame *frame);

/* One line of text: how a frame or a run differs. */
typedef struct RegressionText {
    char text[1024];
} RegressionText;
RegressionText frame_words(const RegressionFrame *frame);
RegressionText case_words(const RegressionFrame *frame); /* the same, and where most of it is */
RegressionText run_words(const RegressionRun *run);
RegressionText run_verdicts(const RegressionRun *run);    /* "verdict before: ...; now: ..."; empty: no other */
RegressionText cause_words(const RegressionCause *cause); /* "frames 5 to 29: body 7 moved at most 0.4 px" */

/* The overall verdict: "equal", or what changed and what is missing; and where the changes begin, as far as no cause
   tells it, one line each. */
RegressionText regression_verdict(const Regression *regression);
RegressionText regression_begin(const Regression *regression);

/* The limits of the command line. */
RegressionText regression_limits(const Regression *regression);

/* What was left out, or let pass although it is not equal: a line each; empty if there is nothing. */
RegressionText regression_notes(const Regression *regression);
