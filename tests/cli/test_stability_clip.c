/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clips of cells: which frames there are, and of which runs. The table's verdicts are made up. */
#include "testing.h"

#include "cli/runs.h"
#include "base/file.h"

#define ROW(method, height, verdict, frame) \
    "m," method ",,rate,Hz,%d,height,," height "," verdict "," frame ",1,0.5,m\n"
#define HEADER "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,frame,body,value,unit\n"

static const ClipMap maps[] = {{"m", SOURCE_DIR "/scenes/stability/time_step.yaml", "rate", "height"}};

static bool make_clip(const char *cell, int rate, Error *error) {
    char text[1024];
    snprintf(text, sizeof text,
             HEADER ROW("engine", "2", "falls", "4") ROW("nncg", "2", "non-finite", "3")
                 ROW("nncg", "3", "non-finite", "3") ROW("momentum", "2", "settles", "2")
                     ROW("scene-net", "2", "not applicable", ""),
             rate, rate, rate, rate, rate);
    assert_ok(file_write_soon(temporary_path("maps.csv"), text, strlen(text), error), *error);
    return stability_clip(&(ClipOptions){temporary_folder, cell, maps, 1, 160, 90}, error);
}

static bool there_is(const char *name) { return access(temporary_path(name), R_OK) == 0; }

/* 20 Hz: frames 0 to 4, and those of three seconds. */
TEST(a_clip_goes_on_for_three_seconds) {
    assert_ok(make_clip("m:engine:20,2", 20, &error), error);
    assert_true(there_is("clips/m-engine-20_2.mp4") && there_is("clips/m-engine-20_2/frame_000064.png"));
    assert_false(there_is("clips/m-engine-20_2/frame_000065.png"));
}

/* 480 Hz: every eighth frame, up to step 2 + 3 * 480. */
TEST(no_more_than_sixty_frames_a_second_are_drawn) {
    assert_ok(make_clip("m:momentum:480,2", 480, &error), error);
    assert_true(there_is("clips/m-momentum-480_2/frame_000180.png"));
    assert_false(there_is("clips/m-momentum-480_2/frame_000181.png"));
}

/* The run that leaves the finite numbers in step 3 ends with frame 2; one that holds goes on beside it. */
TEST(what_is_no_more_finite_ends_before) {
    assert_ok(make_clip("m:nncg:20,2", 20, &error), error);
    assert_true(there_is("clips/m-nncg-20_2/frame_000063.png"));
    assert_false(there_is("clips/m-nncg-20_2/frame_000064.png"));
    assert_ok(make_clip("m:nncg:20,3", 20, &error), error);
    assert_true(there_is("clips/m-nncg-20_3/frame_000002.png"));
    assert_false(there_is("clips/m-nncg-20_3/frame_000003.png"));
}

TEST(what_cannot_be_shown_is_refused) {
    static const struct {
        const char *cell, *message;
    } cases[] = {{"m:engine", "'m:engine' is not MAP:METHOD:X,Y"},
                 {"m:engine:30,2", "map m has no cell 30,2 of method engine"},
                 {"m:scene-net:20,2", "'m:scene-net:20,2' is not applicable"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_refused(make_clip(cases[i].cell, 20, &error), cases[i].message);
    }
    assert_refused(stability_clip(&(ClipOptions){temporary_folder, "m:engine:20,2", NULL, 0, 160, 90}, &error),
                   "map m has no scene");
}

RUN_TESTS(NULL, NULL)
