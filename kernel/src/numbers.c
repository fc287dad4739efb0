/* Lines of decimal numbers, each rounded to the nearest double as strtod rounds it, whatever the locale.
 *
 * What is written in another way than plain digits, or with more of them than can be rounded with whole numbers of 64 and
 * 128 bits, is left to the caller: it is rare. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "reflcolor_kernel.h"

/* Powers of ten that a double holds exactly, and those that 64 bits hold. */
#define RC_EXACT_TENS 22
#define RC_WHOLE_TENS 19
#define RC_MOST_DIGITS 19
#define RC_MOST_EXPONENT 400

static const double tens[RC_EXACT_TENS + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* mantissa / 10^power, correctly rounded, for mantissa > 0 and power up to RC_WHOLE_TENS: long division. */
static double divided(uint64_t mantissa, int power)
{
    uint64_t divisor = 1;
    for (int i = 0; i < power; i++) {
        divisor *= 10;
    }
    const int up = __builtin_clzll(mantissa), down = __builtin_clzll(divisor);
    const unsigned __int128 dividend = (unsigned __int128)(mantissa << up) << 63;
    const uint64_t shifted = divisor << down;
    /* Of 63 or 64 bits. */
    const uint64_t quotient = (uint64_t)(dividend / shifted);
    const int inexact = dividend % shifted != 0, beyond = 64 - __builtin_clzll(quotient) - 53;
    const uint64_t rest = quotient & ((UINT64_C(1) << beyond) - 1), half = UINT64_C(1) << (beyond - 1);
    uint64_t kept = quotient >> beyond;
    kept += rest > half || (rest == half && (inexact || kept & 1));
    /* A power of two between 2^-127 and 2^64: multiplying by it rounds nothing. */
    const uint64_t bits = (uint64_t)(1023 + beyond - 63 + down - up) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return (double)kept * scale;
}

/* Read a number and return what follows it; null where it is not written as expected. */
static const char *number(const char *p, const char *end, double *out)
{
    int negative = 0, digits = 0, power = 0, any = 0;
    uint64_t mantissa = 0;
    if (p < end && (*p == '-' || *p == '+')) {
        negative = *p++ == '-';
    }
    for (int fraction = 0;; p++) {
        const unsigned digit = p < end ? (unsigned char)*p - (unsigned)'0' : 10;
        if (digit < 10) {
            any = 1;
            /* Zeros in front do not count as digits. */
            digits += digits || digit;
            power -= fraction;
            if (digits > RC_MOST_DIGITS) {
                return NULL;
            }
            mantissa = mantissa * 10 + digit;
        } else if (p < end && *p == '.' && !fraction) {
            fraction = 1;
        } else {
            break;
        }
    }
    if (!any) {
        return NULL;
    }
    if (p < end && (*p == 'e' || *p == 'E')) {
        int exponent = 0, below = 0, given = 0;
        p++;
        if (p < end && (*p == '-' || *p == '+')) {
            below = *p++ == '-';
        }
        for (; p < end && (unsigned char)(*p - '0') < 10; p++) {
            given = 1;
            exponent = exponent * 10 + (*p - '0');
            if (exponent > RC_MOST_EXPONENT) {
                return NULL;
            }
        }
        if (!given) {
            return NULL;
        }
        power += below ? -exponent : exponent;
    }
    double value;
    if (mantissa == 0) {
        value = 0.0;
    } else if (mantissa <= UINT64_C(1) << 53 && power >= -RC_EXACT_TENS && power <= RC_EXACT_TENS) {
        /* Both are exact, so that there is one rounding. */
        value = power < 0 ? (double)mantissa / tens[-power] : (double)mantissa * tens[power];
    } else if (power <= 0 && power >= -RC_WHOLE_TENS) {
        value = divided(mantissa, -power);
    } else {
        return NULL;
    }
    *out = negative ? -value : value;
    return p;
}

int32_t rc_numbers(int64_t size, const char *text, int64_t most_lines, int32_t width, double *values,
                   rc_numbers_read *read)
{
    if (!text || !values || !read) {
        return RC_BAD_POINTER;
    }
    if (size < 0 || most_lines < 0 || width < 1) {
        return RC_BAD_SIZE;
    }
    const char *const end = text + size, *line = text;
    memset(read, 0, sizeof *read);
    while (line < end && read->lines < most_lines) {
        double *const row = values + read->rows * width;
        const char *p = line;
        int32_t found = 0;
        for (;;) {
            while (p < end && (*p == ' ' || *p == '\t')) {
                p++;
            }
            if (p == end || *p == '\n') {
                break;
            }
            if (found == width || !(p = number(p, end, row + found))) {
                return RC_BAD_VALUE;
            }
            found++;
            if (p < end && *p != ' ' && *p != '\t' && *p != '\n') {
                return RC_BAD_VALUE;
            }
        }
        if (found && found != width) {
            return RC_BAD_VALUE;
        }
        line = p < end ? p + 1 : end;
        read->rows += found > 0;
        read->lines++;
        read->bytes = line - text;
    }
    return RC_OK;
}
