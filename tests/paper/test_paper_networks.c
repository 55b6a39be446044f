/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study is honest only if one factor is varied at a time. */
#include "testing.h"

#include "paper/paper_internal.h"

enum { FACTORS_SIZE = 256 };

/* The hidden widths of "10-8-8-2": "-8-8-"; the last one follows. */
static size_t hidden_widths(const char *layers, const char **begin) {
    *begin = layers + strcspn(layers, "-");
    return (size_t)(strrchr(layers, '-') + 1 - *begin);
}

/* In how many factors two networks with all defaults differ; names: "data layers ". The first width follows from the
   inputs, the last is the outputs'; the scaling belongs to the output's activation. */
static int factors_between(const PaperNetwork *a, const PaperNetwork *b, char names[FACTORS_SIZE]) {
    const char *hidden_a, *hidden_b;
    const size_t length_a = hidden_widths(a->layers, &hidden_a), length_b = hidden_widths(b->layers, &hidden_b);
    const struct {
        const char *name;
        bool differs;
    } factors[] = {{"data", a->data != b->data},
                   {"labels", a->labels != b->labels},
                   {"inputs", a->view != b->view},
                   {"target", a->target != b->target},
                   {"outputs", strcmp(hidden_a + length_a, hidden_b + length_b) != 0},
                   {"layers", length_a != length_b || strncmp(hidden_a, hidden_b, length_a) != 0},
                   {"hidden", strcmp(a->hidden, b->hidden) != 0},
                   {"scaling", strcmp(a->output, b->output) != 0 || strcmp(a->scale, b->scale) != 0},
                   {"optimizer", strcmp(a->optimizer, b->optimizer) != 0},
                   {"loss", strcmp(a->loss, b->loss) != 0},
                   {"iterations", strcmp(a->optimizer, b->optimizer) == 0 && a->iterations != b->iterations}};
    int count = 0;
    names[0] = '\0';
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        if (!factors[i].differs) continue;
        strcat(strcat(names, factors[i].name), " ");
        count++;
    }
    return count;
}

TEST(one_factor_is_varied_at_a_time) {
    const PaperNetwork baseline = paper_network(0);
    int checked = 0; /* a training with lm takes fewer steps, which cost more */
    assert_string_equal(baseline.name, "baseline");
    for (int i = 1; i < paper_network_count; i++) {
        PaperNetwork network = paper_network(i), other = baseline;
        /* Those of Table 1 for the other targets, the paper's second network (3.1), and what goes beyond it. */
        if (strcmp(network.factor, "optimizer") == 0) other.target = network.target;
        if (strcmp(network.name, "outputs-six-two-layers") == 0 || strcmp(network.factor, "best") == 0 ||
            strcmp(network.factor, "contact-net") == 0)
            continue;
        char found[FACTORS_SIZE], wanted[64];
        factors_between(&network, &other, found);
        snprintf(wanted, sizeof wanted, "%s ", network.factor);
        if (strcmp(found, wanted) != 0) fail_msg("%s varies %s, not %s", network.name, found, wanted);
        checked++;
    }
    assert_true(checked > 25);
}

/* What README.md says of the networks: most differ from the paper's in one thing, some in several. */
TEST(networks_that_differ_in_several_things_are_counted) {
    static const char *const several[] = {"outputs-six-two-layers",
                                          "net-gd",
                                          "net-bfgs",
                                          "net-lm",
                                          "impulse-gd",
                                          "impulse-bfgs",
                                          "impulse-lm",
                                          "best-pair",
                                          "best-net",
                                          "best-impulse",
                                          "contact-net"};
    const PaperNetwork baseline = paper_network(0);
    int counts[3] = {0};
    for (int i = 0; i < paper_network_count; i++) {
        char found[FACTORS_SIZE];
        const PaperNetwork network = paper_network(i);
        const int differences = factors_between(&network, &baseline, found);
        if (differences > 1) assert_string_equal(network.name, several[counts[2]]);
        counts[differences > 1 ? 2 : differences]++;
    }
    assert_int_equal(counts[0], 1);
    assert_int_equal(counts[1], 27);
    assert_int_equal(counts[2], sizeof several / sizeof *several);
}

/* The sum, and the share of trainings. */
static double weigh(bool quick, double *trainings) {
    const PaperOptions options = {.scenes = SOURCE_DIR "/scenes", .folder = temporary_path("paper"), .quick = quick};
    Error error = {0};
    PaperPlan plan;
    double sum = 0;
    assert_ok(paper_plan_make(&plan, &options, &error), error);
    *trainings = 0;
    for (size_t i = 0; i < plan.count; i++) {
        sum += plan.parts[i].weight;
        if (i < (size_t)(plan.network_count * plan.size->splits)) *trainings += plan.parts[i].weight;
    }
    paper_plan_free(&plan);
    *trainings /= sum;
    return sum;
}

/* The time left follows from the weights, which are about seconds of a core, and of scores those of two. */
TEST(weights_are_the_seconds_of_the_help) {
    double trainings;
    assert_in_range((int)weigh(true, &trainings), 10, 60);
    assert_true(trainings > 0.1 && trainings < 0.7);
    assert_in_range((int)weigh(false, &trainings), 1200, 3600);
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
