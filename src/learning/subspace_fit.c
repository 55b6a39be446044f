/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits a predictor of subspace: its linear term, its scales, and slopes through windows of predictions. */
#include "base/base.h"
#include "base/random.h"
#include "learning/subspace_fit.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shares of a component's root mean square: noise of the two states that a window starts with, and of their
   difference. */
static const double noise_of_state = 0.01, noise_of_change = 0.01;

static const float *window_state(const WindowData *data, int launch, int state) {
    return data->components + ((size_t)launch * (size_t)data->rows->states + (size_t)state) * (size_t)data->stride;
}

void window_linear(const WindowData *data, double *linear) {
    for (int k = 0; k < data->count; k++) {
        double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0;
        for (int launch = 0; launch < data->rows->launches; launch++)
            for (int s = 2; s < data->rows->states; s++) {
                const double x = (double)window_state(data, launch, s - 1)[k],
                             y = (double)window_state(data, launch, s - 2)[k],
                             target = (double)window_state(data, launch, s)[k];
                xx += x * x, xy += x * y, yy += y * y, xt += x * target, yt += y * target;
            }
        const double determinant = xx * yy - xy * xy;
        const bool regular = determinant > 1e-12 * xx * yy;
        linear[k] = regular ? (xt * yy - yt * xy) / determinant : 1;
        linear[data->count + k] = regular ? (yt * xx - xt * xy) / determinant : 0;
    }
}

static double inverse_root(double squares, double count) {
    const double root = sqrt(squares / count);
    return root > 1e-9 ? 1 / root : 0;
}

static void find_scales(const WindowData *data, WindowScales *scales) {
    const PoseRows *rows = data->rows;
    const double count = (double)rows->launches * (rows->states - 2);
    for (int k = 0; k < data->count; k++) {
        double values = 0, changes = 0, left = 0;
        for (int launch = 0; launch < rows->launches; launch++)
            for (int s = 2; s < rows->states; s++) {
                const double x = (double)window_state(data, launch, s - 1)[k],
                             y = (double)window_state(data, launch, s - 2)[k],
                             z = (double)window_state(data, launch, s)[k];
                const double error = z - data->linear[k] * x - data->linear[data->count + k] * y;
                values += x * x, changes += (x - y) * (x - y), left += error * error;
            }
        scales->value[k] = inverse_root(values, count);
        scales->change[k] = inverse_root(changes, count);
        scales->output[k] = sqrt(left / count);
        scales->noise[k] = noise_of_state * sqrt(values / count);
        scales->change_noise[k] = noise_of_change * sqrt(changes / count);
    }
    for (int j = 0; j < SUBSPACE_LAUNCH; j++) {
        double sum = 0, squares = 0;
        for (int i = 0; i < rows->launches; i++) sum += (double)rows->launch[i * SUBSPACE_LAUNCH + j];
        const double mean = sum / rows->launches;
        for (int i = 0; i < rows->launches; i++) {
            const double away = (double)rows->launch[i * SUBSPACE_LAUNCH + j] - mean;
            squares += away * away;
        }
        scales->launch_offset[j] = mean;
        scales->launch[j] = inverse_root(squares, rows->launches);
    }
}

/* rows[from, lanes] = weights[to, from], transposed; row i times in[i], lane j times out[j] (NULL: 1). */
static const double *store_layer(const double *weights, int to, const double *in, const double *out,
                                 SubspaceLayer *layer) {
    const double *biases = weights + (size_t)to * (size_t)layer->from;
    for (int j = 0; j < to; j++) {
        const double by = out != NULL ? out[j] : 1;
        for (int i = 0; i < layer->from; i++)
            layer->rows[(size_t)i * (size_t)layer->lanes + (size_t)j] =
                (float)(weights[(size_t)j * (size_t)layer->from + (size_t)i] * (in != NULL ? in[i] : 1) * by);
        layer->biases[j] = (float)(biases[j] * by);
    }
    return biases + to;
}

void window_fit_store(const WindowFit *fit, const double *parameters, SubspacePredictor *predictor) {
    const WindowData *data = fit->data;
    const WindowScales *scales = &fit->scales;
    const int count = data->count, hidden = predictor->second.from;
    double in[2 * SUBSPACE_COMPONENTS_MAX + SUBSPACE_LAUNCH];
    for (int k = 0; k < count; k++) {
        in[k] = scales->value[k];
        in[count + k] = scales->change[k];
        predictor->linear[k] = (float)data->linear[k];
        predictor->linear[predictor->last.lanes + k] = (float)data->linear[count + k];
    }
    memcpy(in + 2 * count, scales->launch, sizeof scales->launch);
    const double *second = store_layer(parameters, hidden, in, NULL, &predictor->first);
    for (int j = 0; j < hidden; j++) {
        const double *weights = parameters + (size_t)j * (size_t)predictor->first.from + 2 * (size_t)count;
        double shift = 0;
        for (int i = 0; i < SUBSPACE_LAUNCH; i++) shift += weights[i] * scales->launch[i] * scales->launch_offset[i];
        predictor->first.biases[j] =
            (float)(parameters[(size_t)hidden * (size_t)predictor->first.from + (size_t)j] - shift);
    }
    store_layer(store_layer(second, hidden, NULL, NULL, &predictor->second), count, NULL, scales->output,
                &predictor->last);
}

/* m: errors far below it count by their squares, errors far above by their size: impacts scatter. */
static const double robust_length = 0.05;

/* s: an error of a change in a step counts as much as this many such changes in the state. */
static const double change_weight = 4;

struct WindowPart {
    NetworkBlock *blocks[WINDOW_FRAMES];
    double *states;   /* [WINDOW_FRAMES + 2, count, BLOCK_ROWS] z: two of the start, then predicted */
    double *targets;  /* the same, recorded */
    double *slopes;   /* the same, d loss / d z */
    double *inputs;   /* [inputs, BLOCK_ROWS] d loss / d inputs */
    double *gradient; /* [parameters] */
    double loss;
};

static void destroy_part(WindowPart *part) {
    if (part == NULL) return;
    for (int t = 0; t < WINDOW_FRAMES; t++) network_block_destroy(part->blocks[t]);
    free(part->states);
    free(part);
}

static WindowPart *make_part(const WindowFit *fit, Error *error) {
    const size_t states = (size_t)(WINDOW_FRAMES + 2) * (size_t)fit->data->count * BLOCK_ROWS;
    const size_t inputs = (size_t)fit->shape->widths[0] * BLOCK_ROWS;
    WindowPart *part = calloc(1, sizeof *part);
    if (part == NULL) return error_memory(error, "subspace"), NULL;
    part->states = calloc(3 * states + inputs + (size_t)network_parameter_count(fit->shape), sizeof *part->states);
    bool ok = part->states != NULL || error_memory(error, "subspace");
    for (int t = 0; ok && t < WINDOW_FRAMES; t++)
        ok = (part->blocks[t] = network_block_create(fit->shape, error)) != NULL;
    if (!ok) return destroy_part(part), NULL;
    part->targets = part->states + states;
    part->slopes = part->targets + states;
    part->inputs = part->slopes + states;
    part->gradient = part->inputs + inputs;
    return part;
}

WindowFit *window_fit_create(const WindowData *data, int hidden, Error *error) {
    const int widths[4] = {2 * data->count + SUBSPACE_LAUNCH, hidden, hidden, data->count};
    WindowFit *fit = calloc(1, sizeof *fit);
    if (fit == NULL) return error_memory(error, "subspace"), NULL;
    fit->data = data;
    fit->shape = network_create(3, widths, error);
    bool ok = fit->shape != NULL;
    if (ok) fit->shape->activations[0] = fit->shape->activations[1] = ACTIVATION_TANH;
    for (int p = 0; ok && p < WINDOW_PARTS; p++) ok = (fit->parts[p] = make_part(fit, error)) != NULL;
    if (!ok) return window_fit_destroy(fit), NULL;
    find_scales(data, &fit->scales);
    return fit;
}

void window_fit_destroy(WindowFit *fit) {
    if (fit == NULL) return;
    for (int p = 0; p < WINDOW_PARTS; p++) destroy_part(fit->parts[p]);
    network_destroy(fit->shape);
    free(fit);
}

static double *plane(const WindowFit *fit, double *states, int t, int k) {
    return states + ((size_t)t * (size_t)fit->data->count + (size_t)k) * BLOCK_ROWS;
}

/* Starts are denser near the launch: the square of a uniform number, as boxes rest in most of the later frames. */
static void choose_windows(const WindowFit *fit, WindowPart *part, uint64_t seed) {
    const WindowData *data = fit->data;
    const int starts = data->rows->states - WINDOW_FRAMES - 1;
    uint64_t random = seed;
    double *launches = part->blocks[0]->values[0] + 2 * (size_t)data->count * BLOCK_ROWS;
    for (int r = 0; r < BLOCK_ROWS; r++) {
        const int launch = random_below(&random, data->rows->launches);
        const double share = random_unit(&random);
        const int start = (int)(share * share * starts) % starts;
        for (int t = 0; t < WINDOW_FRAMES + 2; t++) {
            const float *state = window_state(data, launch, start + t);
            for (int k = 0; k < data->count; k++) plane(fit, part->targets, t, k)[r] = (double)state[k];
        }
        for (int k = 0; k < data->count; k++) {
            const double shift = fit->scales.noise[k] * random_signed(&random);
            const double change = fit->scales.change_noise[k] * random_signed(&random);
            plane(fit, part->states, 0, k)[r] = plane(fit, part->targets, 0, k)[r] + shift;
            plane(fit, part->states, 1, k)[r] = plane(fit, part->targets, 1, k)[r] + shift + change;
        }
        for (int j = 0; j < SUBSPACE_LAUNCH; j++)
            launches[j * BLOCK_ROWS + r] =
                ((double)data->rows->launch[launch * SUBSPACE_LAUNCH + j] - fit->scales.launch_offset[j]) *
                fit->scales.launch[j];
    }
    for (int t = 1; t < WINDOW_FRAMES; t++)
        memcpy(part->blocks[t]->values[0] + 2 * (size_t)data->count * BLOCK_ROWS, launches,
               SUBSPACE_LAUNCH * BLOCK_ROWS * sizeof *launches);
}

/* States t + 1 -> t + 2. */
static void forward_step(const WindowFit *fit, WindowPart *part, const double *parameters, int t) {
    const WindowData *data = fit->data;
    NetworkBlock *block = part->blocks[t];
    for (int k = 0; k < data->count; k++) {
        const double *now = plane(fit, part->states, t + 1, k), *last = plane(fit, part->states, t, k);
        double *value = block->values[0] + (size_t)k * BLOCK_ROWS, *change = value + (size_t)data->count * BLOCK_ROWS;
        const double by_value = fit->scales.value[k], by_change = fit->scales.change[k];
        for (int r = 0; r < BLOCK_ROWS; r++) {
            value[r] = now[r] * by_value;
            change[r] = (now[r] - last[r]) * by_change;
        }
    }
    network_forward(block, parameters);
    for (int k = 0; k < data->count; k++) {
        const double *now = plane(fit, part->states, t + 1, k), *last = plane(fit, part->states, t, k);
        const double *output = block->values[3] + (size_t)k * BLOCK_ROWS;
        const double a = data->linear[k], b = data->linear[data->count + k], scale = fit->scales.output[k],
                     low = (double)data->low[k], high = (double)data->high[k];
        double *next = plane(fit, part->states, t + 2, k);
        for (int r = 0; r < BLOCK_ROWS; r++) {
            const double z = (a * now[r] + b * last[r]) + scale * output[r];
            next[r] = z < low ? low : z > high ? high : z;
        }
    }
}

/* Adds the loss of states t and t + 1, of which t + 1 is predicted, and its slopes: sqrt(e^2 + l^2) - l of the length e
   of the error of all components, and of the error of their change. */
static void add_loss(const WindowFit *fit, WindowPart *part, int t) {
    const int count = fit->data->count;
    double position[BLOCK_ROWS] = {0}, change[BLOCK_ROWS] = {0};
    for (int k = 0; k < count; k++) {
        const double *z = plane(fit, part->states, t + 1, k), *before = plane(fit, part->states, t, k),
                     *target = plane(fit, part->targets, t + 1, k), *target_before = plane(fit, part->targets, t, k);
        for (int r = 0; r < BLOCK_ROWS; r++) {
            const double e = z[r] - target[r], d = change_weight * (e - (before[r] - target_before[r]));
            position[r] += e * e;
            change[r] += d * d;
        }
    }
    const double share = 1.0 / (WINDOW_FRAMES * BLOCK_ROWS);
    for (int r = 0; r < BLOCK_ROWS; r++) {
        position[r] = sqrt(position[r] + robust_length * robust_length);
        change[r] = sqrt(change[r] + robust_length * robust_length);
        part->loss += share * (position[r] + change[r] - 2 * robust_length);
        position[r] = share / position[r];
        change[r] = share / change[r];
    }
    for (int k = 0; k < count; k++) {
        const double *z = plane(fit, part->states, t + 1, k), *before = plane(fit, part->states, t, k),
                     *target = plane(fit, part->targets, t + 1, k), *target_before = plane(fit, part->targets, t, k);
        double *slope = plane(fit, part->slopes, t + 1, k), *slope_before = plane(fit, part->slopes, t, k);
        for (int r = 0; r < BLOCK_ROWS; r++) {
            const double e = z[r] - target[r],
                         d = change_weight * change_weight * change[r] * (e - (before[r] - target_before[r]));
            slope[r] += position[r] * e + d;
            slope_before[r] -= d;
        }
    }
}

/* From the slopes of state t + 2 to those of t + 1 and t, and of the parameters. */
static void backward_step(const WindowFit *fit, WindowPart *part, const double *parameters, int t) {
    const WindowData *data = fit->data;
    NetworkBlock *block = part->blocks[t];
    for (int k = 0; k < data->count; k++) {
        const double *next = plane(fit, part->states, t + 2, k), scale = fit->scales.output[k], a = data->linear[k],
                     b = data->linear[data->count + k], low = (double)data->low[k], high = (double)data->high[k];
        double *slope = plane(fit, part->slopes, t + 2, k), *to_now = plane(fit, part->slopes, t + 1, k),
               *to_last = plane(fit, part->slopes, t, k), *delta = block->deltas[2] + (size_t)k * BLOCK_ROWS;
        for (int r = 0; r < BLOCK_ROWS; r++) {
            const double passed = next[r] > low && next[r] < high ? slope[r] : 0; /* a clamped value has no slope */
            delta[r] = scale * passed;
            to_now[r] += a * passed;
            to_last[r] += b * passed;
        }
    }
    network_backward(block, parameters);
    network_add_gradient(block, part->gradient);
    network_backward_to_inputs(block, parameters, part->inputs);
    for (int k = 0; k < data->count; k++) {
        const double *value = part->inputs + (size_t)k * BLOCK_ROWS, *change = value + (size_t)data->count * BLOCK_ROWS;
        double *to_now = plane(fit, part->slopes, t + 1, k), *to_last = plane(fit, part->slopes, t, k);
        for (int r = 0; r < BLOCK_ROWS; r++) {
            to_now[r] += fit->scales.value[k] * value[r] + fit->scales.change[k] * change[r];
            to_last[r] -= fit->scales.change[k] * change[r];
        }
    }
}

double window_fit_slopes(WindowFit *fit, const double *parameters, uint64_t seed, double *slopes) {
    const int count = network_parameter_count(fit->shape);
    const size_t states = (size_t)(WINDOW_FRAMES + 2) * (size_t)fit->data->count * BLOCK_ROWS;
    double loss = 0;
#pragma omp parallel for schedule(static, 1)
    for (int p = 0; p < WINDOW_PARTS; p++) {
        WindowPart *part = fit->parts[p];
        memset(part->slopes, 0, states * sizeof *part->slopes);
        memset(part->gradient, 0, (size_t)count * sizeof *part->gradient);
        part->loss = 0;
        choose_windows(fit, part, seed * WINDOW_PARTS + (uint64_t)p);
        for (int t = 0; t < WINDOW_FRAMES; t++) forward_step(fit, part, parameters, t);
        for (int t = 1; t <= WINDOW_FRAMES; t++) add_loss(fit, part, t);
        for (int t = WINDOW_FRAMES - 1; t >= 0; t--) backward_step(fit, part, parameters, t);
    }
    for (int i = 0; i < count; i++) {
        slopes[i] = 0;
        for (int p = 0; p < WINDOW_PARTS; p++) slopes[i] += fit->parts[p]->gradient[i] / WINDOW_PARTS;
    }
    for (int p = 0; p < WINDOW_PARTS; p++) loss += fit->parts[p]->loss / WINDOW_PARTS;
    return loss;
}

void window_fit_begin(const WindowFit *fit, uint64_t seed, double *parameters) {
    uint64_t random = seed;
    for (int l = 0; l < fit->shape->layers; l++) /* a tenth for the outputs */
        parameters =
            weights_of_layer(parameters, fit->shape->widths[l], fit->shape->widths[l + 1], l == 2 ? 0.1 : 1, &random);
}
