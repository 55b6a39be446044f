/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameters of scene files: numbers made of them, settings, and what is refused. */
#include "scene_text.h"
#include "owned.h"

/* A box whose mass is in line 6, column 5 + ..., and two parameters behind it. */
#define HEIGHT "  height: {value: 10, from: 2, to: 40, unit: boxes, whole: on}\n"
#define RATIO "  ratio: {value: 0.1, from: -1e3, to: 1e3}\n"
#define MASS(mass) BODY("size: [1, 1], position: [0, 0], mass: " mass)
#define SCENE(mass) MASS(mass) "parameters:\n" HEIGHT RATIO
#define USES_BOTH "camera: {center: [$height, $ratio], size: [1, 1]}\n"

static float mass_of(const char *text) {
    OWN(Scene) *scene = good_scene(text);
    float mass = scene->bodies[0].mass;
    return mass;
}

static void expect_mass(const char *expression, float expected) {
    char text[2048];
    snprintf(text, sizeof text, USES_BOTH MASS("%s") "parameters:\n" HEIGHT RATIO, expression);
    float found = mass_of(text);
    if (memcmp(&found, &expected, sizeof found) != 0)
        fail_msg("%s is %.9g, not %.9g", expression, (double)found, (double)expected);
}

/* From left to right in double, rounded once: 0.1 is the double 0.1 and no float. */
TEST(expressions_are_computed_from_left_to_right) {
    expect_mass("$height", 10);
    expect_mass("$ratio", (float)0.1);
    expect_mass("2*$height", 20);
    expect_mass("$height*2", 20);
    expect_mass("1/$height", (float)0.1);
    expect_mass("$height/4", 2.5F);
    expect_mass("2*$height/4*3", 15);
    expect_mass("60/$height/3", 2);
    expect_mass("60/$height*3", 18);
    expect_mass("-0.5*$height*-1", 5);
    expect_mass("$height*$height*$ratio", (float)(100 * 0.1));
    expect_mass("$ratio*3", (float)(0.1 * 3));
    expect_mass("1e30*1e30/1e30/1e30*7", 7);
    expect_mass("1*1*1*1*1*1*1*1*1*1*1*1*1*1*1*2", 2);
}

TEST(products_go_before_sums_and_parentheses_before_both) {
    expect_mass("$height + 0.25", 10.25F);
    expect_mass("$height+0.25", 10.25F);
    expect_mass("2 + 3 * $height", 32);
    expect_mass("(2 + 3) * $height", 50);
    expect_mass("$height - 3 - 2", 5);
    expect_mass("$height - (3 - 2)", 9);
    expect_mass("$height -3", 7);
    expect_mass("60 / (2 * 3) / 5", 2);
    expect_mass("1 - -$height", 11);
    expect_mass("-(-$height)", 10);
    expect_mass("-$ratio*-2", (float)(0.1 * 2));
    expect_mass("( ( $height ) )", 10);
    expect_mass("1e-1*$height + 1e+1", 11);
    expect_mass("($height - 1)*($height + 1)/(2 - $ratio)", (float)(9.0 * 11.0 / (2.0 - 0.1)));
    expect_mass("'$height*(1 + 1)'", 20);
}

/* The same bits whether the numbers are written or named, and as before there were names: division in float32. */
TEST(a_fraction_keeps_its_bits) {
    static const char written[] = "gravity: [0, -10]\ndt: 1/%d\niterations: 1\nframes: 60\n" GROUND;
    static const char named[] = "gravity: [0, -10]\ndt: 1/$rate\niterations: 1\nframes: 60*$rate\n" GROUND
                                "parameters: {rate: {value: %d, from: 1, to: 480, whole: on}}\n";
    for (int rate = 1; rate <= 480; rate += 13) {
        const char *const formats[] = {written, named};
        for (int i = 0; i < 2; i++) {
            OWN(Scene) *scene = good_scene(printed(formats[i], rate));
            float expected = 1.0F / (float)rate;
            assert_memory_equal(&scene->dt, &expected, sizeof expected);
        }
    }
}

/* Parameters may stand before or behind the numbers that are made of them; the physics is that of the numbers. */
TEST(a_scene_with_parameters_is_the_scene_of_their_values) {
    static const char parameters[] = "parameters:\n" HEIGHT;
    static const char scene[] = BASE GROUND
        "  - {pattern: stack, count: $height, spacing: [0, 1], mass: 1, size: [1, 1], position: [0, 0.05*$height]}\n"
        "bomb: {x: 0.5*$height, y: 15, size: [1, 1], mass: $height, velocity: {times_position: -0.15*$height}}\n";
    OWN(Scene) *plain = good_scene(
        BASE GROUND "  - {pattern: stack, count: 10, spacing: [0, 1], mass: 1, size: [1, 1], position: [0, 0.5]}\n"
                    "bomb: {x: 5, y: 15, size: [1, 1], mass: 10, velocity: {times_position: -1.5}}\n");
    for (int before = 0; before <= 1; before++) {
        char text[2048];
        snprintf(text, sizeof text, "%s%s", before ? parameters : scene, before ? scene : parameters);
        OWN(Scene) *found = good_scene(text);
        assert_int_equal(scene_hash(found), scene_hash(plain));
        assert_int_equal(found->parameter_count, 1);
        const SceneParameter *height = &found->parameters[0];
        assert_string_equal(height->name, "height");
        assert_string_equal(height->unit, "boxes");
        assert_true(height->value == 10 && height->from == 2 && height->to == 40 && height->whole);
    }
    assert_int_equal(plain->parameter_count, 0);
}

static Scene *read_with(const char *text, const SceneSetting *settings, int count, Error *error) {
    *error = (Error){.kind = ERROR_NONE};
    return scene_read_with(write_scene(text, strlen(text)), settings, count, error);
}

TEST(settings_take_the_place_of_values) {
    const SceneSetting settings[] = {{"ratio", 0.5}, {"height", 40}};
    static const double masses[] = {1, 5, 20};
    for (int count = 0; count <= 2; count++) {
        OWN(Scene) *scene = read_with(SCENE("$height*$ratio"), settings, count, &error);
        assert_ok(scene != NULL, error);
        assert_near(scene->bodies[0].mass, masses[count], 0);
        assert_true(scene->parameters[0].value == (count == 2 ? 40 : 10));
        assert_true(scene->parameters[1].value == (count >= 1 ? 0.5 : 0.1));
    }
}

/* A bomb that flies at (3, -4) m/s, and one by a law. */
#define BOMBED(velocity)                            \
    BODY("size: [1, 1], position: [0, 0], mass: 1") \
    "bomb: {x: 2, y: 12, size: [1, 1], mass: 5, frame: 30, velocity: " velocity "}\n"

static Scene *set_one(const char *text, const char *name, double value) {
    SceneSetting setting = {.value = value};
    Error error;
    strcpy(setting.name, name);
    Scene *scene = read_with(text, &setting, 1, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

static double value_of(const Scene *scene, const char *name) {
    const SceneParameters all = scene_parameters(scene);
    return scene_parameter(&all, name)->value;
}

TEST(what_every_scene_has_can_be_set) {
    static const SceneSetting settings[] = {{"iterations", 7}, {"friction", 0.75}, {"bomb_x", -2.5},
                                            {"bomb_y", 8.25},  {"bomb_mass", 40},  {"bomb_speed", 10}};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        OWN(Scene) *scene = set_one(BOMBED("[3, -4]"), settings[i].name, settings[i].value);
        assert_near(value_of(scene, settings[i].name), settings[i].value, 1e-6);
    }
    OWN(Scene) *fast = set_one(BOMBED("[3, -4]"), "bomb_speed", 10);
    assert_near(scene_bomb_body(fast).velocity.x, 6, 1e-6);
    OWN(Scene) *lawful = set_one(BOMBED("{times_position: -1}"), "bomb_speed", 0.5);
    assert_near(vec2_distance(scene_bomb_body(lawful).velocity, vec2(0, 0)), 0.5, 1e-6);
    OWN(Scene) *rough = set_one(BOMBED("[3, -4]"), "friction", 0.75);
    assert_true(rough->bodies[0].friction == 0.75F && rough->bomb.friction == 0.75F);
}

TEST(settings_are_read_from_text) {
    static const char *const good[] = {"iterations=7", "dt=0.01",      "friction=0.5",   "bomb_x=-2.5",
                                       "bomb_y=8.25",  "bomb_mass=40", "bomb_speed=1e-1"};
    SceneSettings settings = {0};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) assert_true(scene_settings_add(&settings, good[i]));
    assert_int_equal(settings.count, 7);
    Scene *scene = read_with(BOMBED("[3, -4]"), settings.items, settings.count, &error);
    assert_ok(scene != NULL, error);
    assert_near(scene->bomb.mass.value, 40, 0);
    scene_destroy(scene);
    static const char *const bad[] = {"", "x", "=1", "x=", "x=1e999", "x=NaN", "x= 1", "x=1,y=2", "x=0x1p3"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) assert_false(scene_settings_add(&settings, bad[i]));
    for (int i = 0; i < 100; i++) assert_true(scene_settings_add(&settings, "height=1"));
    assert_int_equal(settings.count, SCENE_SETTINGS_MAX);
}

/* The run and the way to the bomb take as many seconds as before. */
TEST(another_time_step_leaves_the_time) {
    OWN(Scene) *plain = good_scene(BOMBED("[0, -1]")), *scene = set_one(BOMBED("[0, -1]"), "dt", (double)plain->dt / 3);
    assert_near(scene->frames, 3 * plain->frames, 0);
    assert_near(scene->bomb.frame, 90, 0);
    assert_near(scene->dt * 3, plain->dt, 1e-9);
}

TEST(a_parameter_of_that_name_goes_before) {
    OWN(Scene) *scene =
        set_one(MASS("$friction") "parameters: {friction: {value: 1, from: 0.5, to: 20}}\n", "friction", 20);
    assert_true(scene->bodies[0].mass == 20 && scene->bodies[0].friction < 1);
    const SceneParameters all = scene_parameters(scene);
    assert_ptr_equal(scene_parameter(&all, "friction"), &all.items[0]);
}

TEST(what_no_scene_can_have_is_refused) {
    static const struct {
        const char *text;
        SceneSetting setting;
        const char *message;
    } table[] = {
        {BOMBED("[0, 0]"), {"bomb_speed", 1}, "bomb_speed cannot be set: the bomb is at rest, so it has no direction"},
        {BOMBED("{times_position: 100}"), {"bomb_x", 1e3}, "with bomb_x = 1000 the bomb starts at 100007.2 m/s"}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        assert_refused(read_with(table[i].text, &table[i].setting, 1, &error), table[i].message);
}

/* It may still be none for the number that is made of it. */
TEST(a_value_in_its_bounds_may_be_refused) {
    assert_refused(read_with(SCENE("$height*$ratio"), &(SceneSetting){"ratio", -0.25}, 1, &error),
                   "mass must be greater than 0 (got -2.5 kg, from $height*$ratio with height = 10 boxes, "
                   "ratio = -0.25)");
}

#define EIGHT(text) text text text text text text text text
#define OPERAND ": a number, a $name or '(' is expected here (got "
#define OPERATOR ": an operator or the end is expected here (got "

static const Refused expressions[] = {
    {SCENE("1e9*$height"), "6:44: error: mass must be from 1e-06 to 1e+09 kg (got 1e+10 kg, from 1e9*$height with "
                           "height = 10 boxes)"},
    {SCENE("$height/0"), "6:51: error: mass is divided by 0 (got $height/0 with height = 10 boxes)"},
    {SCENE("2*$"), "6:46: error: mass: a parameter's name must follow the '$' (got 2*$)"},
    {SCENE("2*$hieght"), "6:46: error: mass: '$hieght' is not a parameter; did you mean 'height'?"},
    {SCENE("$speed"), "6:44: error: mass: '$speed' is not a parameter; known: height, ratio"},
    {MASS("$speed"), "6:44: error: mass: '$speed' is not a parameter; known: none"},
    {SCENE("2*"), "6:46: error: mass" OPERAND "2*)"},
    {SCENE("2$height"), "6:45: error: mass" OPERATOR "2$height with height = 10 boxes)"},
    {SCENE("2*(3+4"), "6:50: error: mass: an operator or ')' is expected here (got 2*(3+4)"},
    {SCENE(EIGHT("1e38*") "1e38"), "6:83: error: mass has an intermediate result that is infinite (got "
                                   "1e38*1e38*1e38*1e38*1e38*1e38*1e38*1e38*1...)"},
    {SCENE(EIGHT(EIGHT(EIGHT("(((("))) "1"),
     "6:76: error: mass: an expression has too many numbers, signs and parentheses (got "
     "(((((((((((((((((((((((((((((((((((((((((...)"},
};

TEST(the_caret_is_under_what_is_wrong) {
    expect_refused(SCENE("($height + $ratoi)*2"), "6:55: error: mass: '$ratoi' is not a parameter; did you mean "
                                                  "'ratio'?\n    6 |   - {size: [1, 1], position: [0, 0], mass: "
                                                  "($height + $ratoi)*2}\n      | "
                                                  "                                                      ^");
}

/* The value of a key of the scene, and a parameter half. */
#define WHOLE(key)            \
    "gravity: [0, -10]\n" key \
    "\nparameters: {half: {value: 0.5, from: 0, to: 1e6}, big: {value: 1e6, from: 0, to: 1e6}}\n"

static const Refused whole_numbers[] = {
    {WHOLE("frames: 3*$half"),
     "2:9: error: frames must be a whole number from 1 to 1000000 (got 1.5, from 3*$half with half = 0.5)"},
    {WHOLE("iterations: 2*$big"),
     "2:13: error: iterations must be a whole number from 1 to 1000000 (got 2000000, from 2*$big with big = 1000000)"},
};

#define PARAMETERS(text) BASE GROUND "parameters:\n  " text "\n"
#define ONE(keys) PARAMETERS("a: {" keys "}")
#define NAME_32 "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"

static const Refused parameters[] = {
    {BASE GROUND "parameters: 3\n", "7:13: error: parameters must be a mapping of names to values (got 3)"},
    {BASE GROUND "parameters: {}\n", NULL},
    {PARAMETERS("A: {value: 1, from: 0, to: 2}"),
     "8:3: error: a parameter's name must have 1 to 31 characters of a-z, 0-9 and _ (got A)"},
    {PARAMETERS(NAME_32 ": {value: 1, from: 0, to: 2}"),
     "8:3: error: a parameter's name must have 1 to 31 characters of a-z, 0-9 and _ (got " NAME_32 ")"},
    {ONE("value: 1, form: 0"), "8:17: error: 'form' is not a key of a parameter; did you mean 'from'?"},
    {ONE("value: 1/2, from: 0.75, to: 3"), "8:14: error: value must be from 0.75 to 3 (got 0.5, from 1/2)"},
    {ONE("value: x, from: 3, to: 0"), "8:14: error: value must be a number (got x)"},
    {ONE("value: 1, from: $a, to: 3"), "8:23: error: from must not contain parameters (got $a)"},
    {ONE("value: 1.5, from: 1, to: 2, whole: on"),
     "8:14: error: value must be a whole number, because whole is on (got 1.5)"},
    {ONE("value: 1, from: 1, to: 2, unit: " NAME_32),
     "8:39: error: unit must be a text of at most 24 bytes (got " NAME_32 ")"},
    {ONE("value: 1, from: 0, to: 2"), "8:3: error: no number of the scene uses the parameter '$a'"},
    {BASE GROUND "parameters: {a: {value: 1, from: 0, to: 2}, b: {value: 1, from: 0, to: 2}, c: {value: 1, from: 0, "
                 "to: 2},\n d: {value: 1, from: 0, to: 2}, e: {value: 1, from: 0, to: 2}}\n",
     "8:33: error: a scene must have at most 4 parameters"},
};

TEST(bad_expressions_are_refused) { CHECK_TABLE(expressions); }
TEST(whole_numbers_are_checked_on_the_result) { CHECK_TABLE(whole_numbers); }
TEST(bad_parameters_are_refused) { CHECK_TABLE(parameters); }

RUN_TESTS(NULL, NULL)
