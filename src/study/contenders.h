/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who is compared in a study of speed against accuracy: methods, each with some settings. */
#pragma once
#include "simulate/method.h"
#include "study/chart_csv.h"

typedef struct Contender {
    char name[CHART_NAME_SIZE];       /* "engine" */
    char setting[CHART_SETTING_SIZE]; /* "k=10,warm=off"; may be empty */
    Method method;                    /* both, parsed */
} Contender;

typedef struct ContenderList {
    int count;
    Contender *items; /* [count] */
} ContenderList;

/* Fills the list from "NAME,NAME:KEY=VALUE,...": a name alone stands for all settings that the study has for it (quick:
   fewer). text NULL: every method. ERROR_INPUT for a name or setting that there is not, or one given twice. */
bool contenders_parse(ContenderList *list, const char *text, bool quick, Error *error);

/* The same, where a name alone stands for the method as the scene has it. */
bool contenders_read(ContenderList *list, const char *text, Error *error);

void contenders_free(ContenderList *list);

/* Those that can run in the scene: without a method that needs a network which neither its settings nor the scene name.
   The items stay those of the list. */
int contenders_for(const ContenderList *list, const Scene *scene, const Contender **fit);
