# SPDX-License-Identifier: GPL-3.0-or-later
# The parts of the player's page are built in, so that the binary needs no files.
twinbox_embed(twinbox_player player_page_parts.c player/page.h char player_ ${CMAKE_CURRENT_LIST_DIR}/page
              page.css body.html help.html begin.js codec.js world.js layout.js camera.js grid.js boxes.js marks.js captions.js
              legend.js picture.js state.js plot.js time.js pointer.js measure.js keys.js link.js actions.js summary.js
              main.js)
