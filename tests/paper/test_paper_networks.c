/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study is honest only if one factor is varied at a time. */
#include "testing.h"

#include "paper/paper.h"

/* Factors in which a network can be other than the baseline. The first width follows from the inputs, the last from
   the outputs; the scaling belongs to the output's activation. */
static void find_factors(const PaperNetwork *a, const PaperNetwork *b, char *factors) {
    int widths_a[2], widths_b[2];
    const char *last_a = strrchr(a->layers, '-') + 1, *last_b = strrchr(b->layers, '-') + 1;
    const size_t first_a = strcspn(a->layers, "-"), first_b = strcspn(b->layers, "-");
    widths_a[0] = atoi(a->layers), widths_a[1] = atoi(last_a);
    widths_b[0] = atoi(b->layers), widths_b[1] = atoi(last_b);
    const size_t middle_a = (size_t)(last_a - a->layers) - first_a, middle_b = (size_t)(last_b - b->layers) - first_b;
    factors[0] = '\0';
    if (a->data != b->data) strcat(factors, "data ");
    if (a->labels != b->labels) strcat(factors, "labels ");
    if (a->view != b->view) strcat(factors, "inputs ");
    if (a->target != b->target) strcat(factors, "target ");
    if (widths_a[1] != widths_b[1]) strcat(factors, "outputs ");
    if (middle_a != middle_b || strncmp(a->layers + first_a, b->layers + first_b, middle_a) != 0)
        strcat(factors, "layers ");
    if (strcmp(a->hidden, b->hidden) != 0) strcat(factors, "hidden ");
    if (strcmp(a->output, b->output) != 0 || strcmp(a->scale, b->scale) != 0) strcat(factors, "scaling ");
    if (strcmp(a->optimizer, b->optimizer) != 0) strcat(factors, "optimizer ");
    if (strcmp(a->loss, b->loss) != 0) strcat(factors, "loss ");
    if (a->iterations != b->iterations) strcat(factors, "iterations ");
}

TEST(one_factor_is_varied_at_a_time) {
    const PaperNetwork baseline = paper_network(0);
    int checked = 0;
    assert_string_equal(baseline.name, "baseline");
    for (int i = 1; i < paper_network_count; i++) {
        PaperNetwork network = paper_network(i), other = baseline;
        /* Those of Table 1 for the other targets, the paper's second network (3.1), and what goes beyond it. */
        if (strcmp(network.factor, "optimizer") == 0) other.target = network.target;
        if (strcmp(network.name, "outputs-six-two-layers") == 0 || strcmp(network.factor, "best") == 0 ||
            strcmp(network.factor, "contact-net") == 0)
            continue;
        char found[256], wanted[64];
        find_factors(&network, &other, found);
        snprintf(wanted, sizeof wanted, "%s ", network.factor);
        if (strcmp(found, wanted) != 0) fail_msg("%s varies %s, not %s", network.name, found, wanted);
        checked++;
    }
    assert_true(checked > 25);
}

TEST(names_are_file_names_and_differ) {
    for (int i = 0; i < paper_network_count; i++) {
        assert_int_equal(strspn(paper_networks[i].name, "abcdefghijklmnopqrstuvwxyz0123456789-"),
                         strlen(paper_networks[i].name));
        for (int k = 0; k < i; k++) assert_string_not_equal(paper_networks[i].name, paper_networks[k].name);
    }
}

/* The first width is that of the view, the last one that the target has a meaning for; the best have at most 500
   parameters. */
TEST(layers_fit_views_and_targets) {
    for (int i = 0; i < paper_network_count; i++) {
        const PaperNetwork network = paper_network(i);
        int parameters = 0, before = 0;
        for (char *rest = (char *)network.layers; *rest != '\0'; rest += *rest == '-') {
            int width = (int)strtol(rest, &rest, 10);
            if (before > 0) parameters += (before + 1) * width;
            if (before == 0) assert_int_equal(width, pair_views[network.view].count);
            before = width;
        }
        assert_non_null(pair_output_names(network.view, network.target, before));
        if (strcmp(network.factor, "best") == 0) assert_true(parameters <= 500);
    }
}

RUN_TESTS(NULL, NULL)
