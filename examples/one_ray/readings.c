#include "readings.h"

#include <math.h>

#include "control/between.h"

static void begin(readings_t *readings, uint32_t taken_us)
{
    *readings = (readings_t){.began_us = taken_us, .open = true};
}

static void add(readings_t *readings, float slant_mm, uint32_t taken_us)
{
    if (readings->good_rays == 0U) {
        readings->first_mm = readings->least_mm = readings->most_mm = slant_mm;
    }
    readings->sum_mm += slant_mm - readings->first_mm;
    readings->least_mm = at_most(readings->least_mm, slant_mm);
    readings->most_mm = at_least(readings->most_mm, slant_mm);
    readings->sum_us += taken_us - readings->began_us;
    ++readings->good_rays;
}

static mirror_range_t mean_of(const readings_t *readings, mirror_t mirror)
{
    return (mirror_range_t){
        .mirror = mirror,
        .valid = true,
        .slant_mm = readings->first_mm + readings->sum_mm / (float)readings->good_rays,
        .spread_mm = readings->most_mm - readings->least_mm,
        .good_rays = readings->good_rays,
    };
}

bool readings_take(readings_t *readings, float slant_mm, uint32_t taken_us, mirror_t mirror,
                   mirror_range_t *group, uint32_t *rays_us)
{
    bool complete = readings->open && taken_us - readings->began_us >= READINGS_SPAN_US;

    if (complete) {
        const bool valid = readings->good_rays >= 2U;

        *group = valid ? mean_of(readings, mirror) : (mirror_range_t){.mirror = mirror};
        *rays_us = readings->began_us +
                   (valid ? readings->sum_us / readings->good_rays : READINGS_SPAN_US / 2U);
    }
    if (complete || !readings->open) {
        begin(readings, taken_us);
    }
    if (isfinite(slant_mm)) {
        add(readings, slant_mm, taken_us);
    }
    return complete;
}
