/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/slot_samples.h"

#include "common/memory_stream.h"
#include "common/array.h"
#include "common/parallel.h"
#include "dynamics/problem_bytes.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

static void free_sample(SlotSample *sample) {
    free((void *)sample->problem.bodies);
    free((void *)sample->problem.contacts);
    free(sample->reference);
    free(sample->goal);
    unrolled_problem_free(&sample->unrolled);
    scene_view_free(&sample->view);
    free(sample->inputs);
}

void slot_samples_free(SlotSamples *samples) {
    for (int i = 0; i < samples->count; i++) free_sample(&samples->items[i]);
    free(samples->items);
    *samples = (SlotSamples){0};
}

static bool reserve(SlotSamples *samples, int count) {
    return array_reserve((void **)&samples->items, &samples->capacity, (size_t)samples->count + (size_t)count,
                         sizeof *samples->items);
}

bool slot_samples_add(SlotSamples *samples, const ContactProblem *problem, int launch, int since) {
    if (!reserve(samples, 1)) return false;
    const size_t bodies = (size_t)problem->body_count * sizeof(ProblemBody);
    const size_t contacts = (size_t)problem->contact_count * sizeof(ContactPoint);
    ProblemBody *body_copy = malloc(bodies + 1);
    ContactPoint *contact_copy = malloc(contacts + 1);
    SlotSample *sample = &samples->items[samples->count++];
    *sample = (SlotSample){.problem = *problem, .launch = launch, .since = since};
    sample->problem.bodies = body_copy;
    sample->problem.contacts = contact_copy;
    if (body_copy == NULL || contact_copy == NULL) return false;
    memcpy(body_copy, problem->bodies, bodies);
    if (contacts > 0) memcpy(contact_copy, problem->contacts, contacts);
    return true;
}

bool slot_samples_move(SlotSamples *samples, SlotSamples *from) {
    if (!reserve(samples, from->count + 1)) return false;
    for (int i = 0; i < from->count; i++) samples->items[samples->count++] = from->items[i];
    free(from->items);
    *from = (SlotSamples){0};
    return true;
}

typedef struct Labels {
    SlotSample *items;
    Reference *references; /* [threads] */
} Labels;

/* Everything of a label but the goal's impulses. */
static bool begin_label(SlotSample *sample, const ReferenceVelocity *velocities) {
    const size_t bodies = (size_t)sample->problem.body_count, contacts = (size_t)sample->problem.contact_count;
    sample->reference = malloc(bodies * sizeof *sample->reference + 1);
    sample->goal = malloc(contacts * sizeof *sample->goal + 1);
    if (sample->reference == NULL || sample->goal == NULL ||
        !unrolled_problem_make(&sample->unrolled, &sample->problem))
        return false;
    memcpy(sample->reference, velocities, bodies * sizeof *sample->reference);
    return true;
}

static bool label(void *context, int i, Error *error) {
    const Labels *labels = context;
    SlotSample *sample = &labels->items[i];
    Reference *reference = &labels->references[omp_get_thread_num()];
    if (!reference_solve(reference, &sample->problem, NULL, error)) return false;
    if (!begin_label(sample, reference->velocities)) return error_memory(error, "labels");
    for (int k = 0; k < sample->problem.contact_count; k++)
        sample->goal[k] = (ContactImpulse){(float)reference->impulses[k].normal, (float)reference->impulses[k].tangent};
    return true;
}

bool slot_samples_label(SlotSamples *samples, int first, const Progress *progress, Error *error) {
    const int threads = omp_get_max_threads();
    Reference *references = calloc((size_t)threads, sizeof *references);
    if (references == NULL) return error_memory(error, "labels");
    Labels labels = {samples->items + first, references};
    const ParallelWork work = {label, &labels};
    bool ok = parallel_for(&work, samples->count - first, "labels", progress, error);
    for (int i = 0; i < threads; i++) reference_free(&references[i]);
    free(references);
    return ok;
}

bool slot_samples_compute_inputs(SlotSamples *samples, int first, const SlotNetwork *network, Error *error) {
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 64) reduction(&& : ok)
    for (int i = first; i < samples->count; i++) {
        SlotSample *sample = &samples->items[i];
        bool fine = scene_view_take(&sample->view, network, &sample->problem);
        if (fine && sample->inputs == NULL)
            sample->inputs = malloc((size_t)slot_network_inputs(network) * sizeof *sample->inputs);
        fine = fine && sample->inputs != NULL;
        if (fine) slot_network_look(network, &sample->view.slots, sample->inputs);
        ok = ok && fine;
    }
    return ok || error_memory(error, "samples");
}

void slot_samples_write(const SlotSamples *samples, FILE *out) {
    for (int i = 0; i < samples->count; i++) {
        const SlotSample *sample = &samples->items[i];
        const int32_t place[2] = {sample->launch, sample->since};
        fwrite(place, sizeof place, 1, out);
        problem_bytes_write(&sample->problem, out);
        stream_put(out, sample->reference, sizeof *sample->reference, (size_t)sample->problem.body_count);
        stream_put(out, sample->goal, sizeof *sample->goal, (size_t)sample->problem.contact_count);
    }
}

/* The numbers of reference and goal are not checked: a reference that diverged is NaN in the training, too. */
static bool read_label(SlotSample *sample, const ReferenceVelocity *velocities, ProblemBytes *bytes, Error *error) {
    return (begin_label(sample, velocities) || error_memory(error, bytes->path)) &&
           problem_bytes_take(bytes, sample->goal, (size_t)sample->problem.contact_count, sizeof *sample->goal, error);
}

static bool read_sample(SlotSamples *samples, ProblemBytes *bytes, int bodies, Error *error) {
    int32_t place[2];
    ContactProblem problem = {0};
    ReferenceVelocity *velocities = malloc((size_t)bodies * sizeof *velocities);
    bool ok = velocities != NULL || error_memory(error, bytes->path);
    ok = ok && problem_bytes_take(bytes, place, 1, sizeof place, error) && problem_bytes_read(&problem, bytes, error);
    if (ok && (place[0] < 0 || place[1] < 0 || problem.body_count != bodies || problem.marked < 0))
        ok = problem_bytes_refuse(bytes, error);
    ok = ok && problem_bytes_take(bytes, velocities, (size_t)bodies, sizeof *velocities, error) &&
         (slot_samples_add(samples, &problem, place[0], place[1]) || error_memory(error, bytes->path)) &&
         read_label(&samples->items[samples->count - 1], velocities, bytes, error);
    problem_bytes_free(&problem);
    free(velocities);
    return ok;
}

bool slot_samples_read(SlotSamples *samples, const char *data, size_t size, int bodies, const char *path,
                       Error *error) {
    ProblemBytes bytes = {data, size, path};
    bool ok = true;
    while (ok && bytes.left > 0) ok = read_sample(samples, &bytes, bodies, error);
    return ok;
}
