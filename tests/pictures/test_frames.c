/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which frames of a run a page stores. */
#include "testing.h"

#include "pictures/player_internal.h"

enum { FRAMES = 40 };

/* The stored frames are all frames from the first to the last in steps of `every`, counted one by one. */
TEST(stored_frames_are_those_in_steps) {
    for (int every = 1; every < 12; every++)
        for (int first = 0; first < FRAMES; first++)
            for (int last = first; last < FRAMES; last++) {
                const PlayerFrames frames = {first, last, every};
                int count = 0;
                for (int frame = first; frame <= last; frame += every)
                    assert_int_equal(player_frame(&frames, count++), frame);
                assert_int_equal(player_frame_count(&frames, FRAMES), count);
            }
}

/* A shorter run has fewer; one that ends before the first stored frame has none. */
TEST(a_shorter_run_has_fewer) {
    const PlayerFrames frames = {10, 30, 5};
    assert_int_equal(player_frame_count(&frames, 31), 5);
    assert_int_equal(player_frame_count(&frames, 30), 4);
    assert_int_equal(player_frame_count(&frames, 11), 1);
    assert_int_equal(player_frame_count(&frames, 10), 0);
}

/* An event is shown in the first stored frame that has it. */
TEST(an_event_is_in_the_first_frame_that_has_it) {
    for (int every = 1; every < 12; every++) {
        const PlayerFrames frames = {7, 33, every};
        for (int frame = 0; frame < FRAMES; frame++) {
            int expected = -1;
            for (int i = player_frame_count(&frames, FRAMES) - 1; i >= 0; i--)
                if (player_frame(&frames, i) >= frame) expected = i;
            assert_int_equal(player_stored(&frames, frame), expected);
        }
        assert_int_equal(player_stored(&frames, -1), -1);
    }
}

RUN_TESTS(NULL, NULL)
