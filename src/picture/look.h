/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a sequence shows besides the bodies, and how. All zero: panels side by side, light theme. */
#pragma once
#include "picture/camera.h"

enum { LOOK_RUNS_MAX = 6 };

typedef enum LookCompare {
    LOOK_SPLIT,     /* one panel per run */
    LOOK_OVERLAY,   /* one panel: the first run filled, the others as outlines */
    LOOK_DIFFERENCE /* one panel per run except the first, coloured by the distance from it; its bodies as outlines */
} LookCompare;

typedef enum LookCamera {
    LOOK_FIT,       /* fixed */
    LOOK_BOMB,      /* follows the first run's bomb */
    LOOK_DIVERGENCE /* moves close to the first divergence and back */
} LookCamera;

typedef enum LookTheme { LOOK_LIGHT, LOOK_DARK } LookTheme;

/* Bits of `show`. */
enum {
    LOOK_GHOSTS = 1,      /* the first run's bodies as outlines in the others' panels */
    LOOK_DISTANCE = 2,    /* bodies coloured by their distance from the first run's */
    LOOK_TRAILS = 4,      /* paths of the centres of bodies that moved far */
    LOOK_CONTACTS = 8,    /* contact points */
    LOOK_IMPULSES = 16,   /* arrows: the contacts' impulses in the step */
    LOOK_VELOCITIES = 32, /* arrows from the centres of moving bodies */
    LOOK_TIMELINE = 64    /* distance from the first run over time, below the panels */
};

typedef struct RenderLook {
    LookCompare compare;
    LookCamera camera;
    CameraView view;             /* the fixed view, where a moving camera begins; width 0: that of `view_from` */
    const Trajectory *view_from; /* the run that camera_fit() shows; NULL: the first */
    LookTheme theme;
    unsigned show;                    /* LOOK_GHOSTS | ... */
    const char *costs[LOOK_RUNS_MAX]; /* cost of each run, as text; NULL: none */
    const char *end;                  /* title of the end card; NULL: a default */
} RenderLook;

/* The names used in options, in the order of the enums and bits; each list ends with NULL. */
extern const char *const look_compare_names[], *const look_camera_names[], *const look_theme_names[],
                                                                               *const look_show_names[];
