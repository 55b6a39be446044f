/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/frames_option.h"

#include <limits.h>
#include <string.h>

bool frames_option_split(const char *text, char separator, int minimum, int maximum, int64_t numbers[2]) {
    const char *middle = strchr(text, separator);
    char first[24] = "";
    if (middle == NULL || middle - text >= (int)sizeof first) return false;
    memcpy(first, text, (size_t)(middle - text));
    return (first[0] == '\0' || parse_int(first, minimum, maximum, &numbers[0])) &&
           (middle[1] == '\0' || parse_int(middle + 1, minimum, maximum, &numbers[1]));
}

bool frames_option_read(const Option *option, const char *text, void *value, Error *error) {
    FrameRange *range = value;
    int64_t frames[2] = {0, -1};
    bool ok = strchr(text, ':') != NULL ? strcmp(text, ":") != 0 && frames_option_split(text, ':', 0, INT_MAX, frames)
                                        : parse_int(text, 0, INT_MAX, &frames[0]) && ((frames[1] = frames[0]), true);
    if (!ok || (frames[1] != -1 && frames[1] < frames[0]))
        return error_input(error, option->name, "'%s' is not A:B with frame numbers 0 <= A <= B", text);
    range->first = (int)frames[0];
    range->last = (int)frames[1];
    return true;
}
