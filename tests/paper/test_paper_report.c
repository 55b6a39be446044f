/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables made by hand, and figures of a few pixels. */
#include "python.h"

#include "common/file.h"
#include "image/image.h"
#include "paper/report/paper_report.h"

static const char *const tables[] = {"table1.csv", "networks.csv", "rates.csv", "closed_loop.csv",
                                     "laws.csv",   "transfer.csv", "study.csv", NULL};
static const char *const figures[] = {"loop",  "narrow-phase", "data", "scenes",   "loss", "factors",
                                      "rates", "closed-loop",  "laws", "transfer", NULL};

static const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

/* Without waiting for the disk. */
static void put_bytes(const char *name, const void *data, size_t size) {
    FILE *file = fopen(temporary_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

static void put_text(const char *name, const char *text) { put_bytes(name, text, strlen(text)); }

static const char *figure_name(const char *name, const char *ending) {
    static char path[64];
    snprintf(path, sizeof path, "figures/%s.%s", name, ending);
    return path;
}

static char *draw_picture(size_t *size) {
    Error error = {0};
    Image *image = image_create(5, 3, &error);
    assert_ok(image != NULL, error);
    const char *path = temporary_path("picture.png");
    if (access(path, F_OK) != 0) assert_ok(image_write_png(image, path, NULL, 0, &error), error);
    image_destroy(image);
    char *data = file_read(path, 1 << 20, size, &error);
    assert_ok(data != NULL, error);
    return data;
}

/* The study's folder, whole. */
static void make_study(void) {
    Error error = {0};
    for (int i = 0; tables[i] != NULL; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/tests/paper/report/%s", SOURCE_DIR, tables[i]);
        size_t size;
        char *text = file_read(path, 1 << 20, &size, &error);
        assert_ok(text != NULL, error);
        put_text(tables[i], text);
        free(text);
    }
    folder();
    assert_ok(file_make_directory(temporary_path("figures"), &error), error);
    size_t size;
    char *picture = draw_picture(&size);
    for (int i = 0; figures[i] != NULL; i++) {
        put_bytes(figure_name(figures[i], "png"), picture, size);
        put_text(figure_name(figures[i], "txt"), "Boxes at 5 µs <step> & *more*.\n");
    }
    free(picture);
}

static char *read_report(const char *name, size_t *size) {
    Error error = {0};
    char *text = file_read(temporary_path(name), 1 << 24, size, &error);
    assert_ok(text != NULL, error);
    return text;
}

static char *write_and_read(const char *name) {
    Error error = {0};
    make_study();
    assert_ok(paper_report_write(folder(), &error), error);
    size_t size;
    return read_report(name, &size);
}

static void expect_text(const char *text, const char *wanted) {
    if (strstr(text, wanted) == NULL) fail_msg("the report lacks \"%s\"", wanted);
}

static void expect_no_text(const char *text, const char *unwanted) {
    if (strstr(text, unwanted) != NULL) fail_msg("the report has \"%s\"", unwanted);
}

/* All by hand from the tables. */
static void figures_are_computed_from_the_tables(void **state) {
    (void)state;
    char *text = write_and_read("report.md");
    /* 0.004 is below the paper's rows 0 to 100; a ninth network of the target pair has 1289 parameters. */
    expect_text(text, "a test error of 0.004 on the paper's scale. 4 of the 6 rows");
    expect_text(text, "at most 500 parameters for the target pair: 8. The best, inputs-contact, has 20.0% of");
    /* net fails with 85%, inputs-raw passes with 1.1 times the constant's error. */
    expect_text(text, "12 of 14 networks pass that gate");
    expect_text(text, "1 of those that pass are no better than the constant");
    expect_text(text, "right within 5% of the output's range, the baseline is right in 81.0% to 92.0% of cases over 2 "
                      "scenes; in 1 of them");
    /* lm is better for the pair, though not for the impulse. */
    expect_text(text,
                "Least for the target pair: lm, 24.0% of the constant's error; better than the baseline with 25.0%.");
    /* 0.08, 0.008 at the iterations 0, 10; 0.0006 < 0.000728. */
    expect_text(text,
                "Of these 5 rows, 2 are no better than the constant.\n\n3 of the 4 rows with a counterpart are below "
                "the paper's score; 1 of them");
    /* Of another scale, and of a target that is not the paper's. */
    expect_text(text, "| pair-lm | lm | 2000 | 0.200000 | 0.100000 | 1.000000 | 0.2 | – |");
    expect_text(text, "| points | adam | 2000 | 0.000500 | 0.000400 | 0.002000 | 0.25 | – |");
    expect_text(text, "| baseline | adam | 2000 | 0.001000 | 0.000900 | 0.004000 | 0.25 | 0.000728 |");
    expect_text(text, "2 of 5 runs stay within 0.1 m of the engine's for 600 frames (10 s); the first leaves it "
                      "after frame 4.");
    expect_text(
        text,
        "With baseline the stack does not stand as the engine's does: it is 0.1 m apart after 12.5 frames (0.21 s).");
    expect_text(text, "The largest momentum error of its runs is 4e-07 N s, of the baseline's 1.5 N s.");
    expect_text(text, "With contact-net the stack does as the engine's for all 600 frames.");
    /* 0.3 / 0.4 alone is below 1; 150 / 50. */
    expect_text(text, "in 4 of 5 runs; the dearest costs 3 times as much (pyramid).");
    free(text);
}

static void rates_stand_beside_what_costs_nothing(void **state) {
    (void)state;
    char *text = write_and_read("report.md");
    expect_text(text, "| contact-net | stack | all | 70.0% | 35.0% | 72.0% | 70.0% | 90.0% | 100.0% |");
    /* Baseline in single, stack and stack at impact, contact-net in both; what varies a factor is not shown. */
    expect_text(text,
                "Of 5 rows, the constant is right at least as often in 1, the warm start in 3, one sweep of the engine "
                "in 4.");
    expect_no_text(text, "11.1%");
    free(text);
}

static void medians_are_over_seeds(void **state) {
    (void)state;
    char *text = write_and_read("report.md");
    expect_text(text, "| none | 0 | 3 | 0.002 | 0.001 to 0.003 | 0.5 | 0.8 | 0.4 | 0.1 | 0.05 |");
    expect_text(text, "| engine | – | 1 | – | – | – | 0 | 0.01 | 0.02 | 0 |");
    /* momentum is obeyed better at a larger error, the cone worse at a smaller one. */
    expect_text(text,
                "Of 2 cases with a single law in the loss, 1 break that law less than the network without, and 1 have");
    /* 4, 3.8, 9: 4 from scratch; 2.9, 3, 3.1: 3 after transfer, which is also what 2 launches give from scratch. */
    expect_text(text, "| 1 | 4 | 3 | 1 |\n| 2 | 3 | 2 | 1 |\n| 8 | 1.5 | 1.8 | not reached |");
    expect_text(text, "They lower the test error in 1 of 2 cases, and the violations of the law in question in 1.");
    expect_text(text, "In 1 of the 2 rows below the first transfer needs fewer launches");
    free(text);
}

static void aims_tell_by_how_much_they_are_missed(void **state) {
    (void)state;
    char *text = write_and_read("report.md");
    expect_text(text, "| Test / constant, target pair | at most 0.4 | inputs-contact | 0.2 | 1 | reached |");
    expect_text(text, "| Test / constant, target net | at most 0.4 | net | 0.7 | 1 | missed by 0.3 |");
    expect_text(text, "| Test / constant, target impulse | at most 0.1 | impulse | 0.5 | 1 | missed by 0.4 |");
    expect_text(text, "| contact-net within 0.1 m/s, single | at least 95% | contact-net | 96.1% | 96.0% | reached, "
                      "also for nothing |");
    expect_text(text, "| at least 75% | contact-net | 70.0% | 72.0% | missed by 5.0 points |");
    /* Inputs seen from the contact are neither the paper's relative ones nor raw. */
    expect_text(text, "Least error over the constant's: 0.25 with it, 1.1 without. Holds here.");
    /* The linear layer on min-max outputs is neither the one reading nor the other. */
    expect_text(text, "standardised, raise the accuracy (3.1). Least error over the constant's: 0.31 with it, 0.25 "
                      "without. Does not hold here.");
    expect_text(text,
                "A more accurate source of data pays (2). Least error over the constant's: 0.3 with it, 0.25 without. "
                "Does not hold here.");
    free(text);
}

static void texts_stay_texts(void **state) {
    (void)state;
    char *markdown = write_and_read("report.md");
    expect_no_text(markdown, "<script");
    expect_no_text(markdown, "<i>");
    expect_text(markdown, "&lt;script&gt;alert(1)&lt;/script&gt; of a name that is ...");
    expect_text(markdown, "**Figure 1.** Boxes at 5 µs &lt;step&gt; &amp; \\*more\\*.");
    expect_text(markdown, "](figures/narrow-phase.png)");
    free(markdown);
}

/* The parser of Python's library knows no closing tag that may be left out; the page leaves out none. */
static void the_page_is_whole_and_needs_nothing(void **state) {
    (void)state;
    free(write_and_read("report.html"));
    run_python("import base64, html.parser, re, sys\n"
               "page = open(sys.argv[1], encoding='utf-8').read()\n"
               "class Parser(html.parser.HTMLParser):\n"
               "    stack, seen, ids, targets, images, text = [], [], [], [], [], ''\n"
               "    def handle_starttag(self, tag, attributes):\n"
               "        self.seen.append(tag)\n"
               "        a = dict(attributes)\n"
               "        if 'id' in a: self.ids.append(a['id'])\n"
               "        if tag == 'a': self.targets.append(a['href'])\n"
               "        if tag == 'img': self.images.append(a)\n"
               "        if tag not in ('meta', 'img'): self.stack.append(tag)\n"
               "    def handle_endtag(self, tag):\n"
               "        assert self.stack.pop() == tag, (tag, self.getpos())\n"
               "    def handle_data(self, data): self.text += data\n"
               "p = Parser(convert_charrefs=True)\n"
               "p.feed(page)\n"
               "p.close()\n"
               "assert not p.stack, p.stack\n"
               "assert not {'script', 'i', 'link', 'iframe'} & set(p.seen), set(p.seen)\n"
               "assert p.seen.count('img') == p.seen.count('figcaption') == 10\n"
               "for image in p.images:\n"
               "    head, data = image['src'].split(',')\n"
               "    assert head == 'data:image/png;base64' and image['alt'], image\n"
               "    assert base64.b64decode(data, validate=True)[:8] == b'\\x89PNG\\r\\n\\x1a\\n'\n"
               "    assert (image['width'], image['height']) == ('5', '3')\n"
               "assert base64.b64decode(p.images[0]['src'].split(',')[1]) == open(sys.argv[1].replace('report.html',\n"
               "    'figures/loop.png'), 'rb').read()\n"
               "doi = 'https://doi.org/10.18662/brain/14.2/445'\n"
               "assert [t for t in p.targets if not t.startswith('#')] == [doi], p.targets\n"
               "assert set(re.findall(r'[a-z]+://[^\"<]*', page)) == {doi}\n"
               "assert 'url(' not in page and '@import' not in page\n"
               "inner = [t[1:] for t in p.targets if t.startswith('#')]\n"
               "assert len(inner) > 10 and set(inner) <= set(p.ids) and len(set(p.ids)) == len(p.ids)\n"
               "assert '<script>alert(1)</script> of a name' in p.text and 'Figure 10.' in p.text\n"
               "rows = [re.findall(r'<t[hd]', row) for row in re.findall(r'<tr>.*?</tr>', page)]\n"
               "assert len(rows) > 40\n",
               temporary_path("report.html"));
}

static void the_same_folder_gives_the_same_bytes(void **state) {
    (void)state;
    static const char *const names[] = {"report.md", "report.html"};
    for (int i = 0; i < 2; i++) {
        char *first = write_and_read(names[i]), *second = write_and_read(names[i]);
        assert_string_equal(first, second);
        free(first);
        free(second);
    }
}

static void expect_refused(const char *message) {
    Error error = {0};
    remove(temporary_path("report.md"));
    assert_false(paper_report_write(folder(), &error));
    assert_error(error, ERROR_INPUT, message);
    assert_int_equal(access(temporary_path("report.md"), F_OK), -1);
}

static void refuse_table(const char *name, const char *text, const char *message) {
    make_study();
    put_text(name, text);
    expect_refused(message);
}

static void damaged_tables_are_refused_with_their_place(void **state) {
    (void)state;
    refuse_table("transfer.csv", "start,seed,launches,error\nscratch,1,1,2\n",
                 "transfer.csv:1:1: error: column constant is missing");
    refuse_table("transfer.csv", "start,seed,launches,error,constant,seed\nscratch,1,1,2,3,1\n",
                 "transfer.csv:1:36: error: column seed is there twice");
    refuse_table("transfer.csv", "start,seed,launches,error,constant\nscratch,1,1,nan,3\n",
                 "transfer.csv:2:13: error: error must be a number (got nan)");
    refuse_table("transfer.csv", "start,seed,launches,error,constant\nscratch,1,1,,3\n",
                 "transfer.csv:2:13: error: error must be a number (got )");
    refuse_table("transfer.csv", "start,seed,launches,error,constant\nscratch,1,-1,2,3\n",
                 "transfer.csv:2:11: error: launches cannot be -1");
    refuse_table("transfer.csv", "start,seed,launches,error,constant\n",
                 "transfer.csv:2:1: error: the table has no rows");
    refuse_table(
        "rates.csv",
        "network,scene,definition,phase,rate,constant,engine1,engine4,engine10\na,stack,range,all,1.5,1,1,1,1\n",
        "rates.csv:2:1: error: a rate above 1");
    make_study();
    remove(temporary_path("laws.csv"));
    expect_refused("laws.csv: error: cannot open");
}

static void a_million_rows_are_refused(void **state) {
    (void)state;
    make_study();
    FILE *file = fopen(temporary_path("study.csv"), "w");
    assert_non_null(file);
    fputs("k,v\n", file);
    for (int i = 0; i < 500000; i++) fputs("a,\n", file);
    fclose(file);
    expect_refused("study.csv:5002:1: error: the table has more than 5000 rows");
}

static void figures_that_miss_or_are_damaged_are_refused(void **state) {
    (void)state;
    make_study();
    remove(temporary_path("figures/scenes.png"));
    expect_refused("figures/scenes.png: error: cannot open");
    make_study();
    remove(temporary_path("figures/laws.txt"));
    expect_refused("figures/laws.txt: error: cannot open");
    make_study();
    put_text("figures/rates.png", "\x89PNG and no more");
    expect_refused("figures/rates.png: error: no PNG file, or a damaged one");
    make_study();
    put_text("figures/loop.txt", "two\nlines\n");
    expect_refused("figures/loop.txt: error: byte 4 is no text");
    put_text("figures/loop.txt", "a\xff");
    expect_refused("figures/loop.txt: error: byte 2 is no text");
    put_text("figures/loop.txt", "\xc3");
    expect_refused("figures/loop.txt: error: byte 1 is no text");
    put_text("figures/loop.txt", "\n");
    expect_refused("figures/loop.txt: error: an empty caption");
}

/* What a table lacks is left out or told as not measured; the words of the files are not ours to expect. */
static void other_words_and_few_rows_are_a_report_too(void **state) {
    (void)state;
    make_study();
    put_text("networks.csv",
             "network,factor,value,inputs,data,labels,target,layers,hidden,output,scale,parameters,test,constant,"
             "ratio,accuracy\nx,y,,,,,,,,,,1,,,,\n");
    put_text("rates.csv", "network,scene,definition,phase,rate,constant,engine1,engine4,engine10\nx,y,z,w,,,,,\n");
    put_text("transfer.csv", "start,seed,launches,error,constant\nother,,1,2,3\n");
    put_text("laws.csv", "laws,weight,seed,test,constant,momentum,energy,approach,cone\nall,,,,,,,,\n");
    Error error = {0};
    assert_ok(paper_report_write(folder(), &error), error);
    size_t size;
    char *text = read_report("report.md", &size);
    expect_text(text, "| Test / constant, target pair | at most 0.4 | none | – | 1 | not measured |");
    expect_no_text(text, "nan");
    expect_no_text(text, "inf ");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_computed_from_the_tables),
        cmocka_unit_test(rates_stand_beside_what_costs_nothing),
        cmocka_unit_test(medians_are_over_seeds),
        cmocka_unit_test(aims_tell_by_how_much_they_are_missed),
        cmocka_unit_test(texts_stay_texts),
        cmocka_unit_test(the_page_is_whole_and_needs_nothing),
        cmocka_unit_test(the_same_folder_gives_the_same_bytes),
        cmocka_unit_test(damaged_tables_are_refused_with_their_place),
        cmocka_unit_test(a_million_rows_are_refused),
        cmocka_unit_test(figures_that_miss_or_are_damaged_are_refused),
        cmocka_unit_test(other_words_and_few_rows_are_a_report_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
