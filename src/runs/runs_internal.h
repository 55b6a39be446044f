/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of this room: trajectories that grow, arrays and rows of runs, checks of verdicts. */
#pragma once
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/run_files.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <stdbool.h>

/* Trajectories that grow. */

/* Makes room for names, all empty. False with error set. */
bool trajectory_make_names(Trajectory *trajectory, Error *error);

/* Bytes of all arrays in a file. */
double trajectory_bytes(const Trajectory *trajectory);

/* Appends `count` contacts and returns the first, to be filled. NULL with error set. */
TrajectoryContact *trajectory_add_contacts(Trajectory *trajectory, int frame, int count, Error *error);

/* Removes all contacts. Contacts of frame 0 can be added then: the trajectory is a part of a longer run. */
void trajectory_restart_contacts(Trajectory *trajectory);

/* False with error set, naming `path`, if a trajectory from outside is inconsistent (trajectory_read). */
bool trajectory_check(const Trajectory *trajectory, const char *path, Error *error);

/* Sets `fixed` of a run that does not state it: bodies that are there from frame 0 to the end in one pose are static;
   in a run of one frame, none. */
void trajectory_guess_fixed(Trajectory *trajectory);

/* Writes a run while it is made, in bounded memory. A part of a run is a Trajectory whose frame 0 is the frame after
   the last one of the part before, with the contacts of the steps that end in its frames. The parts do not show in the
   file. */

typedef struct TrajectoryStream TrajectoryStream;

/* A stream for a run of `frames` frames; names, sizes and all else that does not change are those of `head`, which may
   be its first part and must outlive the stream. Program and verdict are read when it is finished. NULL with error set
   if no file can be written at `path`. */
TrajectoryStream *trajectory_stream_create(const Trajectory *head, int frames, TrajectoryFormat format,
                                           const char *path, Error *error);
bool trajectory_stream_add(TrajectoryStream *stream, const Trajectory *part, Error *error);

/* Writes the file, atomically, when all frames have been added. */
bool trajectory_stream_finish(TrajectoryStream *stream, Error *error);

/* Discards what trajectory_stream_finish() has not written. */
void trajectory_stream_destroy(TrajectoryStream *stream);

/* What a run's CSV states above its header, and the file of sizes. Part of csv_run. */

typedef struct CsvBody {
    int64_t number; /* in the file */
    Vec2 size;
    bool fixed;
} CsvBody;

typedef struct CsvHead {
    char scene[TRAJECTORY_NAME_SIZE], method[TRAJECTORY_NAME_SIZE]; /* empty: not stated */
    uint64_t scene_hash;
    int64_t iterations; /* 0: unknown */
    float dt;           /* 0: not stated */
    int64_t bomb;       /* number in the file; -1: none */
    Vec2 camera[2];
    bool states_static; /* whether bodies are static */
    bool single;        /* numbers are those of float32 */
    size_t count, capacity;
    CsvBody *bodies; /* by rising number */
} CsvHead;

/* Reads lines "# key: value" from *text on, which is moved behind them; *line becomes the number of the next line.
   The caller frees bodies, also on failure. */
bool csv_head_read(CsvHead *head, const char *path, const char **text, int *line, const CsvRunOptions *options,
                   Error *error);

/* Index of the body with this number; -1: it has no size. */
int csv_head_body(const CsvHead *head, int64_t number);

/* The arrays of a run's .npz, in the order of the file. */

enum {
    ARRAY_VERSION,
    ARRAY_SCENE,
    ARRAY_METHOD,
    ARRAY_SCENE_HASH,
    ARRAY_ITERATIONS,
    ARRAY_DT,
    ARRAY_BOMB,
    ARRAY_CAMERA,
    ARRAY_SIZE,
    ARRAY_FIXED,
    ARRAY_MASS,
    ARRAY_BODY_NAME,
    ARRAY_POSITION, /* these grow with the run */
    ARRAY_ANGLE,
    ARRAY_VELOCITY,
    ARRAY_ANGULAR_VELOCITY,
    ARRAY_CONTACT_START,
    ARRAY_CONTACT_BODIES,
    ARRAY_CONTACT_FEATURE,
    ARRAY_CONTACT_POINT,
    ARRAY_CONTACT_NORMAL,
    ARRAY_CONTACT_IMPULSE,
    ARRAY_PROGRAM, /* from here on: known after the run */
    ARRAY_NETWORK_HASH,
    ARRAY_VERDICT,
    ARRAY_VERDICT_FRAME,
    ARRAY_VERDICT_BODY,
    RUN_ARRAYS
};

/* In a shape, for numbers that differ from run to run. OF_STEPS: one more than frames. */
enum { OF_FRAMES = -1, OF_STEPS = -2, OF_BODIES = -3, OF_CONTACTS = -4 };

/* Arrays that come together or not at all. */
enum { GROUP_NONE, GROUP_VELOCITIES, GROUP_CONTACTS, GROUP_VERDICT, RUN_ARRAY_GROUPS };

typedef struct RunArray {
    const char *name;
    NpzType type;
    int rank, shape[3];
    int group;
} RunArray;

extern const RunArray run_arrays[RUN_ARRAYS];

void run_array_shape(const RunArray *array, int64_t frames, int64_t bodies, int64_t contacts,
                     int64_t shape[NPZ_MAX_RANK]);

/* The rows of a run's CSV, one at a time: a file of a million rows takes no memory but its text. Part of csv_run. */

enum CsvRowsColumn {
    COL_FRAME,
    COL_BODY,
    COL_X,
    COL_Y,
    COL_ANGLE,
    COL_VX,
    COL_VY,
    COL_OMEGA,
    COL_HASH, /* of traces only */
    COL_TIME,
    COL_COUNT
};

typedef struct CsvRows {
    const char *path;
    const char *at;       /* the line to be read */
    int line;             /* its number */
    int width;            /* fields of each line */
    int field[COL_COUNT]; /* of each column, -1: absent */
    const char *first;    /* the first row, */
    int first_line;       /* and its number */
    char ignored[128];    /* columns that mean nothing, separated by ", " */
    bool as_trace;
    bool indices_only; /* numbers and hashes are not read; */
    int needed;        /* as many fields are */
} CsvRows;

typedef struct CsvRow {
    int line;
    int64_t frame, body;
    double state[STATE_COLUMNS]; /* 0 where absent */
    uint64_t hash;
    double time, time_digit; /* s, 0 if absent; one in its last digit */
    bool not_finite;         /* a number of the state is NaN or infinite, or too large for float32 */
} CsvRow;

/* Reads the header at `text`, which is line `line` of the file and stays the caller's. */
bool csv_rows_begin(CsvRows *rows, const char *path, const char *text, int line, bool as_trace, Error *error);

/* False at the end, and with error set. */
bool csv_rows_next(CsvRows *rows, CsvRow *row, Error *error);
void csv_rows_rewind(CsvRows *rows, bool indices_only);

/* Line of the row of a body in a frame; 0: none. */
int csv_rows_find(CsvRows *rows, int64_t frame, int64_t body);

/* A run while it is read from CSV. Part of csv_run. */

typedef struct CsvImport {
    const char *path;
    size_t size; /* of the text */
    const CsvRunOptions *options;
    CsvRunNotes *notes;
    CsvHead head;
    CsvRows rows;
    int64_t count;                /* rows */
    int64_t first, last;          /* frames of the file */
    double first_time, last_time; /* of these frames, s */
    int *row_counts;              /* of each body */
    int64_t end, *ends;           /* the first frame that is not finite, and of each body; INT64_MAX: none */
    int ended;                    /* a body that is not finite in frame `end` */
    int bodies;
    int64_t origin; /* frame of the file that is frame 0 of the run */
    double step;    /* s, that the times must have */
    Trajectory *run;
} CsvImport;
