/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods and their settings, as --method has them, and the laws of a loss. */
#include "fuzz.h"

#include "methods/methods.h"
#include "learning/pair_training.h"

#include <math.h>
#include <string.h>

static Scene tiny_scene(void) {
    static BodyDef bodies[] = {{.size = {10, 1}, .fixed = true}, {.size = {1, 1}, .mass = 1, .position = {0, 1}}};
    return (Scene){.name = "tiny",
                   .gravity = {0, -10},
                   .dt = 1.0F / 60,
                   .iterations = 10,
                   .frames = 10,
                   .body_count = 2,
                   .bodies = bodies,
                   .warm_starting = true,
                   .accumulate_impulses = true};
}

/* A method's text, then after a line end the laws of a loss. */
void fuzz_settings(const uint8_t *data, size_t size) {
    Error error = {0};
    Method method;
    Settings all;
    LawNumbers laws;
    char text[4096];
    fuzz_text(text, sizeof text, data, size);
    if (strstr(text, "network=-") != NULL) return; /* standard input, which stays open */
    char *rest = strchr(text, '\n');
    if (rest != NULL) *rest++ = '\0';
    const Scene scene = tiny_scene();
    fuzz_begin();
    bool ok = method_parse(&method, text, &error);
    Stepper *stepper = ok ? stepper_create(&method, &scene, &error) : NULL;
    fuzz_end(stepper != NULL, &error, NULL);
    if (method_all_settings(&all, text, 10) != ok) fuzz_fail("a method's settings are read in two ways");
    stepper_destroy(stepper);
    if (rest == NULL) return;
    error = (Error){0};
    ok = FUZZ_READ(law_weights_parse(rest, &laws, &error), "laws");
    for (int law = 0; ok && law < LAWS; law++)
        if (!(laws.of[law] >= 0) || isinf(laws.of[law])) fuzz_fail("a law's weight is %g", laws.of[law]);
}
