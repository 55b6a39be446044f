/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_overlaps.h"

#include "scene/scene_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool field_overlaps(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    const bool allowed = *(bool *)member = strcmp(text, "allowed") == 0;
    return allowed || strcmp(text, "refused") == 0 ||
           yaml_error(tree, node, error, "%s must be refused or allowed (got %s)", field->key,
                      yaml_show(tree, node).text);
}

/* The node of body `index`: its entry in the list, or the bomb. */
static int node_of(const YamlTree *tree, int bodies, int bomb, const Scene *scene, int index) {
    return index < scene->body_count ? bodies_entry(tree, bodies, index) : bomb;
}

static bool refuse(const YamlTree *tree, int bodies, int bomb, const Scene *scene, const BodyPair *pair,
                   const Box *boxes, Error *error) {
    const int node = node_of(tree, bodies, bomb, scene, pair->b);
    const int other = bodies_entry(tree, bodies, pair->a);
    char what[32] = "the bomb";
    if (pair->b < scene->body_count) snprintf(what, sizeof what, "body %d", pair->b);
    return yaml_error(tree, node, error,
                      "%s starts %.3g m inside body %d (line %d), more than the slop of %g m; move one of them, or "
                      "write 'overlaps: allowed'",
                      what, overlap_depth(&boxes[pair->a], &boxes[pair->b]), pair->a, tree->nodes[other].place.line + 1,
                      (double)CONTACT_SLOP);
}

bool overlaps_check(const YamlTree *tree, int bodies, int bomb, const Scene *scene, Error *error) {
    const bool with_bomb = scene->bomb.present && scene->bomb.frame == 0;
    const int count = scene->body_count + with_bomb;
    Box *boxes = malloc((size_t)count * sizeof *boxes);
    bool *fixed = malloc((size_t)count * sizeof *fixed);
    BodyPair pair = {-1, -1};
    for (int i = 0; boxes != NULL && fixed != NULL && i < count; i++) {
        const BodyDef *body = i < scene->body_count ? &scene->bodies[i] : &scene->bomb.body;
        boxes[i] = box_make(body->position, body->size, body->angle);
        fixed[i] = body->fixed;
    }
    bool ok = boxes != NULL && fixed != NULL && overlap_find(boxes, fixed, count, SCENE_OVERLAP, &pair);
    if (!ok)
        error_memory(error, tree->source.path);
    else if (pair.a >= 0)
        ok = refuse(tree, bodies, bomb, scene, &pair, boxes, error);
    free(boxes);
    free(fixed);
    return ok;
}
