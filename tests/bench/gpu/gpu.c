/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

static bool gpu_check(const Gpu *gpu, const char *when, Error *error) {
    const GLenum problem = gpu->gl.GetError();
    return problem == GL_NO_ERROR || error_system(error, "gpu", "OpenGL error 0x%04x %s", problem, when);
}

bool gpu_open(Gpu *gpu, Context context, Error *error) {
    GLint version[2] = {0};
    *gpu = (Gpu){.context = context};
    bool ok = gl_load(&gpu->gl, context.kind->find, context.state, error);
    for (int i = 0; ok && i < 2; i++) gpu->gl.GetIntegerv(i == 0 ? GL_MAJOR_VERSION : GL_MINOR_VERSION, &version[i]);
    if (ok && 10 * version[0] + version[1] < 43)
        ok = error_system(error, "gpu", "compute shaders need OpenGL 4.3 (found %d.%d)", version[0], version[1]);
    if (!ok) return gpu_close(gpu), false;
#define LOAD(type, name) gpu->name = (type)context.kind->find(context.state, "gl" #name)
    LOAD(PFNGLBINDBUFFERBASEPROC, BindBufferBase), LOAD(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute);
    LOAD(PFNGLGETBUFFERSUBDATAPROC, GetBufferSubData), LOAD(PFNGLMEMORYBARRIERPROC, MemoryBarrier);
    LOAD(PFNGLFINISHPROC, Finish);
    gpu->gl.GetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &gpu->buffer_bytes);
    text_add(gpu->name, sizeof gpu->name, "%s", (const char *)gpu->gl.GetString(GL_RENDERER));
    for (char *comma = gpu->name; (comma = strchr(comma, ',')) != NULL;) *comma = ';';
    return true;
}

void gpu_close(Gpu *gpu) { context_destroy(&gpu->context); }

/* Extensions that a device has are macros. */
static const char float16[] =
    "#ifdef GL_AMD_gpu_shader_half_float\n#extension GL_AMD_gpu_shader_half_float : require\n#else\n"
    "#extension GL_NV_gpu_shader5 : require\n#endif\n#define REAL float16_t\n";

/* numbers NULL: only takes memory. */
static bool gpu_fill(const GpuNet *net, int buffer, size_t count, const float *numbers, Error *error) {
    const GlFunctions *gl = &net->gpu->gl;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, net->buffers[buffer]);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)(count * sizeof *numbers), numbers, GL_DYNAMIC_COPY);
    return gpu_check(net->gpu, "while memory was taken", error);
}

/* sizes: the network's, in GLSL. */
static bool gpu_program(GpuNet *net, const char *sizes, bool half, Error *error) {
    static const char path[] = SOURCE_DIR "/shaders/network.comp";
    const GlFunctions *gl = &net->gpu->gl;
    char head[2048] = "#version 430\n", log[1024] = "";
    GLint linked = 0;
    size_t size;
    char *text = file_read(path, 1 << 16, &size, error);
    if (text == NULL) return false;
    text_add(head, sizeof head, "%s#define GROUP %d\n%s", half ? float16 : "#define REAL float\n", GPU_GROUP, sizes);
    const GLuint shader = gl->CreateShader(GL_COMPUTE_SHADER);
    gl->ShaderSource(shader, 2, (const char *[]){head, text}, NULL);
    gl->CompileShader(shader);
    gl->GetShaderInfoLog(shader, sizeof log, NULL, log);
    net->program = gl->CreateProgram();
    gl->AttachShader(net->program, shader);
    gl->LinkProgram(net->program);
    gl->GetProgramiv(net->program, GL_LINK_STATUS, &linked);
    gl->DeleteShader(shader);
    free(text);
    return linked || error_system(error, path, "the shader does not compile: %s", log);
}

bool gpu_network(GpuNet *net, const Gpu *gpu, const Network *network, bool half, Error *error) {
    const int last = network->layers - 1, *widths = network->widths, inputs = widths[0], outputs = widths[last + 1];
    const int parameters = network_parameter_count(network), numbers = parameters + 2 * (inputs + outputs);
    int widest = inputs, turns = inputs + GPU_GROUP * (widths[last] + 1); /* of all loops of an invocation */
    char sizes[1024] = "#define LAYERS";
    *net = (GpuNet){.gpu = gpu, .inputs = (size_t)inputs, .outputs = (size_t)outputs};
    for (int l = 0; l < last; l++) {
        text_add(sizes, sizeof sizes, " LAYER(%d, %d, %d)", widths[l], widths[l + 1], network->activations[l]);
        widest = widths[l + 1] > widest ? widths[l + 1] : widest;
        turns += (widths[l] + 1) * widths[l + 1];
    }
    if (turns > GPU_TURNS_MAX)
        return error_input(error, "gpu", "the network takes %d turns of loops; the shader takes up to %d", turns,
                           GPU_TURNS_MAX);
    text_add(sizes, sizeof sizes,
             "\nconst int INPUTS = %d, OUTPUTS = %d, LAST = %d, LAST_KIND = %d, WIDEST = %d, PARAMETERS = %d;\n",
             inputs, outputs, widths[last], network->activations[last], widest, parameters);
    if (!gpu_program(net, sizes, half, error)) return false;
    gpu->gl.GenBuffers(3, net->buffers);
    return gpu_fill(net, 0, (size_t)numbers, network->weights[0], error);
}

Network *gpu_scene_layers(const SceneNet *network, Error *error) {
    const int inputs = scene_net_inputs(network), hidden = scene_net_hidden(network), outputs = 2 * network->slot_count;
    const PackedRows *const packed[] = {&network->first.packed, &network->second.packed, &network->packed};
    const float *const biases[] = {network->first.biases, network->second.biases, network->biases};
    Network *layers = network_create(3, (int[]){inputs, hidden, hidden, outputs}, error);
    for (int l = 0; layers != NULL && l < 3; l++) {
        const int from = layers->widths[l], to = layers->widths[l + 1], width = packed[l]->width;
        layers->activations[l] = l < 2 ? ACTIVATION_TANH : ACTIVATION_LINEAR;
        for (int j = 0; j < to; j++) {
            const float scale = l < 2 ? 1 : network->scale[j / 2];
            layers->biases[l][j] = scale * biases[l][j];
            for (int i = 0; i < from; i++) { /* of hidden layers, a row is an input's; of the last, an output's */
                const int row = l < 2 ? i : j, column = l < 2 ? j : i;
                const float number = packed[l]->units[row] * (float)packed[l]->numbers[row * width + column];
                layers->weights[l][j * from + i] = scale * number;
            }
        }
    }
    return layers;
}

void gpu_net_free(GpuNet *net) {
    if (net->gpu == NULL) return;
    net->gpu->gl.DeleteProgram(net->program);
    net->gpu->gl.DeleteBuffers(3, net->buffers);
}

static bool gpu_reserve(GpuNet *net, size_t rows, Error *error) {
    const size_t widest = net->inputs > net->outputs ? net->inputs : net->outputs;
    if (rows > (size_t)net->gpu->buffer_bytes / sizeof(float) / widest)
        return error_input(error, "gpu", "%zu rows of %zu numbers; a buffer of the device has up to %d bytes", rows,
                           widest, net->gpu->buffer_bytes);
    if (rows <= net->room) return true;
    const bool ok =
        gpu_fill(net, 1, rows * net->inputs, NULL, error) && gpu_fill(net, 2, rows * net->outputs, NULL, error);
    net->room = ok ? rows : 0;
    return ok;
}

bool gpu_run(GpuNet *net, const float *inputs, float *outputs, size_t rows, Error *error) {
    const Gpu *gpu = net->gpu;
    if (rows == 0) return true;
    if (!gpu_reserve(net, rows, error)) return false;
    const size_t groups = (rows + GPU_GROUP - 1) / GPU_GROUP, lines = (groups + GPU_GROUPS - 1) / GPU_GROUPS;
    const GLsizeiptr number = (GLsizeiptr)(rows * sizeof(float));
    for (GLuint i = 0; i < 3; i++) gpu->BindBufferBase(GL_SHADER_STORAGE_BUFFER, i, net->buffers[i]);
    gpu->gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, net->buffers[1]);
    if (inputs != NULL) gpu->gl.BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, number * (GLsizeiptr)net->inputs, inputs);
    gpu->gl.UseProgram(net->program);
    gpu->gl.Uniform2i(gpu->gl.GetUniformLocation(net->program, "size"), (GLint)rows, 0);
    gpu->DispatchCompute((GLuint)((groups + lines - 1) / lines), (GLuint)lines,
                         (GLuint)((net->outputs + GPU_GROUP - 1) / GPU_GROUP));
    gpu->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gpu->gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, net->buffers[2]);
    if (outputs != NULL) gpu->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, number * (GLsizeiptr)net->outputs, outputs);
    if (outputs == NULL) gpu->Finish();
    return gpu_check(gpu, "in a batch", error);
}
