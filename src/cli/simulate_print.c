/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/simulate_print.h"

#include "cli/json_output.h"

#include <inttypes.h>
#include <stdio.h>

/* What the method solved by simpler means than its own, if anything. */
typedef struct Fallback {
    const char *key, *what;
    int count;
} Fallback;

enum { FALLBACKS = 4 };

static void list_fallbacks(const NetworkFallbacks *fallbacks, Fallback list[FALLBACKS]) {
    const Fallback all[FALLBACKS] = {
        {"by_sweeps", "steps solved by sweeps instead", fallbacks->by_sweeps},
        {"beyond_training", "steps unlike the training of the network", fallbacks->beyond_training},
        {"not_finite", "outputs of the network that were NaN, infinite or out of bounds", fallbacks->not_finite},
        {"outside_cone", "impulses of the network outside the friction cone", fallbacks->outside_cone}};
    for (int i = 0; i < FALLBACKS; i++) list[i] = all[i];
}

void simulate_result_print(const SimulateResult *result) {
    const Scene *scene = result->scene;
    const char *output = result->output;
    Fallback fallbacks[FALLBACKS];
    printf("%s by %s: %d steps of %g s, %d bodies, state %016" PRIx64 "%s%s\n", scene->name, result->method,
           scene->frames, (double)scene->dt, result->bodies, result->state, output != NULL ? " -> " : "",
           output != NULL ? output : "");
    list_fallbacks(&result->fallbacks, fallbacks);
    for (int i = 0; i < FALLBACKS; i++)
        if (fallbacks[i].count > 0) printf("    %s: %d\n", fallbacks[i].what, fallbacks[i].count);
}

static void write_result(JsonWriter *json, const void *context) {
    const SimulateResult *result = context;
    Fallback fallbacks[FALLBACKS];
    json_put_text(json, "scene", result->scene->name);
    json_put_text(json, "method", result->method);
    json_put_int(json, "steps", result->scene->frames);
    json_put_number(json, "dt", (double)result->scene->dt);
    json_put_int(json, "bodies", result->bodies);
    json_put_hash(json, "state", result->state);
    json_put_text(json, "output", result->output);
    json_begin_object(json, "fallbacks", JSON_ONE_LINE);
    list_fallbacks(&result->fallbacks, fallbacks);
    for (int i = 0; i < FALLBACKS; i++) json_put_int(json, fallbacks[i].key, fallbacks[i].count);
    json_end(json);
    simulate_verdict_put(&result->verdict, json, "verdict");
}

bool simulate_result_json(const SimulateResult *result, Error *error) {
    return json_output("twinbox simulate 1", write_result, result, error);
}
