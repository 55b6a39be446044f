/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods that a study compares, each with some settings. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"

#include <stdbool.h>

typedef struct Contender {
    char name[CHART_NAME_SIZE];       /* "engine" */
    char setting[CHART_SETTING_SIZE]; /* "k=10,warm=off"; may be empty */
    Method method;                    /* both, parsed */
} Contender;

/* Whether the steps before the bomb, which all launches share, are taken only once (stepper_remember()). */
static inline bool contender_shares(const Contender *contender) {
    return !contender->method.kind->description->external;
}

typedef struct ContenderList {
    int count;
    Contender *items; /* [count] */
} ContenderList;

/* Which runs of a method's description (methods/methods.h) a study makes by default. */
typedef enum ContenderStudy { STUDY_CHART, STUDY_CHART_QUICK, STUDY_STABILITY } ContenderStudy;

/* Fills the list from "NAME,NAME:KEY=VALUE,...". A name alone stands for all runs of the method in a chart, and for one
   run without settings in the stability study. text NULL: all runs of every registered method. ERROR_INPUT for an
   unknown name or setting, or a run given twice. */
bool contenders_parse(ContenderList *list, const char *text, ContenderStudy study, Error *error);

void contenders_free(ContenderList *list);

/* Adds the files among the words of external methods to the key: what the programs do depends on them. */
bool contenders_add_to_key(const ContenderList *list, StudyKey *key, Error *error);

/* The registered methods that the study leaves out by default. */
NameList contenders_left_out(ContenderStudy study);

/* The contenders that can run in the scene: all but those that lack their network (method_lacks_network). fit[count of
   the list] points to items of the list. Returns how many there are. */
int contenders_for(const ContenderList *list, const Scene *scene, const Contender **fit);

/* The others. */
NameList contenders_without_network(const ContenderList *list, const Scene *scene);
