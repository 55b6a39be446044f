/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the study. Trainings take a thread each, and wait for none; scores, which use all threads or take times,
   follow. Weights are about the seconds on one core, and of scores on two. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "methods/pair.h"
#include "paper/paper_internal.h"
#include "runs/pieces.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* A new part, to be filled in. NULL with error set when memory is short. */
static PaperPart *add_part(PaperPlan *plan, double weight, PaperWrite *write, Error *error, const char *name, ...)
    PRINTF_LIKE(5, 6);
static PaperPart *add_part(PaperPlan *plan, double weight, PaperWrite *write, Error *error, const char *name, ...) {
    if (!array_reserve((void **)&plan->parts, &plan->capacity, plan->count + 1, sizeof *plan->parts))
        return error_memory(error, "paper"), NULL;
    PaperPart *part = &plan->parts[plan->count++];
    *part = (PaperPart){.weight = weight, .write = write};
    va_list arguments;
    va_start(arguments, name);
    vsnprintf(part->name, sizeof part->name, name, arguments);
    va_end(arguments);
    return part;
}

/* The trainings, which come first, and the scores of all networks in each scene. */
static bool add_networks(PaperPlan *plan, Error *error) {
    const double around = 0.1, swept = 3; /* recording and scoring; 2000 iterations */
    const PaperSize *size = plan->size, *whole = &paper_whole_size;
    for (int i = 0; i < plan->network_count * size->splits; i++) {
        const PaperNetwork *network = &plan->networks[i / size->splits];
        double weight = size == whole ? swept : swept / 20;
        if (strcmp(network->optimizer, "lm") == 0) weight *= 35;
        if (strcmp(network->optimizer, "bfgs") == 0) weight *= 3;
        if (pair_views[network->view].by_contact) weight *= network->target == TARGET_POINTS ? 8 : 4;
        if (network->data == DATA_DENSE) weight *= 5;
        const uint64_t seed = plan->options->seed + (uint64_t)(i % size->splits);
        PaperPart *part = add_part(plan, around + weight * network->iterations / 2000, paper_training_write, error,
                                   "network-%s-%llu", network->name, (unsigned long long)seed);
        if (part == NULL) return false;
        part->index = i / size->splits;
        part->seed = seed;
    }
    for (int target = 0; target < TARGET_POINTS; target++) {
        PaperPart *part = add_part(plan, size == whole ? 6 : 0.2, paper_constants_write, error, "constant-%s",
                                   pair_target_names[target]);
        if (part == NULL) return false;
        part->index = target;
    }
    for (int i = 0; i < 2 * PAPER_SCENES; i++) {
        const int scene = i / 2;
        const bool closed = i % 2 == 1;
        const double launches = closed ? (double)size->closed_launches / whole->closed_launches
                                       : (double)size->rate_launches / whole->rate_launches;
        const double weight = (scene < PAPER_TRAINING_SCENES ? 2 : 10) * launches * plan->network_count /
                              paper_network_count * size->scored_splits;
        PaperPart *part = add_part(plan, weight, closed ? paper_closed_loop_write : paper_rates_write, error, "%s-%s",
                                   closed ? "closed-loop" : "rates", paper_scene_names[scene]);
        if (part == NULL) return false;
        part->timed = closed;
        part->alone = true;
        part->needs_networks = true;
        part->index = scene;
    }
    return true;
}

/* laws NULL: the labels. */
static bool add_laws(PaperPlan *plan, const char *laws, double law_weight, Error *error) {
    const double weight = laws == NULL ? 0.1 : 1.5 * plan->size->law_iterations / paper_whole_size.law_iterations;
    for (int seed = 0; seed < (laws == NULL ? 1 : plan->size->seeds); seed++) {
        PaperPart *part = add_part(plan, weight, paper_laws_write, error, "laws-%s-%g-%d",
                                   laws == NULL ? "engine" : laws, law_weight, seed);
        if (part == NULL) return false;
        part->laws = (LawStudy){laws, law_weight, plan->options->seed + (uint64_t)seed, plan->size->law_iterations};
    }
    return true;
}

/* Laws in the loss, then transfer. */
static bool add_outlook(PaperPlan *plan, Error *error) {
    static const char *const laws[] = {"all", "momentum", "energy", "approach", "cone"};
    const PaperSize *size = plan->size;
    if (!add_laws(plan, NULL, 0, error) || !add_laws(plan, "none", 0, error)) return false;
    for (size_t law = 0; law < sizeof laws / sizeof *laws; law++)
        for (int w = 0; w < PAPER_WEIGHTS && size->weights[w] > 0; w++)
            if (!add_laws(plan, laws[law], size->weights[w], error)) return false;

    const double share = (double)size->transfer_iterations / paper_whole_size.transfer_iterations;
    for (int transfer = 0; transfer < 2; transfer++)
        for (int seed = 0; seed < size->seeds; seed++)
            for (int n = 0; n < PAPER_LAUNCHES && size->launches[n] > 0; n++) {
                const int launches = size->launches[n];
                PaperPart *part = add_part(plan, 0.1 * share * (launches + 2 * transfer), paper_transfer_write, error,
                                           "transfer-%d-%d-%d", transfer, seed, launches);
                if (part == NULL) return false;
                part->transfer = (TransferStudy){transfer == 1, plan->options->seed + (uint64_t)seed, launches,
                                                 size->transfer_iterations};
            }
    return true;
}

static bool add_systems(PaperPlan *plan, Error *error) {
    const PaperSize *size = plan->size;
    const double whole_frames = 300, length = size->system_frames > 0 ? size->system_frames / whole_frames : 1;
    for (int i = 0; i < PAPER_SCENES; i++) {
        const double run = i < PAPER_TRAINING_SCENES ? 1 : 8;
        PaperPart *part = add_part(plan, size->system_launches * run * length, system_scores_write, error, "systems-%s",
                                   paper_scene_names[i]);
        if (part == NULL) return false;
        part->alone = part->timed = true;
        part->index = i;
    }
    return true;
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const PaperPlan *plan = context;
    const PaperPart *part = &plan->parts[piece];
    memcpy(info->name, part->name, sizeof info->name);
    info->weight = part->weight;
    info->alone = part->alone;
    info->timed = part->timed;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    PaperPlan *plan = context;
    return plan->parts[piece].write(plan, &plan->parts[piece], results, progress, error);
}

/* Networks of an earlier study in the folder do not count: those of this one have a piece. */
static bool ready(void *context, int64_t piece) {
    const PaperPlan *plan = context;
    bool done = true;
    for (int i = 0; done && plan->parts[piece].needs_networks && i < plan->network_count * plan->size->splits; i++)
        done = pieces_find(plan->pieces, i, &done, &(Error){0}) && done;
    return done;
}

static bool whole(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error) {
    const PaperPlan *plan = context;
    (void)size;
    *there = true;
    return piece >= plan->network_count * plan->size->splits ||
           paper_training_whole(plan, &plan->parts[piece], results, there, error);
}

bool paper_plan_make(PaperPlan *plan, const PaperOptions *options, Error *error) {
    *plan = (PaperPlan){.options = options, .size = options->quick ? &paper_quick_size : &paper_whole_size};
    plan->networks = malloc((size_t)paper_network_count * sizeof *plan->networks);
    if (plan->networks == NULL) return error_memory(error, "paper");
    for (int i = 0; i < paper_network_count; i++) {
        PaperNetwork network = paper_network(i);
        if (options->quick && !network.quick) continue;
        if (network.iterations > plan->size->iterations) network.iterations = plan->size->iterations;
        plan->networks[plan->network_count++] = network;
    }
    if (!file_path(plan->networks_folder, sizeof plan->networks_folder, error, "%s/networks", options->folder) ||
        !paper_datasets_begin(&plan->datasets, options->scenes, &plan->size->data, options->seed, error) ||
        !add_networks(plan, error) || !add_outlook(plan, error) || !add_systems(plan, error))
        return false;
    plan->plan = (PiecePlan){.count = (int64_t)plan->count,
                             .describe = describe,
                             .work = work,
                             .ready = ready,
                             .whole = whole,
                             .context = plan};
    return true;
}

void paper_plan_free(PaperPlan *plan) {
    free(plan->parts);
    free(plan->networks);
    paper_datasets_free(&plan->datasets);
    *plan = (PaperPlan){0};
}
