/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A second thread that works on one item after the other, in the order in which they are given, while the caller makes
   the next. */
#pragma once
#include "common/error.h"

typedef struct Background Background;

/* Called in the second thread. After a failure it is not called again. */
typedef bool BackgroundWork(void *context, void *item, Error *error);

Background *background_start(BackgroundWork *work, void *context, Error *error);

/* Waits until the item before is done, then gives the next. False with the error of an earlier item: then it is not
   taken. The item must last until the next call returns. */
bool background_give(Background *background, void *item, Error *error);

/* Waits until all items are done; with the first error. */
bool background_wait(Background *background, Error *error);

/* Ends the thread when its item is done. */
void background_stop(Background *background);
