/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports of small hand-written tables, with figures of a few pixels. */
#include "made.h"
#include "python.h"
#include "tables.h"

#include "paper/paper_report.h"

static const char *const tables[] = {"table1.csv",      "networks.csv",      "rates.csv",
                                     "closed_loop.csv", "laws.csv",          "transfer.csv",
                                     "study.csv",       "system_scores.csv", NULL};
static const char *const figures[] = {"loop",  "narrow-phase", "data", "scenes",   "loss", "factors",
                                      "rates", "closed-loop",  "laws", "transfer", NULL};

static const char *figure_name(const char *name, const char *ending) {
    static char path[64];
    snprintf(path, sizeof path, "figures/%s.%s", name, ending);
    return path;
}

/* A complete folder of a study. */
static void make_study(void) {
    Error error = {0};
    char path[512];
    size_t size;
    for (int i = 0; tables[i] != NULL; i++) {
        snprintf(path, sizeof path, "%s/tests/paper/report/%s", SOURCE_DIR, tables[i]);
        FREED char *text = text_of(path);
        write_text(tables[i], text);
    }
    Image *image = image_sized(5, 3);
    assert_ok(image_write_png(image, temporary_path("picture.png"), NULL, 0, &error), error);
    image_destroy(image);
    FREED char *picture = read_whole(temporary_path("picture.png"), &size);
    assert_ok(file_make_directory(temporary_path("figures"), &error), error);
    for (int i = 0; figures[i] != NULL; i++) {
        write_bytes(temporary_path(figure_name(figures[i], "png")), picture, size);
        write_text(figure_name(figures[i], "txt"), "Boxes at 5 µs <step> & *more*.\n");
    }
}

/* The report of the folder as it is. */
static char *write_again(const char *name) {
    Error error = {0};
    assert_ok(paper_report_write(folder(), &error), error);
    return text_of(temporary_path(name));
}

static char *write_and_read(const char *name) {
    make_study();
    return write_again(name);
}

static void expect_text(const char *text, const char *wanted) {
    if (strstr(text, wanted) == NULL) fail_msg("the report lacks \"%s\"", wanted);
}

static void expect_no_text(const char *text, const char *unwanted) {
    if (strstr(text, unwanted) != NULL) fail_msg("the report has \"%s\"", unwanted);
}

/* Expected numbers follow from the tables; comments name the rows. */
TEST(numbers_are_computed_from_the_tables) {
    FREED char *text = write_and_read("report.md");
    /* 0.004 is below the paper's rows 0 to 100; a ninth network with the target pair has 1289 parameters. */
    expect_text(text, "| pair | 0.004 | 4 of 6 | 8 | inputs-contact | 20.0% |");
    /* net fails with 85%, inputs-raw passes with 1.1 times the constant predictor's error. */
    expect_text(text, "13 of 15 networks pass this gate; 1 of these are no better than the constant predictor.");
    expect_text(text, "The baseline is right in 81.0% to 92.0% of cases in 2 scenes. In 1 of them");
    /* lm is better for the pair, though not for the impulse. */
    expect_text(text, "| inputs | 2 | 2 | contact | 20.0% | 25.0% | better than the baseline |");
    expect_text(text, "| scaling | 2 | 1 | linear | 23.0% | 25.0% | better than the baseline |");
    expect_text(text, "| optimizer | 2 | 2 | lm | 24.0% | 25.0% | better than the baseline |");
    expect_text(text, "| target | 3 | 2 | – | – | 25.0% | – |");
    /* 0.08, 0.008 at the iterations 0, 10; 0.0006 < 0.000728. */
    expect_text(text, "| pair | 5 | 2 | 4 | 3 | 1 |");
    expect_text(text, "| points | 1 | 0 | 0 | 0 | 0 |");
    /* With another scale, and with a target that is not the paper's. */
    expect_text(text, "| pair-lm | lm | 2000 | 0.200000 | 0.100000 | 1.000000 | 0.2 |  |");
    expect_text(text, "| points | adam | 2000 | 0.000500 | 0.000400 | 0.002000 | 0.25 |  |");
    expect_text(text, "| baseline | adam | 2000 | 0.001000 | 0.000900 | 0.004000 | 0.25 | 0.000728 |");
    expect_text(text, "| scaling | standard | pair | 10-10-2 | sigmoid, linear | 132 | 0.31 | 1 | 0.31 | 89.0% |");
}

TEST(runs_are_counted) {
    FREED char *text = write_and_read("report.md");
    expect_text(
        text, "2 of 5 runs stay within 0.1 m of the converged run for 600 frames (10 s). They leave it after 4 to 600 "
              "frames.");
    /* Solvers are no networks: none of these numbers counts their runs. Scenes without a run have no line. */
    expect_text(text,
                "stack: networks after 306 frames (median of 2; at most 600, contact-net), the engine with 10 sweeps "
                "after 40, with 100 after 60, `interior` after 110.");
    expect_text(text,
                "- pyramid: networks after 4 frames (median of 1; at most 4, baseline), the engine with 10 sweeps "
                "after –, with 100 after –, `interior` after –.");
    expect_no_text(text, "- pyramid\\_settled: networks");
    expect_text(text, "In 1 of 2 runs of networks the stack stands as it does in the converged run.");
    expect_text(text, "| baseline | 12.5 | 0.208 |\n| contact-net | 600 | 10 |");
    expect_text(text, "The largest momentum error of its runs is 4e-07 N s, that of the baseline 1.5 N s.");
    /* 0.3 / 0.4 alone is below 1; 150 / 50. */
    expect_text(text, "in 4 of 5 runs. The most expensive costs 3 times as much (pyramid).");
    expect_text(text, "| baseline | single | 93 | 0.5 | 0.35 | 6.7 | 0.3 | 0.4 | 0.75 |");
}

TEST(rates_are_beside_those_of_cheaper_predictors) {
    FREED char *text = write_and_read("report.md");
    expect_text(text, "| contact-net | stack | all | 70.0% | 35.0% | 72.0% | 70.0% | 90.0% | 100.0% |");
    /* No warm start was rated by this definition. */
    expect_text(text, "| baseline | stack | all | 20.0% | 21.0% |  | 40.0% | 60.0% | 70.0% |");
    /* Baseline in single, stack and stack at impact, contact-net in both, contact-small in single. Networks that vary a
       factor are not shown. */
    expect_text(text, "| absolute | 6 | 2 | 4 | 5 |");
    expect_no_text(text, "11.1%");
    /* Three of the single box, two of the stack. */
    expect_text(text, "Steps that the reference does not solve are left out: 5.");
}

TEST(medians_are_over_seeds) {
    FREED char *text = write_and_read("report.md");
    expect_text(text, "| none | 0 | 3 | 0.002 | 0.001 | 0.003 | 0.5 | 0.8 | 0.4 | 0.1 | 0.05 |");
    expect_text(text, "| engine | – | 1 | – | – | – | – | 0 | 0.01 | 0.02 | 0 |");
    /* momentum is violated less at a larger error, the cone more at a smaller one. */
    expect_text(text,
                "Of 2 cases with a single law in the loss, 1 violate that law less than the network without laws, "
                "and 1 have");
    /* 4, 3.8, 9: 4 from scratch; 2.9, 3, 3.1: 3 with transfer, as 2 launches give from scratch. */
    expect_text(text, "| 1 | 4 | 3 | 1 |\n| 2 | 3 | 2 | 1 |\n| 8 | 1.5 | 1.8 | – |");
    expect_text(text, "They lower the test error in 1 of 2 cases, and the violation of the law in question in 1.");
    expect_text(text, "In 1 of the 2 rows below the first, transfer needs fewer launches");
    expect_text(text,
                "from scratch is 1.5 m/s, below the constant predictor's; the lowest with transfer is 1.8 m/s, below");
}

TEST(aims_state_by_how_much_they_are_missed) {
    FREED char *text = write_and_read("report.md");
    expect_text(text, "| Test / constant, pair | at most 0.4 | inputs-contact | 0.2 | 1 | reached | – |");
    expect_text(text, "| Test / constant, net | at most 0.4 | net | 0.7 | 1 | missed | 0.3 |");
    expect_text(text, "| Test / constant, impulse | at most 0.1 | impulse | 0.5 | 1 | missed | 0.4 |");
    expect_text(text,
                "| Within 0.1 m/s, single | at least 95.0% | contact-net | 96.1% | 96.0% | reached, also at no cost | "
                "– |");
    expect_text(text, "| Within 0.1 m/s, stack | at least 75.0% | contact-net | 70.0% | 72.0% | missed | 5.0% |");
}

TEST(claims_are_judged) {
    FREED char *text = write_and_read("report.md");
    /* Inputs seen from the contact are neither the paper's relative ones nor raw. */
    expect_text(text, "0.25 with relative inputs, 1.1 with raw ones. The claim holds here.");
    /* The linear layer on min-max outputs is neither the one reading nor the other. */
    expect_text(text, "0.31 with them, 0.25 with sigmoid outputs on \\[0, 1\\]. The claim does not hold here.");
    expect_text(text,
                "0.3 with labels of the converged solution, 0.25 with the engine's. The claim does not hold here.");
    /* The wide network has one hidden layer. */
    expect_text(text, "0.22 with it, 0.1 without. The claim does not hold here.");
    /* No network was trained on random launches. */
    expect_no_text(text, "swept in even steps");
    expect_text(text, "In 5 of 10 rates, over all networks");
}

TEST(systems_are_beside_their_rivals) {
    FREED char *text = write_and_read("report.md");
    expect_text(text, "| engine | stack | 300, 41.5 of 300 | 4.2 | 0.31 | 0 | 0 | 0.0% | 4 (1) |");
    expect_text(text, "| sain | stack | 40, 52 of 300 | 3.8 | 0.2 | 150 | 0.0031 | 12.5% | 12 (3) |");
    expect_text(text, "| gns | pyramid | 12, 11 of 300 | 66 | 0.9 | 12346 | 3.5 | – | 1500 (100) |");
}

TEST(quick_studies_are_marked) {
    char *text = write_and_read("report.md");
    expect_no_text(text, "quick run");
    free(text);
    write_text("study.csv", "key,value\nquick,on\n");
    text = write_again("report.md");
    expect_text(text, "**This is a quick run**");
    free(text);
}

TEST(texts_stay_texts) {
    FREED char *markdown = write_and_read("report.md");
    expect_no_text(markdown, "<script");
    expect_text(markdown, "&lt;script&gt;alert(1)&lt;/script&gt; of a name that is ...");
    expect_text(markdown, "| \\*a\\* \\_b\\_ c_d \\[e\\](f) \\| \\`g\\` &amp; \\$h\\$ \\~i\\~ \\\\ |");
    expect_text(markdown, "**Figure 1.** Boxes at 5 µs &lt;step&gt; &amp; \\*more\\*.");
    expect_text(markdown, "](figures/narrow-phase.png)");
}

/* The parser of Python's library knows no closing tag that may be left out; the page leaves out none. */
TEST(the_page_is_whole_and_needs_nothing) {
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
               "pages = [t for t in p.targets if t.startswith('figures/')]\n"
               "assert pages == [], pages\n"
               "assert [t for t in p.targets if not t.startswith('#') and t not in pages] == [doi], p.targets\n"
               "assert set(re.findall(r'[a-z]+://[^\"<]*', page)) == {doi}\n"
               "assert 'url(' not in page and '@import' not in page\n"
               "inner = [t[1:] for t in p.targets if t.startswith('#')]\n"
               "assert len(inner) > 10 and set(inner) <= set(p.ids) and len(set(p.ids)) == len(p.ids)\n"
               "assert '<script>alert(1)</script> of a name' in p.text and 'Figure 10.' in p.text\n"
               "assert '*a* _b_ c_d [e](f) | `g` & $h$ ~i~ \\\\' in p.text\n"
               "rows = [re.findall(r'<t[hd]', row) for row in re.findall(r'<tr>.*?</tr>', page, re.S)]\n"
               "assert len(rows) > 40\n",
               temporary_path("report.html"));
}

static void expect_refused(const char *message) {
    Error error = {0};
    remove(temporary_path("report.md"));
    assert_refused(paper_report_write(folder(), &error), message);
    assert_int_equal(access(temporary_path("report.md"), F_OK), -1);
}

static void refuse_table(const char *name, const char *text, const char *message) {
    make_study();
    write_text(name, text);
    expect_refused(message);
}

TEST(damaged_tables_are_refused_with_their_place) {
    refuse_table("transfer.csv", "start,seed,launches,error,constant\nscratch,1,-1,2,3\n",
                 "transfer.csv:2:11: error: launches: '-1' is less than 1");
    refuse_table("transfer.csv", "start,seed,launches,error,constant\n",
                 "transfer.csv:2:1: error: the table has no rows");
    refuse_table("study.csv", "quick,seed\noff,1\n", "report template: error: no value to filter by: 'key'");
    make_study();
    remove(temporary_path("laws.csv"));
    expect_refused("laws.csv: error: cannot open");
}

TEST(figures_that_miss_or_are_damaged_are_refused) {
    make_study();
    remove(temporary_path("figures/scenes.png"));
    expect_refused("figures/scenes.png: error: cannot open");
    make_study();
    remove(temporary_path("figures/laws.txt"));
    expect_refused("figures/laws.txt: error: cannot open");
    make_study();
    write_text("figures/rates.png", "\x89PNG and no more");
    expect_refused("figures/rates.png: error: not a PNG file, or damaged");
    make_study();
    write_text("figures/loop.txt", "two\nlines\n");
    expect_refused("figures/loop.txt: error: byte 4: a caption must be one line of UTF-8 text");
    write_text("figures/loop.txt", "a\xff");
    expect_refused("figures/loop.txt: error: byte 2: a caption must be one line of UTF-8 text");
    write_text("figures/loop.txt", "\xc3");
    expect_refused("figures/loop.txt: error: byte 1: a caption must be one line of UTF-8 text");
    write_text("figures/loop.txt", "\n");
    expect_refused("figures/loop.txt: error: the caption is empty");
}

TEST(few_rows_and_empty_fields_are_a_report_too) {
    make_study();
    write_text("networks.csv",
               "network,factor,value,inputs,data,labels,target,layers,hidden,output,scale,optimizer,loss,"
               "iterations,parameters,test,train,constant,ratio,accuracy\n"
               "x,y,,,,,pair,,,,,,,,1,,,,,\n");
    write_text("rates.csv", "network,scene,definition,phase,rate,constant,engine1,engine4,engine10\n"
                            "x,stack,range,all,,,,,\n");
    write_text("transfer.csv", "start,seed,launches,error,constant\ntransfer,1,1,2,3\n");
    write_text("laws.csv", "laws,weight,seed,test,constant,momentum,energy,approach,cone\nall,,,,,,,,\n");
    FREED char *text = write_again("report.md");
    expect_text(text, "| Test / constant, pair | at most 0.4 | – | – | 1 | not measured | – |");
    expect_text(text, "| y | – | pair | – | –, – | 1 | – | – | – | – |");
    expect_text(text, "In 0 of the 0 rows below the first, transfer needs fewer launches");
    expect_text(text, "| all | – | 1 | – | – | – | – | – | – | – | – |");
    expect_no_text(text, "nan");
    expect_no_text(text, "inf ");
}

RUN_TESTS(NULL, NULL)
