/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a step is for each island, as the method interior sees it: calm or struck, few bodies or many, and the residuals
   that it has to reach.

   An island is calm if none of its bodies move fast relative to each other where they touch, whatever the bias: boxes
   that overlap and are pushed apart are calm, too. There errors add up from step to step: boxes creep at the speed of
   the error, until a card slides out of a house of cards or a stack leans. So the tolerance is smaller than that of
   impacts, `near`. After an impact an island is restless for some frames: calm, but the first sweeps leave much. There
   errors have no time to add up, and `near` will do.

   No limit depends on units: masses count as ratios, speeds at impacts by the fastest motion at a contact, and at rest
   by gravity and the engine's slop. */
#pragma once
#include "methods/islands.h"
#include "methods/residual.h"
#include "methods/sweeps.h"

/* More: an iteration takes as long as 10 sweeps or more. Fewer than FEW: stacks, gates. */
enum { INTERIOR_FEW_BODIES = 32, INTERIOR_MANY_BODIES = 128 };

typedef struct InteriorLook {
    int bodies, loops; /* bodies: that move */
    float fastest;     /* (m/s)^2, relative to each other where they touch */
    float fall;        /* m/s, that gravity adds in a step */
    float pace;        /* m/s, the unit of speeds at rest */
    bool calm, many, slippery;
    bool uneven, heavy; /* bodies of unlike masses touch */
    bool restless;
    bool slender;       /* towers: errors below are larger above */
    float near, enough; /* m/s: residuals at which iterations stop, and that are taken */
    PairResidual left;  /* sum over its pairs, after the first sweeps */
} InteriorLook;

/* Before the step. looks: [islands->count]. near: of impacts, m/s. */
void interior_look(InteriorLook *looks, const Islands *islands, const ContactProblem *problem, float near);

/* Adds up what the first sweeps left in each island. `island`: as Islands has it, or NULL if there is a single one. */
void interior_look_at_residuals(InteriorLook *looks, const Sweeps *sweeps, const int32_t *island);

/* m/s, root mean square over so many contacts. */
double interior_look_residual(const InteriorLook *look, int contacts);

/* Whether that is little more than rounding errors. */
bool interior_look_is_still(const InteriorLook *look, int contacts);

/* Else: whether the island is restless, and so has the tolerance of impacts. */
void interior_look_again(InteriorLook *look, float near, int contacts);

/* Sweeps carry little between its bodies. */
bool interior_look_jams(const InteriorLook *look);

/* m/s: what attempts measure speeds by. */
double interior_look_speed(const InteriorLook *look);

/* m/s: how fast contacts of a calm island aim to close. An interior point leaves each contact a little open, and boxes
   that rest on each other would part. near: of impacts. */
double interior_look_closing(const InteriorLook *look, float near);
