/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the pictures of a sequence show beside the bodies, and how. Zeroed: bodies side by side, on white. */
#pragma once

enum { LOOK_RUNS_MAX = 6 };

typedef enum LookCompare {
    LOOK_SPLIT,     /* a panel for each run */
    LOOK_OVERLAY,   /* one panel: the first run filled, the others as outlines */
    LOOK_DIFFERENCE /* a panel for each run but the first, coloured by the distance from it, its bodies as outlines */
} LookCompare;

typedef enum LookCamera {
    LOOK_FIT,       /* at rest, on all that happens */
    LOOK_BOMB,      /* follows the first run's bomb */
    LOOK_DIVERGENCE /* goes near where a run first leaves the first one, and comes back */
} LookCamera;

typedef enum LookTheme { LOOK_LIGHT, LOOK_DARK } LookTheme;

/* Members of `show`. */
enum {
    LOOK_GHOSTS = 1,      /* the first run's bodies as outlines in the others' panels */
    LOOK_DISTANCE = 2,    /* bodies coloured by their distance from the first run's */
    LOOK_TRAILS = 4,      /* where the centres of bodies have been that moved far */
    LOOK_CONTACTS = 8,    /* points where bodies touch */
    LOOK_IMPULSES = 16,   /* arrows of what the contacts passed on in the step */
    LOOK_VELOCITIES = 32, /* arrows from the centres of the bodies that move */
    LOOK_TIMELINE = 64    /* the distance from the first run over time, below the panels */
};

typedef struct RenderLook {
    LookCompare compare;
    LookCamera camera;
    LookTheme theme;
    unsigned show;                    /* LOOK_GHOSTS | ... */
    const char *costs[LOOK_RUNS_MAX]; /* what a run cost, in words; NULL: nothing is said */
    const char *end;                  /* at the head of the end card; NULL: words of ours */
} RenderLook;

/* As options name them, in the order of the enums and of the bits; each list ends with NULL. */
extern const char *const look_compare_names[], *const look_camera_names[], *const look_theme_names[],
                                                                               *const look_show_names[];
