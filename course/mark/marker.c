/* Asks an answer in C, and flies it.
 *
 * usage: course_marker ANSWER.so law < QUESTIONS     one line for each cycle: "REFERENCE_M HEIGHT_MM
 * RATE_MM_S GAP_US NEW GRAV_N", or "again" for an empty memory; prints "THRUST_MN INTEGRAL_MN" course_marker
 * ANSWER.so height < QUESTIONS  "D L ARM SIGN SLANT_MM ROLL_MRAD PITCH_MRAD"; prints "ANSWER_UM RIGHT_UM"
 *        course_marker ANSWER.so number NAME         a number that the student foresaw, times 1000
 *        course_marker ANSWER.so fly SCENARIO ...    as `plomada fly`
 *
 * All answers are whole numbers, so that no machine prints another last digit. */
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/altitude.h"
#include "given_law.h"
#include "tools/plomada/commands.h"

#define QUESTION_MAX 256

typedef float (*height_t)(const mirror_geometry_t *mirror, float slant_mm, float roll_rad, float pitch_rad);

/* Where an answer gives no number: no student asks for so much. */
static long thousandths(double value)
{
    return isfinite(value) && fabs(value) < 1e6 ? lround(value * 1000.0) : 999999999L;
}

static void *named(void *answer, const char *name)
{
    void *found = dlsym(answer, name);

    if (found == NULL) {
        fprintf(stderr, "course_marker: the answer has no %s\n", name);
        exit(3);
    }
    return found;
}

static void ask_law(law_step_t law)
{
    char line[QUESTION_MAX];
    laws_t laws = {.setpoint_n = 0.0F};
    est_law_t est;
    parameters_t parameters;
    where_t where;

    memset(&est, 0, sizeof est);
    memset(&where, 0, sizeof where);
    parameters_init(&parameters);
    parameters.value[PARAMETER_LAW] = (float)LAW_MINE;
    while (fgets(line, sizeof line, stdin) != NULL) {
        height_track_t *height = &where.supervisor.height;
        const situation_t now = {.parameters = &parameters, .where = &where, .est = &est, .law = LAW_MINE};
        unsigned long gap_us;
        int is_new;

        if (sscanf(line, "%f %f %f %lu %d %f", &where.supervisor.reference_m, &height->height_mm,
                   &height->rate_mm_s, &gap_us, &is_new, &parameters.value[PARAMETER_GRAV]) != 6) {
            memset(&laws, 0, sizeof laws);
            continue;
        }
        height->gap_us = (uint32_t)gap_us;
        height->is_new = is_new != 0;
        height->sequence += is_new != 0 ? 1U : 0U;
        height->time_us += (uint32_t)gap_us;
        laws.setpoint_n = law(&laws, &est, &now);
        printf("%ld %ld\n", thousandths((double)laws.setpoint_n), thousandths((double)laws.pid.integral_n));
    }
}

static void ask_height(height_t height)
{
    char line[QUESTION_MAX];

    while (fgets(line, sizeof line, stdin) != NULL) {
        mirror_geometry_t mirror;
        float slant_mm, roll_mrad, pitch_mrad;

        if (sscanf(line, "%f %f %f %f %f %f %f", &mirror.distance_mm, &mirror.leg_mm, &mirror.arm_mm,
                   &mirror.fore_sign, &slant_mm, &roll_mrad, &pitch_mrad) == 7) {
            const float roll_rad = roll_mrad * 0.001F, pitch_rad = pitch_mrad * 0.001F;

            printf("%ld %ld\n", thousandths((double)height(&mirror, slant_mm, roll_rad, pitch_rad)),
                   thousandths((double)altitude_under_mirror(&mirror, slant_mm, roll_rad, pitch_rad)));
        }
    }
}

int main(int argc, char **argv)
{
    void *answer = argc > 2 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;

    if (answer == NULL) {
        fprintf(stderr, "course_marker: %s\n",
                argc > 2 ? dlerror() : "usage: course_marker ANSWER.so law|height|number|fly ...");
        return 2;
    }
    if (strcmp(argv[2], "height") == 0) {
        ask_height((height_t)named(answer, "student_height"));
    } else if (strcmp(argv[2], "number") == 0 && argc == 4) {
        printf("%ld\n", thousandths((double)*(const float *)named(answer, argv[3])));
    } else if (strcmp(argv[2], "law") == 0) {
        ask_law((law_step_t)named(answer, "law_mine_step"));
    } else if (strcmp(argv[2], "fly") == 0) {
        given_law_set((law_step_t)named(answer, "law_mine_step"));
        return command_fly(argc - 2, argv + 2);
    } else {
        return 2;
    }
    return 0;
}
