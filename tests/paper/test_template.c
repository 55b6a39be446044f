/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "paper/report_internal.h"

static void write_file(const char *name, const char *text) { write_bytes(temporary_path(name), text, strlen(text)); }

static void write_tables(void) {
    write_file("values.csv", "key,value\nruns,12\nshare,0.125\nnone,\nbig,123456\nscene,stack\n"
                             "long,\"A text that is certainly longer than a name may be, *\xc3\xa4*\"\n");
    write_file("runs.csv", "network,scene,frames,time\nbaseline,single,600,2\nbaseline,stack,5,4\nother,stack,,0\n");
    write_file("scenes.csv", "scene,boxes\nsingle,1\nstack,10\n");
    write_file("empty.csv", "scene,boxes\n");
}

static void expect_filled(const char *template, const char *expected) {
    Error error = {0};
    FREED char *text;
    size_t size;
    write_tables();
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_ok(template_fill(template, temporary_folder, "values.csv", out, &error), error);
    fclose(out);
    assert_string_equal(text, expected);
}

TEST(values_are_filled_in) {
    expect_filled("no tag\n", "no tag\n");
    expect_filled("a {{runs}}, {{scene}} {{none}}\n", "a 12, stack –\n");
    expect_filled("{{share number}} {{share percent}} {{share score}} {{big number}} {{big score}}",
                  "0.125 12.5% 0.125000 123456 123456");
    expect_filled("{{runs/share number}} {{runs/5 number}} {{5/runs percent}}", "96 2.4 41.7%");
    expect_filled("{{long}} {{long text}} {{none text}}", "A text that is certainly longer than a name ... A text that "
                                                          "is certainly longer than a name may be, \\*\xc3\xa4\\* –");
    /* Not numbers; a division by 0. */
    expect_filled("{{none number}} {{scene percent}} {{runs/none number}} {{runs/0 number}}", "– – – –");
}

TEST(rows_are_repeated) {
    expect_filled("{{each runs.csv}}\n- {{network}} {{frames}}\n{{end}}\nend\n",
                  "- baseline 600\n- baseline 5\n- other –\nend\n");
    expect_filled("{{each empty.csv}}\n- {{scene}}\n{{end}}\nend\n", "end\n");
    expect_filled("[{{each scenes.csv}}{{scene}};{{end}}]", "[single;stack;]");
    /* Columns hide values outside. */
    expect_filled("{{each scenes.csv}}{{scene}} {{runs}} {{end}}{{scene}}", "single 12 stack 12 stack");
}

TEST(rows_are_filtered) {
    expect_filled("{{each runs.csv scene=stack}}{{network}} {{end}}", "baseline other ");
    expect_filled("{{each runs.csv scene=stack network=other}}{{network}} {{end}}", "other ");
    expect_filled("{{each runs.csv scene=sing|stack}}{{network}} {{end}}", "baseline other ");
    expect_filled("{{each runs.csv network=other|baseline}}{{frames}} {{end}}", "600 5 – ");
    expect_filled("{{each runs.csv frames=}}{{network}} {{end}}", "other ");
    /* Equal to the value outside: of the values file, of the outer row. */
    expect_filled("{{each runs.csv scene}}{{network}} {{end}}", "baseline other ");
    expect_filled("{{each scenes.csv}}{{scene}}:{{each runs.csv scene}} {{network}}{{end}}. {{end}}",
                  "single: baseline. stack: baseline other. ");
}

static void expect_refused(const char *template, const char *message) {
    Error error = {0};
    write_tables();
    FILE *out = fopen("/dev/null", "w");
    assert_non_null(out);
    assert_false(template_fill(template, temporary_folder, "values.csv", out, &error));
    fclose(out);
    assert_error(error, ERROR_INPUT, message);
}

TEST(wrong_tags_are_refused) {
    expect_refused("{{unknown}}", "no value has this name: 'unknown'");
    expect_refused("{{unknown number}}", "no value has this name: 'unknown'");
    expect_refused("{{runs/unknown number}}", "no value has this name: 'unknown'");
    expect_refused("{{runs roman}}", "unknown format: 'roman'");
    expect_refused("{{runs", "a tag without }} or too long");
    expect_refused("{{ }}", "an empty tag");
    expect_refused("{{each runs.csv}}", "a tag without FILE or {{end}}");
    expect_refused("{{each}} {{end}}", "a tag without FILE or {{end}}");
    expect_refused("{{each runs.csv}}{{each scenes.csv}}{{end}}", "a tag without FILE or {{end}}");
    expect_refused("{{each runs.csv colour=red}}{{end}}", "no value to filter by: 'colour'");
    expect_refused("{{each scenes.csv boxes}}{{end}}", "no value to filter by: 'boxes'");
    expect_refused("{{end}}", "no value has this name: 'end'");
    expect_refused("{{each missing.csv}}{{end}}", "missing.csv: error: cannot open");
    expect_refused("{{caption missing.txt}}", "missing.txt: error: cannot open");
}

RUN_TESTS(NULL, NULL)
