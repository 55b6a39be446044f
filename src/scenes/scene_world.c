/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Creates worlds from a scene, and computes the scene's hash. */
#include "base/base.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

#include <string.h>

BodyDef scene_bomb_body(const Scene *scene) {
    const SceneBomb *bomb = &scene->bomb;
    BodyDef body = {.size = bomb->size,
                    .mass = bomb->mass.value,
                    .friction = bomb->friction,
                    .position = {bomb->x.value, bomb->y},
                    .angle = bomb->rotation.value,
                    .velocity = bomb->velocity,
                    .angular_velocity = bomb->spin.value};
    if (bomb->velocity_from_position) body.velocity = vec2_scale(bomb->velocity_factor, body.position);
    return body;
}

bool scene_add_bomb(const Scene *scene, World *world, Error *error) {
    BodyDef body = scene_bomb_body(scene);
    int index = world_body_count(world);
    if (!world_add_body(world, &body, error)) return false;
    world_set_bomb(world, index);
    return true;
}

World *scene_world(const Scene *scene, Error *error) {
    const WorldDef def = {.gravity = scene->gravity,
                          .warm_starting = scene->warm_starting,
                          .position_correction = scene->position_correction};
    World *world = world_create(&def, error);
    bool ok = world != NULL;
    for (int i = 0; ok && i < scene->body_count; i++) ok = world_add_body(world, &scene->bodies[i], error);
    if (ok && scene->bomb.present && scene->bomb.frame == 0) ok = scene_add_bomb(scene, world, error);
    if (ok) return world;
    world_destroy(world);
    return NULL;
}

const char *scene_network(const Scene *scene, const char *method) {
    for (int i = 0; i < scene->network_count; i++)
        if (strcmp(scene->networks[i].method, method) == 0) return scene->networks[i].path;
    return NULL;
}

/* 32-bit words, little-endian on every machine, after the hash of the previous words. */
enum { RECORD_WORDS = 16 };

typedef struct Record {
    unsigned char bytes[4 * RECORD_WORDS];
    size_t size;
} Record;

static void put_word(Record *record, uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) record->bytes[record->size++] = (unsigned char)(word >> shift);
}

static void put_float(Record *record, float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(record, word);
}

static void put_vector(Record *record, Vec2 value) {
    put_float(record, value.x);
    put_float(record, value.y);
}

static Record begin_record(uint64_t hash) {
    Record record = {.size = 0};
    put_word(&record, (uint32_t)hash);
    put_word(&record, (uint32_t)(hash >> 32));
    return record;
}

static uint64_t hash_body(uint64_t hash, const BodyDef *body) {
    Record record = begin_record(hash);
    put_vector(&record, body->size);
    put_float(&record, body->fixed ? 0 : body->mass); /* no dynamic body has mass 0 */
    put_float(&record, body->friction);
    put_vector(&record, body->position);
    put_float(&record, body->angle);
    put_vector(&record, body->velocity);
    put_float(&record, body->angular_velocity);
    return hash_xxh3(record.bytes, record.size);
}

uint64_t scene_hash(const Scene *scene) {
    Record record = begin_record(0);
    put_vector(&record, scene->gravity);
    put_float(&record, scene->dt);
    put_word(&record, (uint32_t)scene->iterations);
    put_word(&record, scene->warm_starting);
    put_word(&record, scene->accumulate_impulses);
    put_word(&record, scene->position_correction);
    put_word(&record, (uint32_t)scene->body_count);
    put_word(&record, scene->bomb.present);
    put_word(&record, scene->bomb.present ? (uint32_t)scene->bomb.frame : 0);
    uint64_t hash = hash_xxh3(record.bytes, record.size);
    for (int i = 0; i < scene->body_count; i++) hash = hash_body(hash, &scene->bodies[i]);
    if (scene->last_body_until > 0) {
        record = begin_record(hash);
        put_word(&record, (uint32_t)scene->last_body_until);
        hash = hash_xxh3(record.bytes, record.size);
    }
    if (!scene->bomb.present) return hash;
    BodyDef bomb = scene_bomb_body(scene);
    return hash_body(hash, &bomb);
}
