/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/background.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct Background {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    BackgroundWork *work;
    void *context;
    void *item; /* in work; NULL: none */
    bool ends;
    Error error;
};

/* Until the item is NULL (idle) or not. The mutex is locked. */
static void wait_until(Background *background, bool idle) {
    while ((background->item == NULL) != idle && !(background->ends && !idle))
        pthread_cond_wait(&background->changed, &background->mutex);
}

static void *run(void *argument) {
    Background *background = argument;
    pthread_mutex_lock(&background->mutex);
    for (wait_until(background, false); background->item != NULL; wait_until(background, false)) {
        pthread_mutex_unlock(&background->mutex);
        /* Only this thread sets the error while there is an item. */
        if (background->error.kind == ERROR_NONE)
            background->work(background->context, background->item, &background->error);
        pthread_mutex_lock(&background->mutex);
        background->item = NULL;
        pthread_cond_broadcast(&background->changed);
    }
    pthread_mutex_unlock(&background->mutex);
    return NULL;
}

Background *background_start(BackgroundWork *work, void *context, Error *error) {
    Background *background = calloc(1, sizeof *background);
    if (background == NULL) {
        error_memory(error, "second thread");
        return NULL;
    }
    background->work = work;
    background->context = context;
    pthread_mutex_init(&background->mutex, NULL);
    pthread_cond_init(&background->changed, NULL);
    const int cause = pthread_create(&background->thread, NULL, run, background);
    if (cause == 0) return background;
    error_system(error, "second thread", "cannot be started: %s", strerror(cause));
    pthread_cond_destroy(&background->changed);
    pthread_mutex_destroy(&background->mutex);
    free(background);
    return NULL;
}

bool background_give(Background *background, void *item, Error *error) {
    pthread_mutex_lock(&background->mutex);
    wait_until(background, true);
    bool done = background->error.kind == ERROR_NONE;
    if (done) {
        background->item = item;
        pthread_cond_broadcast(&background->changed);
    } else if (error->kind == ERROR_NONE) {
        *error = background->error;
    }
    pthread_mutex_unlock(&background->mutex);
    return done;
}

bool background_wait(Background *background, Error *error) { return background_give(background, NULL, error); }

void background_stop(Background *background) {
    if (background == NULL) return;
    pthread_mutex_lock(&background->mutex);
    background->ends = true;
    pthread_cond_broadcast(&background->changed);
    pthread_mutex_unlock(&background->mutex);
    pthread_join(background->thread, NULL);
    pthread_cond_destroy(&background->changed);
    pthread_mutex_destroy(&background->mutex);
    free(background);
}
