/* Flights of hours, in virtual time. What wraps: the time in microseconds every 71.6 minutes, and negative as
 * a signed number after half of that; the scanner's stamps every 4 h 39 min. One pinned seed: a wrap is no
 * matter of chance. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "unity.h"

static char output[20000];

void setUp(void) {}
void tearDown(void) {}

static void fly(const char *arguments)
{
    char line[512];

    snprintf(line, sizeof line, "fly hover-60s --set LAW=EST --until-down 60 %s 2>&1", arguments);
    child_plomada(line, output, sizeof output);
}

static double figure(const char *name)
{
    char title[64];
    const char *place;

    snprintf(title, sizeof title, " %s ", name); /* behind a blank, or a ! where the scenario wants another */
    place = strstr(output, title);
    TEST_ASSERT_NOT_NULL_MESSAGE(place, output);
    place += strspn(place + strlen(title), " ") + strlen(title);
    TEST_ASSERT_TRUE_MESSAGE(*place != '-' || place[1] != '\n', name);
    return strtod(place, NULL);
}

static void within(const char *name, double least, double most)
{
    const double value = figure(name);
    char message[128];

    snprintf(message, sizeof message, "%s is %g, not %g..%g", name, value, least, most);
    TEST_ASSERT_TRUE_MESSAGE(value >= least && value <= most, message);
}

/* Of what told the truth. How often law EST does, over seeds: docs/reliability.md, hours of hover. */
static void doubts_nothing(void)
{
    within("sight_doubts", 0.0, 0.0);
    within("imu_doubts", 0.0, 0.0);
    within("thrust_doubts", 0.0, 0.0);
}

/* Five hours: four wraps of the microseconds, one of the stamps, which drift away from true time by 0.9 s. */
void test_five_hours_of_hover_end_on_the_ground_though_radio_and_scanner_are_lost(void)
{
    fly("--duration 18000 --set plant.clock_ppm=50 --set LINK=10 --set plant.radio_lost_start=17985 "
        "--set plant.scanner_restart_start=17997");
    within("hover_rms_mm", 5.0, 12.0);
    within("hover_mean_error_mm", -5.0, 5.0);
    within("max_error_mm", 20.0, 601.0);
    within("highest_mm", 0.0, 80.0);
    within("ground_contacts", 0.0, 1.0); /* down before the landing command: the touch counts */
    within("scans_rejected", 0.0, 0.0);
    within("off_aloft", 0.0, 0.0);
    within("touch_speed_mps", 0.05, 0.8);
    within("down_s", 0.0, 10.0);
    within("stopped_s", 0.0, 30.0);
    within("flagged_s", 0.5, 20.0);
    doubts_nothing(); /* lost are the link, which is no source, and the scanner when it is on its way down */
    within("landed_unordered", 0.0, 1.0); /* by the lost link, 5 s before the order */
}

static const char *nth_field(const char *line, int column)
{
    for (; column > 0; column--) {
        line = strchr(line, ',') + 1;
    }
    return line;
}

static int column_of(const char *header, const char *name)
{
    int column = 0;

    for (const char *field = header; strncmp(field, name, strlen(name)) != 0 || field[strlen(name)] != ',';
         column++) {
        field = strchr(field, ',');
        TEST_ASSERT_NOT_NULL_MESSAGE(field, name);
        field++;
    }
    return column;
}

/* Of the height, in the log from one time to another. */
static double rms_mm(const char *name, double from_s, double to_s)
{
    double sum = 0.0;
    long count = 0;
    char line[256];
    FILE *log = fopen(name, "r");

    TEST_ASSERT_NOT_NULL_MESSAGE(log, name);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, log));
    const int height = column_of(line, "height_m");
    while (fgets(line, sizeof line, log) != NULL) {
        const double t_s = strtod(line, NULL);
        if (t_s > from_s && t_s < to_s) {
            const double error_mm = 1000.0 * (strtod(nth_field(line, height), NULL) - 0.6);

            sum += error_mm * error_mm;
            count++;
        }
    }
    fclose(log);
    remove(name);
    TEST_ASSERT_EQUAL_INT(lround(100.0 * (to_s - from_s)) - 1, count);
    return sqrt(sum / (double)count);
}

/* Without frames for longer than half a wrap of the clock, flown by PIDT, and then again by the estimator, as
 * well as before. */
void test_an_imu_that_was_silent_for_40_minutes_is_flown_by_as_before(void)
{
    fly("--duration 3000 --set plant.sag=0 --set plant.imu_mute_start=60 --set plant.imu_mute=2400 --csv "
        "silent.csv");
    within("off_aloft", 0.0, 0.0);
    within("highest_mm", 0.0, 300.0);
    within("flagged_s", 2390.0, 2410.0);
    doubts_nothing(); /* what is silent is missed, not doubted */
    within("landed_unordered", 0.0, 0.0);
    within("touch_speed_mps", 0.05, 0.6);
    within("stopped_s", 0.0, 15.0);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 10.0, rms_mm(SCRATCH "/silent.csv", 2600.0, 2990.0));
}
