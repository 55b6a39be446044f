/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fills a trajectory in memory from a world. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void describe_body(Trajectory *trajectory, int body, const BodyDef *def) {
    trajectory->size[body] = def->size;
    trajectory->fixed[body] = def->fixed;
    trajectory->mass[body] = def->fixed ? 0 : def->mass;
}

Trajectory *trajectory_of_scene(const Scene *scene, const Method *method, int frames, Error *error) {
    const bool bomb = scene_has_launch(scene);
    Trajectory *trajectory = trajectory_create(frames, scene->body_count + bomb, error);
    if (trajectory == NULL) return NULL;
    snprintf(trajectory->scene, sizeof trajectory->scene, "%s", scene->name);
    snprintf(trajectory->method, sizeof trajectory->method, "%s", method->text);
    trajectory->no_contacts = method->kind->description->whole_scenes;
    trajectory->scene_hash = scene_hash(scene);
    trajectory->iterations = scene->iterations;
    trajectory->dt = scene->dt;
    trajectory->camera_center = scene->camera_center;
    trajectory->camera_size = scene->camera_size;
    for (int i = 0; i < scene->body_count; i++) describe_body(trajectory, i, &scene->bodies[i]);
    if (scene->names != NULL) {
        if (!trajectory_make_names(trajectory, error)) {
            trajectory_destroy(trajectory);
            return NULL;
        }
        memcpy(trajectory->name, scene->names, (size_t)scene->body_count * sizeof *scene->names);
    }
    trajectory->bomb = bomb ? scene->body_count : -1;
    const BodyDef body = scene_bomb_body(scene);
    if (bomb) describe_body(trajectory, trajectory->bomb, &body);
    return trajectory;
}

void trajectory_set_bodies(Trajectory *trajectory, int frame, const World *world) {
    const Body *bodies = world_bodies(world);
    const size_t row = (size_t)frame * (size_t)trajectory->bodies;
    const int count = world_body_count(world);
    for (int i = 0; i < count; i++) {
        trajectory->position[row + (size_t)i] = bodies[i].position;
        trajectory->angle[row + (size_t)i] = bodies[i].angle;
        trajectory->velocity[row + (size_t)i] = bodies[i].velocity;
        trajectory->angular_velocity[row + (size_t)i] = bodies[i].angular_velocity;
    }
    for (size_t i = row + (size_t)count; i < row + (size_t)trajectory->bodies; i++) {
        trajectory->position[i] = trajectory->velocity[i] = vec2(NAN, NAN);
        trajectory->angle[i] = trajectory->angular_velocity[i] = NAN;
    }
}

bool trajectory_set_contacts(Trajectory *trajectory, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const ContactSolution *solution = world_solution(world);
    TrajectoryContact *records = trajectory_add_contacts(trajectory, frame, problem->contact_count, error);
    if (records == NULL) return false;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        records[i] = (TrajectoryContact){.a = contact->a,
                                         .b = contact->b,
                                         .feature = contact->feature,
                                         .point = contact->position,
                                         .normal = contact->normal,
                                         .normal_impulse = solution->impulses[i].normal,
                                         .tangent_impulse = solution->impulses[i].tangent};
    }
    return true;
}
