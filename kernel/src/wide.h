/* One function compiled twice: for every processor, and for those of x86-64 that have AVX2. Neither version contracts or
 * reorders anything, so that both give the same bits. */
#ifndef RC_WIDE_H
#define RC_WIDE_H

#define RC_EVERYWHERE __attribute__((always_inline))

#if defined(__x86_64__) && !defined(RC_SCALAR)
#include <cpuid.h>
#include <stdint.h>

static inline int rc_has_avx2(void)
{
    uint32_t a, b, c, d, low, high;
    /* Bits 27 and 28: the system keeps the large registers of a thread that has to wait; the processor has AVX. */
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c >> 27 & 3) != 3) {
        return 0;
    }
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (low & 6) == 6 && __get_cpuid_count(7, 0, &a, &b, &c, &d) && b >> 5 & 1;
}

/* Defines rc_wide_NAME(), which tells the version to call of an always inlined function NAME. */
#define RC_WIDE_VERSIONS(name, parameters, arguments)                                      \
    __attribute__((target("avx2"))) static void name##_avx2 parameters { name arguments; } \
    static void name##_any parameters { name arguments; }                                  \
    static void(*rc_wide_##name(void)) parameters { return rc_has_avx2() ? name##_avx2 : name##_any; }
#else
#define RC_WIDE_VERSIONS(name, parameters, arguments)     \
    static void name##_any parameters { name arguments; } \
    static void(*rc_wide_##name(void)) parameters { return name##_any; }
#endif

#endif
