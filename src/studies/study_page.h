/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The live pages of a study, one for each scene beside its charts and maps, and links into them:

     StudyPage page;
     study_page_write(&page, "scenes/stack.yaml", &methods, folder, error);
     study_link_put(out, &page, "bomb_x=2.5", "engine", "k=4", "0.31");

   A method that a page can run (live/live.h) has the same bits there. */
#pragma once
#include "base/base.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct StudyPage {
    char file[SCENE_NAME_SIZE + 16]; /* "live-stack.html", in the study's folder; "": there is none */
} StudyPage;

/* Writes the page of a scene, by the engine and interior, with the networks of the methods. There is none in a build
   without the module for live pages, nor of a scene that one of the two cannot run to its end. */
bool study_page_write(StudyPage *page, const char *scene, const ContenderList *methods, const char *folder,
                      Error *error);

/* Puts a text that links to the method in the scene with the settings "name=value,name=value", beside interior; plain
   text if no page can run the method. */
void study_link_put(FILE *out, const StudyPage *page, const char *set, const char *method, const char *setting,
                    const char *text);

/* Writes to a file, which appears whole, what `write` writes. */
typedef bool TextWrite(void *context, FILE *out, Error *error);
bool text_write(const char *path, TextWrite *write, void *context, Error *error);
