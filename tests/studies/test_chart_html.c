/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the page of a chart says of times: on which processor they were measured, which are left out, and which vary. */
#include "owned.h"
#include "files.h"

#include "studies/chart_pages.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"

static ChartRow make_row(const char *scene, const char *method, const char *cpu) {
    const bool timed = cpu[0] != '\0';
    return (ChartRow){.scene = scene,
                      .method = method,
                      .setting = "k=10",
                      .protocol = PROTOCOL_CLOSED,
                      .phase = PHASE_IMPACT,
                      .launches = 7,
                      .us_solver = timed ? 5 : NAN,
                      .us_solver_q1 = timed ? 4 : NAN,
                      .us_solver_q3 = timed ? 6 : NAN,
                      .us_step = NAN,
                      .instructions = NAN,
                      .error_mean = 0.5,
                      .error_median = NAN,
                      .error_p95 = NAN,
                      .error_worst = NAN,
                      .share_right = NAN,
                      .penetration_max = NAN,
                      .drift = NAN,
                      .energy = NAN,
                      .moved = NAN,
                      .cpu = cpu};
}

/* The page of these rows, without links. To be freed. */
static char *write_page(const ChartRow *rows, int count) {
    Error error = {0};
    assert_ok(csv_table_write(temporary_path("chart.csv"), &chart_layout, rows, count, &error), error);
    assert_ok(csv_table_write(temporary_path("chart_pages.csv"), &launch_page_layout, NULL, 0, &error), error);
    assert_ok(chart_html_write(temporary_folder, &(ChartLook){0}, &error), error);
    return text_of(temporary_path("chart.html"));
}

TEST(the_page_names_the_processor) {
    const ChartRow rows[] = {make_row("single", "engine", "Quick & <Co>"), make_row("stack", "engine", "Quick & <Co>")};
    FREED char *text = write_page(rows, 2);
    assert_non_null(strstr(text, "<p class=\"soft\">Times measured on Quick &amp; &lt;Co&gt;.</p>"));
    assert_non_null(strstr(text, "src=\"chart-stack.svg\""));
    assert_null(strstr(text, "Without a chart"));
}

TEST(a_scene_without_times_has_no_chart) {
    const ChartRow rows[] = {make_row("single", "engine", "AMD"), make_row("stack", "engine", "")};
    FREED char *text = write_page(rows, 2);
    assert_non_null(strstr(text, "Times measured on AMD. Those of other processors are left out."));
    const char *stack = strstr(text, "<h2>stack, 7 launches</h2>");
    assert_non_null(stack);
    assert_non_null(strstr(stack, "Without a chart: its times were measured on another processor."));
    assert_null(strstr(text, "src=\"chart-stack.svg\""));
    assert_non_null(strstr(text, "src=\"chart-single.svg\""));
}

TEST(times_that_vary_are_named) {
    ChartRow rows[] = {make_row("single", "engine", "AMD"), make_row("single", "momentum", "AMD")};
    const LaunchPage pages[] = {
        {.scene = "single", .method = "engine", .setting = "k=10", .launch = 1, .mass = 1, .page = ""},
        {.scene = "single", .method = "momentum", .setting = "k=10", .launch = 1, .mass = 1, .page = ""}};
    rows[1].us_varies = 1;
    assert_ok(csv_table_write(temporary_path("chart.csv"), &chart_layout, rows, 2, &error), error);
    assert_ok(csv_table_write(temporary_path("chart_pages.csv"), &launch_page_layout, pages, 2, &error), error);
    assert_ok(chart_html_write(temporary_folder, &(ChartLook){0}, &error), error);
    FREED char *text = text_of(temporary_path("chart.html"));
    assert_non_null(strstr(text, "Times measured on AMD. 1 of 2 vary more than the others, also when measured again."));
    assert_non_null(strstr(text, "<th scope=\"row\">engine</th><td>k=10</td><td class=\"number\">5</td>"));
    assert_non_null(strstr(text, "<th scope=\"row\">momentum</th><td>k=10</td><td class=\"number\">5 varies</td>"));
}

TEST(old_tables_name_no_processor) {
    ChartRow rows[] = {make_row("single", "engine", "AMD")};
    rows[0].cpu = "";
    FREED char *text = write_page(rows, 1);
    assert_null(strstr(text, "Times measured"));
}

RUN_TESTS(NULL, NULL)
