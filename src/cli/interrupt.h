/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SIGINT (Ctrl-C), SIGTERM and SIGHUP. Each of these signals ends the program with exit status 130
   (ERROR_INTERRUPTED), in every command: at once where nothing would look at a request, between two pieces of work
   while signals are held. Files are written beside their name and renamed, so that an end at once leaves no half of
   one. */
#pragma once

#include <stdbool.h>

/* Handles both signals from here on, also where the shell has a background process ignore them. */
void interrupt_handle(void);

/* While held, a signal only requests a stop. Those that follow within a second belong to this request, also
   after the release; a later one ends the program at once. The calls nest. */
void interrupt_hold(void);
void interrupt_release(void);

/* True after a signal. From any thread. */
bool interrupt_requested(void);
