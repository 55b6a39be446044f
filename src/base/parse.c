/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers from text. */
#include "base/base.h"

#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_sign(const char *text) { return *text == '+' || *text == '-' ? text + 1 : text; }

static const char *skip_digits(const char *text) {
    while (*text >= '0' && *text <= '9') text++;
    return text;
}

/* End of the decimal number that text begins with, or NULL. strtof alone would also accept blanks, hexadecimal, inf and
   nan. */
static const char *decimal_end(const char *text) {
    const char *whole = skip_sign(text), *end = skip_digits(whole);
    ptrdiff_t digits = end - whole;
    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += end - fraction;
    }
    if (digits == 0) return NULL;
    if (*end == 'e' || *end == 'E') {
        const char *exponent = skip_sign(end + 1);
        end = skip_digits(exponent);
        if (end == exponent) return NULL;
    }
    return end;
}

/* strtof and strtod use the decimal point of the thread's locale, so the C locale is set meanwhile. */
static locale_t enter_c_locale(void) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return c == (locale_t)0 ? c : uselocale(c);
}

static void leave_c_locale(locale_t previous) { freelocale(uselocale(previous)); }

/* Each width is rounded once, from the text: a float by way of double would be rounded twice. */
typedef struct Number {
    float single;
    double full;
} Number;

/* The number of a text that is known to begin with a decimal. */
static bool parse_convert(const char *text, Number *number) {
    locale_t previous = enter_c_locale();
    if (previous == (locale_t)0) return false;
    *number = (Number){strtof(text, NULL), strtod(text, NULL)};
    leave_c_locale(previous);
    return isfinite(number->single);
}

/* The decimal number up to `terminator`; *rest is what follows it. */
static bool take_number(const char *text, char terminator, Number *number, const char **rest) {
    const char *end = decimal_end(text);
    if (end == NULL || *end != terminator) return false;
    *rest = end + 1;
    return parse_convert(text, number);
}

/* A number, or a fraction of two. */
static bool parse_number(const char *text, Number *number) {
    Number divisor = {1, 1};
    const char *rest;
    if (!take_number(text, '\0', number, &rest) &&
        !(take_number(text, '/', number, &rest) && take_number(rest, '\0', &divisor, &rest) && divisor.single != 0))
        return false;
    *number = (Number){number->single / divisor.single, number->full / divisor.full};
    return isfinite(number->single);
}

bool parse_float(const char *text, float *value) {
    Number number;
    const bool ok = parse_number(text, &number);
    if (ok) *value = number.single;
    return ok;
}

bool parse_double(const char *text, double *value) {
    Number number;
    const bool ok = parse_number(text, &number);
    if (ok) *value = number.full;
    return ok;
}

bool parse_leading_double(const char *text, double *value, const char **rest) {
    Number number;
    const char *end = decimal_end(text);
    if (end == NULL || !parse_convert(text, &number)) return false;
    *value = number.full;
    *rest = end;
    return true;
}

bool parse_leading_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value, const char **rest) {
    const char *digits = skip_sign(text), *end = skip_digits(digits);
    if (end == digits) return false;
    errno = 0;
    intmax_t number = strtoimax(text, NULL, 10);
    if (errno != 0 || number < minimum || number > maximum) return false;
    *value = number;
    *rest = end;
    return true;
}

bool parse_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value) {
    int64_t number;
    const char *rest;
    const bool whole = parse_leading_int(text, minimum, maximum, &number, &rest) && *rest == '\0';
    if (whole) *value = number;
    return whole;
}

/* In steps: a value this far past the end still counts as the end, one this near zero as zero. A, B and STEP are
   decimals and seldom exact in binary. */
static const double STEP_TOLERANCE = 1e-6;

bool parse_range(const char *text, int max_count, FloatRange *range) {
    Number first, last, step;
    const char *rest;
    if (!take_number(text, ':', &first, &rest) || !take_number(rest, ':', &last, &rest) ||
        !take_number(rest, '\0', &step, &rest))
        return false;
    if (!(step.full > 0) || first.full > last.full) return false;
    double count = floor((last.full - first.full) / step.full + STEP_TOLERANCE) + 1;
    if (!(count <= max_count)) return false;
    *range = (FloatRange){first.full, step.full, (int)count};
    return true;
}

float range_value(const FloatRange *range, int i) {
    double value = range->first + i * range->step;
    return fabs(value) < STEP_TOLERANCE * range->step ? 0 : (float)value;
}
