/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a test owns and lets go at the end of the block: OWN(Scene) *scene = scene_named("stack"); FREED char *text =
   ... The last declared goes first. */
#pragma once
#include "testing.h"

#include "base/csv.h"
#include "base/npz.h"
#include "learning/dataset.h"
#include "learning/launches.h"
#include "learning/scene_training.h"
#include "methods/block_lu.h"
#include "methods/hybrid_memory.h"
#include "methods/reference.h"
#include "methods/sain.h"
#include "methods/sweeps.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "pixels/png.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "studies/contenders.h"

#define OWN(Type) __attribute__((cleanup(own_##Type))) Type
#define OWNED_POINTER(Type, destroy) \
    static inline void own_##Type(Type **owned) { destroy(*owned); }
#define OWNED_VALUE(Type, destroy) \
    static inline void own_##Type(Type *owned) { destroy(owned); }

OWNED_POINTER(Dataset, dataset_destroy)
OWNED_POINTER(HybridMemory, hybrid_memory_destroy)
OWNED_POINTER(Image, image_destroy)
OWNED_POINTER(Network, network_destroy)
OWNED_POINTER(NpzFile, npz_close)
OWNED_POINTER(PngEncoder, png_encoder_destroy)
OWNED_POINTER(Scene, scene_destroy)
OWNED_POINTER(SceneNet, scene_net_destroy)
OWNED_POINTER(Stepper, stepper_destroy)
OWNED_POINTER(SubspaceNet, subspace_net_destroy)
OWNED_POINTER(Trajectory, trajectory_destroy)
OWNED_POINTER(World, world_destroy)
OWNED_VALUE(BlockLu, block_lu_free)
OWNED_VALUE(ContenderList, contenders_free)
OWNED_VALUE(CsvTable, csv_table_free)
OWNED_VALUE(GnsNet, gns_net_free)
OWNED_VALUE(Reference, reference_free)
OWNED_VALUE(SainNetwork, sain_network_destroy)
OWNED_VALUE(RecordedSteps, recorded_steps_free)
OWNED_VALUE(SceneNetSamples, scene_net_samples_free)
OWNED_VALUE(Subspace, subspace_free)
OWNED_VALUE(Sweeps, sweeps_free)

#define FREED __attribute__((cleanup(free_owned)))
static inline void free_owned(void *owned) { free(*(void **)owned); }
