/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The look: its names, its check, its colours. */
#include "base/base.h"
#include "pictures/picture.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

const char *const look_compare_names[] = {"split", "overlay", "difference", NULL};
const char *const look_camera_names[] = {"fit", "bomb", "divergence", NULL};
const char *const look_theme_names[] = {"light", "dark", NULL};
const char *const look_labels_names[] = {"none", "number", "mass", "name", NULL};
#define NAME(BIT, name, ...) name,
const char *const look_show_names[] = {SHOW_MARKS(NAME) NULL};

#define MARK(BIT, name, help, needs, script) {name, needs, script},
const ShowMark show_marks[SHOW_COUNT] = {SHOW_MARKS(MARK)};

/* What was not recorded would look like what did not happen. */
static bool check_known(const RenderLook *look, const Trajectory *run, int number, Error *error) {
    if (look->labels == LOOK_MASSES && !trajectory_has_masses(run))
        return error_input(error, "render", "masses cannot be shown: run %d (%s) does not have them; simulate it again",
                           number, run->method);
    if (look->labels == LOOK_NAMES && run->name == NULL)
        return error_input(error, "render",
                           "names cannot be shown: no body of run %d (%s) has one; the scene's key 'name' gives it",
                           number, run->method);
    for (int i = 0; i < SHOW_COUNT; i++) {
        if ((look->show >> i & 1) == 0) continue;
        const ShowMark *mark = &show_marks[i];
        const char *lacks = strstr(mark->needs, "contacts") != NULL && run->no_contacts       ? "contacts"
                            : strstr(mark->needs, "velocities") != NULL && run->no_velocities ? "velocities"
                                                                                              : NULL;
        if (lacks != NULL)
            return error_input(error, "render", "'%s' cannot be shown: run %d (%s) has no %s", mark->name, number,
                               run->method, lacks);
    }
    return true;
}

bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error) {
    char difference[256];
    if (look->view.width != 0 && !camera_view_is_usable(&look->view))
        return error_input(error, "render", "the view %g x %g m at (%g, %g) cannot be drawn", look->view.width,
                           look->view.height, look->view.x, look->view.y);
    if (look->camera == LOOK_BOMB && runs[0]->bomb < 0)
        return error_input(error, "render", "the camera cannot follow the bomb: the first run has none");
    for (int i = 0; i < count; i++)
        if (!check_known(look, runs[i], i + 1, error)) return false;

    /* What compares bodies of several runs. */
    const char *what = look->compare != LOOK_SPLIT       ? look_compare_names[look->compare]
                       : look->camera == LOOK_DIVERGENCE ? look_camera_names[LOOK_DIVERGENCE]
                                                         : NULL;
    for (int i = 0; what == NULL && i < SHOW_COUNT; i++)
        if ((look->show >> i & 1) != 0 && strcmp(show_marks[i].needs, "others") == 0) what = show_marks[i].name;
    if (what == NULL) return true;
    if (count < 2) return error_input(error, "render", "'%s' compares runs, but there is only one", what);
    for (int i = 1; i < count; i++)
        if (trajectory_different_worlds(runs[0], runs[i], difference, sizeof difference))
            return error_input(error, "render", "'%s' compares run %d with the first, but their worlds differ (%s)",
                               what, i + 1, difference);
    return true;
}

static const Theme light = {
    .page = PAGE,
    .panel = PANEL,
    .frame = FRAME,
    .grid = GRID,
    .grid_strong = GRID_STRONG,
    .ink = INK,
    .ink_soft = INK_SOFT,
    .ground = GROUND,
    .ground_line = GROUND_LINE,
    .impulse = 0x10161F,
    .velocity = 0xA3005C,
    .slips = 0xE8590C,
    .event = 0x8A94A3,
    .ghost_is_band = false,
    .bomb = BOMB_COLORS,
    .ramp_near = 0,
    .ramp_far = 1,
};

static const Theme dark = {
    .page = 0x12161C,
    .panel = 0x1A2028,
    .frame = 0x465161,
    .grid = 0x222A34,
    .grid_strong = 0x313B48,
    .ink = 0xEDF1F6,
    .ink_soft = 0x9AA6B6,
    .ground = 0x343E4B,
    .ground_line = 0x93A0B1,
    .impulse = 0xF7F9FB,
    .velocity = 0xFF8AC4,
    .slips = 0xFF8A1F,
    .event = 0x77849A,
    .ghost_is_band = true,
    .bomb = {0xCC3620, 0x3D0D03, 0xFFF1EA},
    .ramp_near = 0.86,
    .ramp_far = 0,
};

const Theme *theme_get(LookTheme theme) { return theme == LOOK_DARK ? &dark : &light; }

uint32_t theme_mix(uint32_t from, uint32_t to, double share) {
    uint32_t mixed = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        const double a = from >> shift & 255, b = to >> shift & 255;
        mixed |= (uint32_t)rint(a + (b - a) * share) << shift;
    }
    return mixed;
}

/* Oklab: hue 104 to 295 degrees, chroma 0.135 or the most that sRGB can show, lightness fitted to CIE L*. */
const uint32_t theme_stops[THEME_STOPS] = {0xFEF483, 0xC6E57E, 0x8AD482, 0x46C18C, 0x02A995, 0x0B8F95,
                                           0x08778E, 0x005E89, 0x04438D, 0x272879, 0x2E085E};

uint32_t theme_ramp(const Theme *theme, double share) {
    enum { LAST = THEME_STOPS - 1 };
    double at = LAST * (theme->ramp_near + (theme->ramp_far - theme->ramp_near) * fmin(fmax(share, 0), 1));
    int below = at < LAST - 1 ? (int)at : LAST - 1;
    return theme_mix(theme_stops[below], theme_stops[below + 1], at - below);
}
