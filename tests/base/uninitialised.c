/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A branch on memory that was never written, which the memory sanitizer must report. */
#include <stdio.h>
#include <stdlib.h>

int main(void) {
    volatile int *number = malloc(sizeof *number);
    if (number != NULL && *number > 0) printf("above 0\n");
    free((void *)number);
    return 0;
}
