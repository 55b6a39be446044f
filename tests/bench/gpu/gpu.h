/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks on a graphics device, by shaders/network.comp. For the benchmark and its test: no other code uses it. */
#pragma once
#include "nets/kinds.h"
#include "nets/nets.h"
#include "pixels/gl.h"
#include "pixels/gl_functions.h"

typedef struct Gpu {
    Context context;
    GlFunctions gl;
    PFNGLBINDBUFFERBASEPROC BindBufferBase;
    PFNGLDISPATCHCOMPUTEPROC DispatchCompute;
    PFNGLFINISHPROC Finish;
    PFNGLGETBUFFERSUBDATAPROC GetBufferSubData;
    PFNGLMEMORYBARRIERPROC MemoryBarrier;
    char name[96];      /* of the device, without commas */
    GLint buffer_bytes; /* that a shader sees of a buffer */
} Gpu;

/* Takes over a context that is current. ERROR_SYSTEM: no OpenGL 4.3; the context is destroyed. */
bool gpu_open(Gpu *gpu, Context context, Error *error);
void gpu_close(Gpu *gpu);

/* Rows of a work group; groups in a line, which every device takes; turns of loops: Mesa's software renderer leaves out
   those beyond 65,535. */
enum { GPU_GROUP = 64, GPU_GROUPS = 65535, GPU_TURNS_MAX = 60000 };

/* A network on a device with its buffers: the network, inputs, outputs. Free it in any case. */
typedef struct GpuNet {
    const Gpu *gpu; /* outlives it */
    unsigned program, buffers[3];
    size_t inputs, outputs, room; /* rows for which there is room */
} GpuNet;

/* half: layers in float16; ERROR_SYSTEM: the device has none. ERROR_INPUT: beyond GPU_TURNS_MAX. */
bool gpu_network(GpuNet *net, const Gpu *gpu, const Network *network, bool half, Error *error);
void gpu_net_free(GpuNet *net);

/* The layers of a scene network, from what scene_net_look() gives to the impulses of all slots, present or not. NULL
   with ERROR_INPUT: more slots than a layer may have outputs. */
Network *gpu_scene_layers(const SceneNet *network, Error *error);

/* A batch, as of network_predict_batch(). inputs NULL: those on the device; outputs NULL: they stay there. ERROR_INPUT:
   more than a buffer of the device; ERROR_SYSTEM: more than its memory. */
bool gpu_run(GpuNet *net, const float *inputs, float *outputs, size_t rows, Error *error);
