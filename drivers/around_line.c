#include "drivers/around_line.h"

#include <math.h>
#include <stddef.h>

#define CM_PER_MM 0.1F
#define DEGREES 360.0F

/* 100 mm times 41 to the power of k / 62, in whole millimetres: where step k begins. */
static const uint16_t begins_mm[] = {
    100U,  106U,  113U,  120U,  127U,  135U,  143U,  152U,  161U,  171U,  182U,  193U,  205U,
    218U,  231U,  246U,  261U,  277U,  294U,  312U,  331U,  352U,  373U,  397U,  421U,  447U,
    475U,  504U,  535U,  568U,  603U,  640U,  680U,  722U,  766U,  814U,  864U,  917U,  974U,
    1034U, 1098U, 1166U, 1237U, 1314U, 1395U, 1481U, 1572U, 1670U, 1773U, 1882U, 1998U, 2122U,
    2252U, 2391U, 2539U, 2696U, 2862U, 3039U, 3227U, 3426U, 3637U, 3862U};
#define STEPS ((uint16_t)(sizeof begins_mm / sizeof begins_mm[0]))
#define RUN_MAX (STEPS - 1U)

static const char digits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
typedef char every_step_has_its_character[(sizeof digits / sizeof digits[0] - 1U == STEPS) ? 1 : -1];

/* The last step that begins there or before; nearer than the first is the first. */
static uint16_t step_of(uint16_t mm)
{
    uint16_t step = 0U;

    while (step + 1U < STEPS && begins_mm[step + 1U] <= mm) {
        ++step;
    }
    return step;
}

static uint16_t run_from(const uint16_t *sectors, uint16_t first)
{
    uint16_t run = 0U;

    while (first + run < AROUND_LINE_SECTORS && run < RUN_MAX && sectors[first + run] == AROUND_LINE_UNSEEN) {
        ++run;
    }
    return run;
}

/* A whole number; what stands before it is a comma, or the field's name. */
static void add_number(telemetry_line_t *line, const char *before, float value)
{
    telemetry_text(line, before);
    telemetry_fixed(line, value, 0U);
}

static float whole_degrees(float degrees)
{
    const float whole = floorf(degrees + 0.5F);

    return whole - DEGREES * floorf(whole / DEGREES);
}

static void add_wall(telemetry_line_t *line, const char *before, const around_line_wall_t *wall)
{
    add_number(line, before, whole_degrees(wall->bearing_deg));
    add_number(line, ",", wall->mm * CM_PER_MM);
    add_number(line, ",", wall->mmps * CM_PER_MM);
}

void around_line_drift(telemetry_line_t *line, const around_line_wall_t walls[], uint16_t count)
{
    telemetry_begin(line);
    for (uint16_t i = 0U; i < count; ++i) {
        add_wall(line, (i == 0U) ? "drift:" : "/", &walls[i]);
        add_number(line, ",", fmaxf(walls[i].sigma_mmps * CM_PER_MM, 1.0F));
    }
    if (count == 0U) {
        telemetry_text(line, "drift:-");
    }
    telemetry_end(line);
}

void around_line(telemetry_line_t *line, const uint16_t sectors[AROUND_LINE_SECTORS],
                 const around_line_wall_t *coming)
{
    uint16_t s = 0U;

    telemetry_begin(line);
    telemetry_text(line, "w:");
    while (s < AROUND_LINE_SECTORS) {
        const uint16_t run = run_from(sectors, s);

        if (run > 0U) {
            telemetry_text(line, "-");
            telemetry_characters(line, &digits[run], 1U);
            s = (uint16_t)(s + run);
        } else {
            telemetry_characters(
                line, (sectors[s] == AROUND_LINE_NOTHING) ? "." : &digits[step_of(sectors[s])], 1U);
            ++s;
        }
    }
    if (coming != NULL) {
        add_wall(line, " near:", coming);
    }
    telemetry_end(line);
}
