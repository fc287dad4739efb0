/* The caller's wish to cancel, and the progress told to it. */
#ifndef RC_CONTROL_H
#define RC_CONTROL_H

#include "reflcolor_kernel.h"

/* Pixels between two looks at the cancel flag: well under a millisecond. */
#define RC_POLL 4096

static inline int rc_cancelled(const rc_control *control) { return control->cancel && *control->cancel; }

static inline void rc_progress(const rc_control *control, int64_t by)
{
    if (control->progress) {
        __atomic_fetch_add(control->progress, by, __ATOMIC_RELAXED);
    }
}

/* Fill a plane; returns 0 if cancelled. */
static inline int rc_fill(float *plane, int64_t size, float value, const rc_control *control)
{
    for (int64_t i = 0; i < size; i++) {
        plane[i] = value;
        if (i % (64 * RC_POLL) == 0 && rc_cancelled(control)) {
            return 0;
        }
    }
    return 1;
}

#endif
