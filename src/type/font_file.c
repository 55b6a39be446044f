/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "type/font_file.h"

#include "type/embedded_fonts.h"
#include "type/type.h"

#include <limits.h>

bool font_file_suffices(const char *text) {
    while (*text != '\0')
        if (type_next(&text)->index >= type_small_count) return false;
    return true;
}

FontFile font_file(bool small) {
    return small ? (FontFile){font_inter_regular_subset_otf, font_inter_regular_subset_otf_size, type_small_count}
                 : (FontFile){font_inter_regular_otf, font_inter_regular_otf_size, UINT_MAX};
}
