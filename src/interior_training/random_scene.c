/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/random_scene.h"

#include "common/split_mix.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

/* The family's shape, for the bomb's aim. */
typedef struct Shape {
    float half_width, height; /* m */
    float mass;               /* kg, of a typical box */
} Shape;

typedef struct Maker {
    RandomScene *random;
    uint64_t state;
    float friction;
} Maker;

/* Uniform in low .. high. */
static float draw(Maker *maker, double low, double high) {
    return (float)(low + (high - low) * (double)(split_mix(&maker->state) >> 11) * 0x1p-53);
}

static float draw_log(Maker *maker, double low, double high) {
    return (float)exp((double)draw(maker, log(low), log(high)));
}

/* low .. high, both possible. */
static int draw_int(Maker *maker, int low, int high) {
    return low + (int)(split_mix(&maker->state) % (uint64_t)(high - low + 1));
}

static BodyDef *add(Maker *maker, Vec2 size, float mass, Vec2 position) {
    Scene *scene = &maker->random->scene;
    assert(scene->body_count < RANDOM_SCENE_BODIES);
    BodyDef *body = &maker->random->bodies[scene->body_count++];
    *body = (BodyDef){.size = size, .mass = mass, .friction = maker->friction, .position = position};
    return body;
}

/* A column of boxes from the ground up. Returns its height. */
static float add_column(Maker *maker, float x, int boxes, float mass, float gap) {
    for (int i = 0; i < boxes; i++) add(maker, vec2(1, 1), mass, vec2(x, 0.5f + (float)i * (1 + gap)));
    return (float)boxes * (1 + gap);
}

static Shape make_stack(Maker *maker) {
    const float mass = draw_log(maker, 1, 10);
    const int boxes = draw_int(maker, 4, 25);
    const float height = add_column(maker, 0, boxes, mass, draw_int(maker, 0, 2) == 0 ? 0.05f : 0);
    return (Shape){0.5f, height, mass};
}

static Shape make_tower(Maker *maker) {
    float height = 0;
    for (int i = draw_int(maker, 4, 20); i > 0; i--) {
        const Vec2 size = vec2(draw(maker, 0.8, 2), draw(maker, 0.5, 1.2));
        BodyDef *body =
            add(maker, size, draw_log(maker, 1, 30), vec2(draw(maker, -0.1, 0.1), height + size.y * 0.5f + 0.005f));
        body->friction = draw(maker, 0.1, 0.9);
        height += size.y;
    }
    return (Shape){0.6f, height, 6};
}

static Shape make_pyramid(Maker *maker) {
    const float mass = draw_log(maker, 1, 10);
    const int rows = draw_int(maker, 4, 8);
    for (int row = 0; row < rows; row++)
        for (int i = 0; i < rows - row; i++)
            add(maker, vec2(1, 1), mass,
                vec2(1.125f * ((float)i - 0.5f * (float)(rows - 1 - row)), 0.5f + 1.02f * (float)row));
    return (Shape){0.56f * (float)rows, (float)rows, mass};
}

static Shape make_wall(Maker *maker) {
    const float mass = draw_log(maker, 1, 10);
    const int rows = draw_int(maker, 4, 6), columns = draw_int(maker, 3, 6);
    for (int row = 0; row < rows; row++)
        for (int i = 0; i < columns; i++)
            add(maker, vec2(1, 1), mass,
                vec2(((float)i - 0.5f * (float)columns) * 1.01f + (float)(row % 2) * 0.505f, 0.505f + (float)row));
    return (Shape){0.5f * (float)columns, (float)rows, mass};
}

static void add_side(Maker *maker, float x) { add(maker, vec2(1, 40), 1, vec2(x, 20))->fixed = true; }

static Shape make_pile(Maker *maker) {
    const float mass = draw_log(maker, 1, 10);
    const int boxes = draw_int(maker, 12, 38);
    add_side(maker, -4.5f);
    add_side(maker, 4.5f);
    for (int i = 0; i < boxes; i++) {
        const Vec2 size = vec2(draw(maker, 0.6, 1.6), draw(maker, 0.6, 1.6));
        const Vec2 at = vec2(draw(maker, -3, 3), 1.5f + (float)i * 0.9f);
        add(maker, size, mass * size.x * size.y, at)->angle = draw(maker, 0, 3.14);
    }
    return (Shape){3, 1 + (float)boxes * 0.14f, mass};
}

static Shape make_gate(Maker *maker) {
    const float mass = draw_log(maker, 1, 10), apart = draw(maker, 1.5, 3);
    const int boxes = draw_int(maker, 3, 12), beams = draw_int(maker, 1, 2);
    add_column(maker, -apart, boxes, mass, 0);
    float height = add_column(maker, apart, boxes, mass, 0);
    for (int i = 0; i < beams; i++, height += 0.6f)
        add(maker, vec2(2 * apart + 1.2f, 0.6f), draw_log(maker, 1, 200), vec2(0, height + 0.3f));
    return (Shape){apart, height, mass};
}

static Shape make_dominoes(Maker *maker) {
    const float mass = draw_log(maker, 1, 10);
    const int boxes = 2 * draw_int(maker, 4, 12);
    const float left = -0.35f * (float)boxes;
    for (int i = 0; i < boxes; i++) add(maker, vec2(0.2f, 2), mass, vec2(left + (float)i * 0.7f, 1));
    for (int i = 0; i < boxes / 2; i++) add(maker, vec2(1.38f, 0.2f), mass, vec2(left + 0.35f + (float)i * 1.4f, 2.1f));
    return (Shape){-left, 2, mass};
}

typedef struct Family {
    Shape (*make)(Maker *maker);
    int settle; /* frames */
} Family;

static const Family families[] = {{make_stack, 60}, {make_tower, 60}, {make_pyramid, 90}, {make_wall, 90},
                                  {make_pile, 240}, {make_gate, 60},  {make_dominoes, 60}};
enum { FAMILIES = sizeof families / sizeof *families };

/* From outside towards a random point of the shape; into a pile from above. */
static void aim(Maker *maker, BodyDef *bomb, const Shape *shape, bool from_above) {
    const Vec2 at =
        vec2(draw(maker, -(double)shape->half_width, (double)shape->half_width), draw(maker, 0.5, shape->height));
    const float angle = from_above ? draw(maker, 1.3, 1.8) : draw(maker, 0.15, 3.0);
    const Vec2 away = vec2((float)cos((double)angle), (float)sin((double)angle));
    const float far = 4 + shape->half_width * fabsf(away.x) + (shape->height - at.y + 1) * away.y;
    const float speed = draw(maker, 8, 30);
    bomb->position = vec2(at.x + far * away.x, at.y + far * away.y);
    if (bomb->position.y < 1.2f) bomb->position.y = 1.2f;
    bomb->velocity = vec2(-speed * away.x, -speed * away.y);
}

static BodyDef make_bomb(Maker *maker, const Shape *shape, bool from_above) {
    BodyDef bomb = {.friction = 0.2f, .mass = shape->mass * draw_log(maker, 1, 60)};
    const float size = draw(maker, 0.7, 1.6);
    bomb.size = vec2(size, size * draw(maker, 0.7, 1.4));
    aim(maker, &bomb, shape, from_above);
    if (draw_int(maker, 0, 9) < 6) {
        bomb.angle = draw(maker, -1.5, 1.5);
        bomb.angular_velocity = draw(maker, -20, 20);
    }
    return bomb;
}

void random_scene_make(RandomScene *random, uint64_t seed, int number) {
    Maker maker = {random, seed, 0};
    maker.state = split_mix(&maker.state) ^ ((uint64_t)number * UINT64_C(0xd1342543de82ef95));
    maker.friction = draw(&maker, 0.1, 0.6);
    *random = (RandomScene){.scene = {.gravity = {0, -10},
                                      .dt = 1.0f / 60,
                                      .iterations = 10,
                                      .warm_starting = true,
                                      .accumulate_impulses = true,
                                      .position_correction = true}};
    Scene *scene = &random->scene;
    scene->bodies = random->bodies;
    snprintf(scene->name, sizeof scene->name, "random %d", number);
    add(&maker, vec2(100, 20), 1, vec2(0, -10))->fixed = true;
    const Family *family = &families[number % FAMILIES];
    const Shape shape = family->make(&maker);
    scene->bomb = (SceneBomb){.present = true,
                              .frame = family->settle,
                              .body = make_bomb(&maker, &shape, family->make == make_pile),
                              .impact_frames = SCENE_IMPACT_FRAMES};
    scene->frames = family->settle + 180;
}
