/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a page needs to step runs itself: module, bundle, and the methods that it offers with their names and
   colours. */
#include "base/base.h"
#include "base/json.h"
#include "live/live.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "pictures/player_internal.h"

bool player_live_pack(Player *player, Error *error) {
    const PlayerLive *live = player->options->live;
    return bytes_deflate(&player->module, live->module.bytes, live->module.size, error) &&
           bytes_deflate(&player->bundle, live->bundle, live->bundle_size, error);
}

/* The colours of its runs in the order of pictures/colours.h: reader's panels follow the same rule. */
static void put_method(JsonWriter *json, const MethodDescription *method, const ColourChoices *choices) {
    RunColours family[COLOUR_SHADES];
    colours_family(method->name, choices, family);
    json_begin_object(json, NULL, JSON_LINES);
    json_put_text(json, "name", method->name);
    json_put_number(json, "ems", player_ems(FONT_SEMIBOLD, method->name));
    json_put_text(json, "note", method->caption);
    json_put_number(json, "note_ems", method->caption != NULL ? player_ems(FONT_REGULAR, method->caption) : 0);
    json_begin_array(json, "shades", JSON_LINES);
    for (int i = 0; i < COLOUR_SHADES; i++) player_put_colours(json, NULL, &family[i]);
    json_end(json);
    json_end(json);
}

void player_live_put(JsonWriter *json, const Player *player) {
    json_begin_object(json, "live", JSON_LINES);
    json_begin_array(json, "methods", JSON_LINES);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (live_has_method(kind->description)) put_method(json, kind->description, &player->options->colours);
    json_end(json);
    json_end(json);
}
