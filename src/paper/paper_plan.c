/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the study, in the order in which they are done. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "runs/pieces.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const law_names[] = {"all", "momentum", "energy", "approach", "cone"};

enum { LAW_SETS = sizeof law_names / sizeof law_names[0] };

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

static void choose_networks(PaperPlan *plan) {
    for (int i = 0; i < paper_network_count; i++) {
        PaperNetwork network = paper_network(i);
        if (plan->options->quick && !network.quick) continue;
        if (network.iterations > plan->size->iterations) network.iterations = plan->size->iterations;
        plan->networks[plan->network_count++] = network;
    }
}

/* About the seconds on two cores: for 2000 iterations; and for recording and scoring. */
static double training_weight(const PaperNetwork *network) {
    const double around = 0.1;
    static const double of_data[PAPER_DATA] = {
        [DATA_SWEPT] = 2, [DATA_RANDOM] = 2, [DATA_MIXED] = 2, [DATA_FINE] = 8, [DATA_FINEST] = 10, [DATA_PAPER] = 16};
    double weight = of_data[network->data];
    if (strcmp(network->optimizer, "lm") == 0) weight *= 35;
    if (strcmp(network->optimizer, "bfgs") == 0) weight *= 3;
    if (pair_views[network->view].by_contact) weight *= network->target == TARGET_POINTS ? 8 : 4;
    return around + weight * network->iterations / 2000;
}

static bool add_trainings(PaperPlan *plan, Error *error) {
    for (int i = 0; i < plan->network_count; i++) {
        const PaperNetwork *network = &plan->networks[i];
        PaperPart *part =
            add_part(plan, training_weight(network), paper_training_write, error, "network-%s", network->name);
        if (part == NULL) return false;
        part->index = i;
    }
    return true;
}

/* The same of all networks: 2 s, or 10 s on a large scene, in the whole study. */
static double rating_weight(const PaperPlan *plan, int scene, bool closed) {
    const PaperSize *size = plan->size, *whole = &paper_whole_size;
    const double launches = closed ? (double)size->closed_launches / whole->closed_launches
                                   : (double)size->rate_launches / whole->rate_launches;
    return (scene < PAPER_TRAINING_SCENES ? 2 : 10) * launches * plan->network_count / paper_network_count;
}

static bool add_scoring(PaperPlan *plan, int scene, bool closed, Error *error) {
    PaperPart *part =
        add_part(plan, rating_weight(plan, scene, closed), closed ? paper_closed_loop_write : paper_rates_write, error,
                 "%s-%s", closed ? "closed-loop" : "rates", paper_scene_names[scene]);
    if (part == NULL) return false;
    part->timed = closed;
    part->needs_networks = true;
    part->index = scene;
    return true;
}

static bool add_scorings(PaperPlan *plan, Error *error) {
    for (int i = 0; i < PAPER_SCENES; i++)
        if (!add_scoring(plan, i, false, error) || !add_scoring(plan, i, true, error)) return false;
    return true;
}

static bool add_law_set(PaperPlan *plan, const char *laws, double weight, Error *error) {
    const double seconds = 2.0 * plan->size->law_iterations / paper_whole_size.law_iterations;
    for (int seed = 0; seed < (laws == NULL ? 1 : plan->size->seeds); seed++) {
        PaperPart *part = add_part(plan, laws == NULL ? 0.1 : seconds, paper_laws_write, error, "laws-%s-%g-%d",
                                   laws == NULL ? "engine" : laws, weight, seed);
        if (part == NULL) return false;
        part->laws = (LawStudy){laws, weight, plan->options->seed + (uint64_t)seed, plan->size->law_iterations};
    }
    return true;
}

static bool add_laws(PaperPlan *plan, Error *error) {
    if (!add_law_set(plan, NULL, 0, error) || !add_law_set(plan, "none", 0, error)) return false;
    for (int law = 0; law < LAW_SETS; law++)
        for (int w = 0; w < PAPER_WEIGHTS && plan->size->weights[w] > 0; w++)
            if (!add_law_set(plan, law_names[law], plan->size->weights[w], error)) return false;
    return true;
}

static bool add_transfer(PaperPlan *plan, bool transfer, int seed, int launches, Error *error) {
    const double share = (double)plan->size->transfer_iterations / paper_whole_size.transfer_iterations;
    PaperPart *part = add_part(plan, share * (launches + 2 * transfer), paper_transfer_write, error,
                               "transfer-%d-%d-%d", transfer, seed, launches);
    if (part == NULL) return false;
    part->transfer =
        (TransferStudy){transfer, plan->options->seed + (uint64_t)seed, launches, plan->size->transfer_iterations};
    return true;
}

static bool add_transfers(PaperPlan *plan, Error *error) {
    const PaperSize *size = plan->size;
    for (int transfer = 0; transfer < 2; transfer++)
        for (int seed = 0; seed < size->seeds; seed++)
            for (int n = 0; n < PAPER_LAUNCHES && size->launches[n] > 0; n++)
                if (!add_transfer(plan, transfer == 1, seed, size->launches[n], error)) return false;
    return true;
}

/* About the seconds on two cores. */
static double scoring_weight(const PaperSize *size, int scene) {
    const double run = scene < PAPER_TRAINING_SCENES ? 1 : 8, whole_frames = 300;
    return size->system_launches * run * (size->system_frames > 0 ? size->system_frames / whole_frames : 1);
}

static bool add_systems(PaperPlan *plan, Error *error) {
    for (int i = 0; i < PAPER_SCENES; i++) {
        PaperPart *part = add_part(plan, scoring_weight(plan->size, i), system_scores_write, error, "systems-%s",
                                   paper_scene_names[i]);
        if (part == NULL) return false;
        part->timed = true;
        part->index = i;
    }
    return true;
}

static void paper_plan_describe(void *context, int64_t piece, PieceInfo *info) {
    const PaperPlan *plan = context;
    const PaperPart *part = &plan->parts[piece];
    memcpy(info->name, part->name, sizeof info->name);
    info->weight = part->weight;
    info->alone = true;
    info->timed = part->timed;
    if (part->timed) info->with = plan->first_timed;
}

static bool paper_plan_work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    PaperPlan *plan = context;
    return plan->parts[piece].write(plan, &plan->parts[piece], results, progress, error);
}

/* Networks of an earlier study in the folder do not count: those of this one have a piece. */
static bool ready(void *context, int64_t piece) {
    const PaperPlan *plan = context;
    bool done = true;
    for (int i = 0; done && plan->parts[piece].needs_networks && i < plan->network_count; i++)
        done = pieces_find(plan->pieces, i, &done, NULL, &(Error){0}) && done;
    return done;
}

static bool paper_plan_whole(void *context, int64_t piece, const char *results, size_t size, bool *there,
                             Error *error) {
    const PaperPlan *plan = context;
    (void)size;
    *there = true;
    return piece >= plan->network_count || paper_training_whole(plan, &plan->parts[piece], results, there, error);
}

static bool paper_plan_begin(PaperPlan *plan, const PaperOptions *options, Error *error) {
    plan->options = options;
    plan->size = options->quick ? &paper_quick_size : &paper_whole_size;
    plan->networks = malloc((size_t)paper_network_count * sizeof *plan->networks);
    if (plan->networks == NULL) return error_memory(error, "paper");
    choose_networks(plan);
    return file_path(plan->networks_folder, sizeof plan->networks_folder, error, "%s/networks", options->folder) &&
           paper_datasets_begin(&plan->datasets, options->scenes, &plan->size->data, options->seed, error);
}

bool paper_plan_make(PaperPlan *plan, const PaperOptions *options, Error *error) {
    *plan = (PaperPlan){0};
    if (!paper_plan_begin(plan, options, error) || !add_trainings(plan, error) || !add_scorings(plan, error) ||
        !add_laws(plan, error) || !add_transfers(plan, error) || !add_systems(plan, error))
        return false;
    while (!plan->parts[plan->first_timed].timed) plan->first_timed++;
    plan->plan = (PiecePlan){.count = (int64_t)plan->count,
                             .describe = paper_plan_describe,
                             .work = paper_plan_work,
                             .ready = ready,
                             .whole = paper_plan_whole,
                             .context = plan};
    return true;
}

void paper_plan_free(PaperPlan *plan) {
    free(plan->parts);
    free(plan->networks);
    paper_datasets_free(&plan->datasets);
    *plan = (PaperPlan){0};
}
