/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A data race in OpenMP code, which the thread sanitizer must report: `sum` has no reduction. */
#include <stdio.h>

int main(void) {
    int sum = 0;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < 100000; i++) sum += i % 2;
    printf("%d\n", sum);
    return 0;
}
