/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run's CSV states above its header, and the file of sizes. Part of csv_run. */
#pragma once
#include "trajectory/trajectory.h"

typedef struct CsvBody {
    int64_t number; /* in the file */
    Vec2 size;
    bool fixed;
} CsvBody;

typedef struct CsvHead {
    char scene[TRAJECTORY_NAME_SIZE], method[TRAJECTORY_NAME_SIZE]; /* empty: not stated */
    uint64_t scene_hash;
    int64_t iterations; /* 0: unknown */
    float dt;     /* 0: not stated */
    int64_t bomb; /* number in the file; -1: none */
    Vec2 camera[2];
    bool states_static; /* whether bodies are static */
    size_t count, capacity;
    CsvBody *bodies; /* by rising number */
} CsvHead;

/* Reads lines "# key: value" from *text on, which is moved behind them; *line becomes the number of the next line. `sizes`:
   a CSV file of body,width,height,static, or NULL. The caller frees bodies, also on failure. */
bool csv_head_read(CsvHead *head, const char *path, const char **text, int *line, const char *sizes, Error *error);

/* Index of the body with this number; -1: it has no size. */
int csv_head_body(const CsvHead *head, int64_t number);
