// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a scene with Box2D 2.4 and prints the run as CSV: box2d SCENE.yaml | twinbox import - -o RUN.npz
// Build (Debian: libbox2d-dev, libyaml-cpp-dev): c++ -O2 -o box2d box2d.cpp -lbox2d -lyaml-cpp
#include <box2d/box2d.h>
#include <cstdio>
#include <cstdlib>
#include <vector>
#include <yaml-cpp/yaml.h>

static std::vector<b2Body *> bodies;

static float number(const YAML::Node &node) { // 0.2, 1/60, {from: -5, to: 5, value: 5}; 0 if absent
    const std::string text = !node ? "0" : (node.IsMap() ? node["value"] : node).as<std::string>();
    const size_t slash = text.find('/');
    return std::strtof(text.c_str(), nullptr) / (slash < text.size() ? std::strtof(&text[slash + 1], nullptr) : 1);
}

static b2Vec2 vector(const YAML::Node &node) { return node ? b2Vec2(number(node[0]), number(node[1])) : b2Vec2(0, 0); }

static void add(b2World &world, const YAML::Node &box, b2Vec2 position, b2Vec2 velocity, bool enabled) {
    const b2Vec2 size = vector(box["size"]);
    b2BodyDef def;
    def.type = box["static"] ? b2_staticBody : b2_dynamicBody;
    def.position = position, def.linearVelocity = velocity, def.angle = number(box["angle"]), def.enabled = enabled;
    b2PolygonShape shape;
    shape.SetAsBox(size.x / 2, size.y / 2);
    b2FixtureDef fixture;
    fixture.shape = &shape, fixture.density = number(box["mass"]) / (size.x * size.y);
    fixture.friction = number(box["friction"]); // of a pair the root of the product, as in twinbox
    std::printf("# size: %zu,%.9g,%.9g,%s\n", bodies.size(), size.x, size.y, box["static"] ? "static" : "dynamic");
    bodies.push_back(world.CreateBody(&def));
    bodies.back()->CreateFixture(&fixture);
}

int main(int, char **arguments) {
    const YAML::Node scene = YAML::LoadFile(arguments[1]), bomb = scene["bomb"];
    const std::string path = arguments[1], file = path.substr(path.rfind('/') + 1);
    b2World world(vector(scene["gravity"]));
    for (const YAML::Node &box : scene["bodies"]) { // a box, or a pattern of boxes
        const int count = box["count"] ? box["count"].as<int>() : 1;
        const bool pyramid = box["pattern"] && box["pattern"].as<std::string>() == "pyramid";
        const b2Vec2 first = vector(box["position"]), step = vector(box["spacing"]);
        for (int row = 0; row < (pyramid ? count : 1); row++)
            for (int i = 0; i < count - row; i++)
                add(world, box, first + b2Vec2(step.x * (i + 0.5f * row), step.y * (pyramid ? row : i)), {0, 0}, true);
    }
    const int frames = scene["frames"].as<int>(), bomb_frame = static_cast<int>(number(bomb["frame"]));
    const b2Vec2 above(number(bomb["x"]), number(bomb["y"]));
    add(world, bomb, above, number(bomb["velocity"]["times_position"]) * above, bomb_frame == 0);
    const std::string name = file.substr(0, file.rfind('.'));
    std::printf("# bomb: %zu\n# scene: %s\n# method: Box2D 2.4\n", bodies.size() - 1, name.c_str());
    std::printf("# dt: %.9g\nframe,body,x,y,angle\n", number(scene["dt"]));
    for (int frame = 0; frame <= frames; frame++) {
        if (frame > 0) world.Step(number(scene["dt"]), scene["iterations"].as<int>(), 3);
        if (frame == bomb_frame) bodies.back()->SetEnabled(true);
        for (size_t i = 0; i < bodies.size() - (frame < bomb_frame); i++)
            std::printf("%d,%zu,%.9g,%.9g,%.9g\n", frame, i, bodies[i]->GetPosition().x, bodies[i]->GetPosition().y,
                        bodies[i]->GetAngle());
    }
}
