/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base64.h"
#include "common/html_text.h"
#include "picture/caption.h"
#include "player/page.h"
#include "player/player_parts.h"

static void put_head(FILE *file, const Player *player) {
    char title[CAPTION_SIZE];
    caption_title(&player->picture, title);
    /* The policy prevents any request, whatever names the page contains. */
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
          file);
    html_put(file, title);
    for (int i = 0; i < player->picture.count; i++) {
        char name[CAPTION_SIZE], note[CAPTION_SIZE];
        caption_method(&player->picture, i, name, note);
        fputs(i == 0 ? ": " : ", ", file);
        html_put(file, name);
    }
    fprintf(file, "</title>\n<style>\n%s</style>\n</head>\n<body>\n", player_page_css);
}

/* `what`: of a run, or of a chunk of it. */
static void put_packed(FILE *file, const char *what, const void *data, size_t size) {
    fprintf(file, "<script type=\"text/plain\" id=\"%s\">", what);
    base64_put(file, data, size);
    fputs("</script>\n", file);
}

static void put_chunk(FILE *file, char kind, int run, int chunk, const Bytes *bytes) {
    char id[32];
    snprintf(id, sizeof id, "%c%d-%d", kind, run, chunk);
    put_packed(file, id, bytes->data, bytes->size);
}

static void put_run(FILE *file, const Player *player, int index) {
    const Trajectory *trajectory = player->picture.runs[index];
    const PlayerRun *run = &player->runs[index];
    const size_t bodies = (size_t)trajectory->bodies, frames = (size_t)run->frames;
    char id[32];
    snprintf(id, sizeof id, "size%d", index);
    put_packed(file, id, trajectory->size, bodies * sizeof *trajectory->size);
    snprintf(id, sizeof id, "fixed%d", index);
    put_packed(file, id, trajectory->fixed, bodies * sizeof *trajectory->fixed);
    snprintf(id, sizeof id, "hashes%d", index);
    put_packed(file, id, run->hashes, frames * sizeof *run->hashes);
    snprintf(id, sizeof id, "distances%d", index);
    put_packed(file, id, run->distances, frames * sizeof *run->distances);
    for (int k = 0; k < run->chunks; k++) put_chunk(file, 's', index, k, &run->states[k]);
    for (int k = 0; k < run->chunks && run->contacts != NULL; k++) put_chunk(file, 'c', index, k, &run->contacts[k]);
}

void player_put_page(FILE *file, const void *context) {
    const Player *player = context;
    put_head(file, player);
    fputs(player_body_html, file);
    fputs(player_help_html, file);
    for (int i = 0; i < player->picture.count; i++) put_run(file, player, i);
    fputs("<script type=\"application/json\" id=\"data\">", file);
    player_put_data(file, player);
    fputs("</script>\n", file);
    put_packed(file, "viewer", player->viewer.data, player->viewer.size);
    fprintf(file, "<script>\n%s</script>\n</body>\n</html>\n", player_begin_js);
}
