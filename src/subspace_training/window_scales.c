/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subspace_training/window_scales.h"

#include <math.h>
#include <string.h>

/* Shares of a component's root mean square: noise of the two states that a window starts with, and of their difference. */
static const double noise_of_state = 0.01, noise_of_change = 0.01;

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

static void scale_component(const WindowData *data, int k, WindowScales *scales) {
    double values = 0, changes = 0, left = 0;
    const double count = (double)data->rows->launches * (data->rows->states - 2);
    for (int launch = 0; launch < data->rows->launches; launch++)
        for (int s = 2; s < data->rows->states; s++) {
            const double x = (double)window_state(data, launch, s - 1)[k],
                         y = (double)window_state(data, launch, s - 2)[k], z = (double)window_state(data, launch, s)[k];
            const double error = z - data->linear[k] * x - data->linear[data->count + k] * y;
            values += x * x, changes += (x - y) * (x - y), left += error * error;
        }
    scales->value[k] = inverse_root(values, count);
    scales->change[k] = inverse_root(changes, count);
    scales->output[k] = sqrt(left / count);
    scales->noise[k] = noise_of_state * sqrt(values / count);
    scales->change_noise[k] = noise_of_change * sqrt(changes / count);
}

static void scale_launch(const PoseRows *rows, int j, WindowScales *scales) {
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

void window_scales_find(const WindowData *data, WindowScales *scales) {
    for (int k = 0; k < data->count; k++) scale_component(data, k, scales);
    for (int j = 0; j < SUBSPACE_LAUNCH; j++) scale_launch(data->rows, j, scales);
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

void window_scales_store(const WindowData *data, const WindowScales *scales, const double *parameters,
                         SubspacePredictor *predictor) {
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
