/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lists, charts, studies and captions know of a method. A field left zero has a sensible default: a name and a
   summary are enough to begin with. */
#pragma once
#include "common/settings.h"

#include <stdbool.h>

/* What a method's results are compared for. */
typedef enum MethodRole {
    METHOD_COMPETES, /* for speed and accuracy */
    METHOD_BASELINE, /* solves nothing; other methods must be more accurate */
    METHOD_REFERENCE /* the converged solution: errors of other methods are measured against it */
} MethodRole;

/* By its colour a reader finds a method again in all pictures (common/method_look.h). They differ with all common kinds of
   colour blindness. The palettes are in picture/theme.c and sketch/plot_style.c. */
typedef enum MethodColour {
    METHOD_NO_COLOUR, /* any that is left */
    METHOD_BLUE,
    METHOD_ORANGE,
    METHOD_GREEN,
    METHOD_PURPLE,
    METHOD_SKY,
    METHOD_WINE,
    METHOD_VERMILION,
    METHOD_BLACK,
    METHOD_COLOURS
} MethodColour;

/* Marks and dashes in charts. */
typedef enum MethodSymbol {
    METHOD_CIRCLE,
    METHOD_SQUARE,
    METHOD_TRIANGLE,
    METHOD_DIAMOND,
    METHOD_INVERTED_TRIANGLE,
    METHOD_PENTAGON,
    METHOD_SYMBOLS
} MethodSymbol;

/* Different for every method: those of one colour differ in their symbol. */
typedef struct MethodLook {
    MethodColour colour;
    MethodSymbol symbol;
} MethodLook;

/* Settings that a study runs a method with, each as on the command line ("k=10,warm=off"; "": none given), ended by
   NULL. */
typedef const char *const *MethodRuns;

#define METHOD_RUNS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define METHOD_NO_RUNS ((const char *const[]){NULL})

typedef struct MethodDescription {
    const char *name, *summary;  /* as on the command line; one line for `twinbox methods` */
    const SettingSpec *settings; /* ended by a NULL key; NULL: the method has none */
    const char *caption;         /* in frames, after the method's text: "sequential impulses"; NULL: nothing */
    MethodLook look;
    MethodRole role;
    bool no_push_out;   /* it moves overlapping bodies apart without giving them a velocity; so the converged velocities
                            that it is scored against have none of position correction either */
    bool no_contacts;   /* it moves bodies without contacts: collision detection in its step serves measurement and
                            pictures only, so that its time is that between step_solving_begins() and step_solving_ends()
                            (simulate/stepping.h), not the whole step's */
    bool falls_back;    /* sweeps may solve a step instead; results report how often, as for networks */
    bool needs_network; /* runs only if the setting `network` or the scene names a file */
    const char *twin;   /* of a learned method: its ablation, as on the command line ("sain:net=off"); it takes the same
                            settings otherwise. NULL: nothing is learned */
    const char *own_settings; /* those that hold where none are given, "k=10"; NULL: k is the scene's iterations */
    const char *shipped;      /* the setting in common use, which charts mark; NULL: none */
    /* What `twinbox chart`, `twinbox chart --quick` and `twinbox stability` run by default. NULL: one run, no settings
       given. METHOD_NO_RUNS: left out unless named, and reported as left out. */
    MethodRuns chart, chart_quick, stability;
    int stability_place; /* 1, 2, ...: place in the stability study; 0: behind those that have one, in registry order */
} MethodDescription;
