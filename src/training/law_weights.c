/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "training/law_weights.h"

#include "common/names.h"
#include "common/parse.h"
#include "common/settings.h"

#include <string.h>

bool law_weights_any(const LawNumbers *weights) {
    for (int law = 0; law < LAWS; law++)
        if (weights->of[law] != 0) return true;
    return false;
}

bool law_weights_parse(const char *text, LawNumbers *weights, Error *error) {
    SettingSpec known[LAWS + 1] = {{NULL, NULL}};
    Settings settings;
    for (int law = 0; law < LAWS; law++) known[law] = (SettingSpec){laws_known[law].name, laws_known[law].summary};
    if (!settings_parse(&settings, text, known, "laws", error)) return false;
    *weights = (LawNumbers){{0}};
    for (int law = 0; law < LAWS; law++) {
        const char *value = settings_get(&settings, laws_known[law].name);
        if (value != NULL && !(parse_double(value, &weights->of[law]) && weights->of[law] >= 0))
            return error_input(error, "laws", "%s: '%s' is not a number of 0 or more", laws_known[law].name, value);
    }
    return true;
}

bool law_weights_named(const char *laws, double weight, LawNumbers *weights, Error *error) {
    bool found = strcmp(laws, "none") == 0;
    *weights = (LawNumbers){{0}};
    NameList known = {0};
    name_list_add(&known, "none");
    for (int law = 0; law < LAWS; law++) {
        name_list_add(&known, laws_known[law].name);
        if (strcmp(laws, "all") != 0 && strcmp(laws, laws_known[law].name) != 0) continue;
        weights->of[law] = weight;
        found = true;
    }
    name_list_add(&known, "all");
    return found || error_unknown(error, "laws", laws, "a law", &known);
}
