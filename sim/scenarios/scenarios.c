#include "sim/scenarios/scenarios.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FLOWN_PID \
    "LAW PID", "LAYOUT FRONT", "RELEASE FREE", "KP 0.015", "KD 0.008", "KI 0.01", "USAT 1", "DSAT 0", "GRAV 7"
#define STEP_TEST "LAW EST", "LAYOUT FRONT", "PLANT THRUST", "GRAV 7", "USAT 0", "DSAT 0"
/* The operator arms before the pilot gives him the throttle. */
#define FIELD_DAY_ARM "ARM "
#define UNSATURATED "USAT 11.76", "DSAT 11.76"

/* Expectations stand for one flight with any seed; the means over many seeds are pinned in tests/integration.
 */
const scenario_t scenarios[] = {
    {
        .name = "pid-60cm-ramp",
        .summary =
            "seed chapter 6: PID at 60 cm over a ramp (7.3-8.0 s) and a 25 cm platform (edge at 11.0 s)",
        .settings = {FLOWN_PID},
        .reference_m = 0.6,
        .platform = true,
        .land_s = 20.0,
        .end_s = 26.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 9,
        .expectations = {{METRIC_RISE_TIME_S, 0.9, 2.8},
                         {METRIC_OVERSHOOT_MM, 15, 300},
                         {METRIC_HOVER_RMS_MM, 40, 115},
                         {METRIC_HOVER_MEAN_ERROR_MM, -60, 70},
                         {METRIC_TERRAIN_RMS_MM, 70, 210},
                         {METRIC_RECOVERY_S, 1.5, 3.98},
                         {METRIC_UNDERSHOOT_MM, 10, 260},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.38, 0.52}},
    },
    {
        .name = "est-60cm-ramp",
        .summary = "the same course by estimator and cascade",
        .settings = {"LAW EST", "TERRAIN FOLLOW", "PLANT THRUST", "GRAV 7", "POSK 2.3", "VELK 8", "VUP 0.7",
                     "VDN 1.1"},
        .reference_m = 0.6,
        .platform = true,
        .land_s = 20.0,
        .end_s = 26.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 9,
        .expectations = {{METRIC_RISE_TIME_S, 0.6, 1.0},
                         {METRIC_OVERSHOOT_MM, 0, 50},
                         {METRIC_HOVER_RMS_MM, 5, 20},
                         {METRIC_HOVER_MEAN_ERROR_MM, -10, 10},
                         {METRIC_TERRAIN_RMS_MM, 35, 95},
                         {METRIC_RECOVERY_S, 0.35, 1.05},
                         {METRIC_UNDERSHOOT_MM, 0, 50},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.25, 0.55}},
    },
    {
        .name = "climb-rate",
        .summary = "the same course with an autopilot whose throttle commands a climb rate",
        .settings = {"LAW EST", "TERRAIN FOLLOW", "LAYOUT FRONT", "PLANT CLIMB", "CRATE 1", "GRAV 5.88",
                     "POSK 2.3", "VELK 8", "VUP 0.7", "VDN 1.1"},
        .reference_m = 0.6,
        .platform = true,
        .climb_rate_mps_per_n = 1.0,
        .land_s = 20.0,
        .end_s = 26.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 10,
        .expectations = {{METRIC_RISE_TIME_S, 0.6, 1.0},
                         {METRIC_OVERSHOOT_MM, 5, 60},
                         {METRIC_HOVER_RMS_MM, 5, 18},
                         {METRIC_HOVER_MEAN_ERROR_MM, -6, 10},
                         {METRIC_TERRAIN_RMS_MM, 60, 85},
                         {METRIC_RECOVERY_S, 0.5, 1.6},
                         {METRIC_UNDERSHOOT_MM, 2, 45},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_TOUCH_SPEED_MPS, 0.1, 0.4},
                         {METRIC_TAKEOVERS, 0, 0}},
    },
    {
        .name = "step-thrust",
        .summary = "step test: law PD without a window gives GRAV alone, for 2 s 1 N less; then EST catches "
                   "the vehicle",
        .settings = {STEP_TEST},
        .later = {{11.5, "GRAV", "7.4"}, {12.0, "LAW", "PD"}, {14.0, "GRAV", "6.4"}, {16.0, "LAW", "EST"}},
        .reference_m = 2.5,
        .land_s = 20.0,
        .end_s = 34.0,
        .fate = FATE_EITHER,
        .expectation_count = 4,
        .expectations = {{METRIC_MAX_ERROR_MM, 600, 1800},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_TAKEOVERS, 0, 0},
                         {METRIC_CUTS, 0, 0}},
    },
    {
        .name = "step-climb",
        .summary = "the same step with an autopilot whose throttle commands a climb rate",
        .settings = {STEP_TEST},
        .later = {{11.5, "GRAV", "5.88"}, {12.0, "LAW", "PD"}, {14.0, "GRAV", "4.88"}, {16.0, "LAW", "EST"}},
        .reference_m = 2.5,
        .climb_rate_mps_per_n = 1.0,
        .land_s = 20.0,
        .end_s = 34.0,
        .fate = FATE_EITHER,
        .expectation_count = 4,
        .expectations = {{METRIC_MAX_ERROR_MM, 850, 1300},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_TAKEOVERS, 0, 0},
                         {METRIC_CUTS, 0, 0}},
    },
    {
        .name = "experiment",
        .summary = "climbs and quick doublets of the reference, from which make fit finds the vehicle",
        .settings = {"LAW EST", "PLANT THRUST", "GRAV 7"},
        .later =
            {{2.60, "SETR", "1"},    {3.60, "SETR", "0.4"},  {4.40, "SETR", "0.8"},  {4.75, "SETR", "0.4"},
             {5.10, "SETR", "0.8"},  {5.45, "SETR", "0.4"},  {5.80, "SETR", "1"},    {6.80, "SETR", "0.4"},
             {7.60, "SETR", "0.8"},  {7.95, "SETR", "0.4"},  {8.30, "SETR", "0.8"},  {8.65, "SETR", "0.4"},
             {9.00, "SETR", "1"},    {10.00, "SETR", "0.4"}, {10.80, "SETR", "0.8"}, {11.15, "SETR", "0.4"},
             {11.50, "SETR", "0.8"}, {11.85, "SETR", "0.4"}, {12.20, "SETR", "1"},   {13.20, "SETR", "0.4"},
             {14.00, "SETR", "0.8"}, {14.35, "SETR", "0.4"}, {14.70, "SETR", "0.8"}, {15.05, "SETR", "0.4"},
             {15.40, "SETR", "1"},   {16.40, "SETR", "0.4"}, {17.20, "SETR", "0.8"}, {17.55, "SETR", "0.4"},
             {17.90, "SETR", "0.8"}, {18.25, "SETR", "0.4"}, {18.60, "SETR", "1"},   {19.60, "SETR", "0.4"},
             {20.40, "SETR", "0.8"}, {20.75, "SETR", "0.4"}, {21.10, "SETR", "0.8"}, {21.45, "SETR", "0.4"}},
        .reference_m = 0.6,
        .land_s = 22.0,
        .end_s = 33.0,
        .fate = FATE_EITHER,
        .expectation_count = 3,
        .expectations = {{METRIC_GROUND_CONTACTS, 0, 0}, {METRIC_TAKEOVERS, 0, 0}, {METRIC_CUTS, 0, 0}},
    },
    {
        .name = "pd-35cm",
        .summary = "figure A1.1: saturated PD at 35 cm, oscillates below its reference",
        .settings = {"LAW PD", "LAYOUT FRONT", "RELEASE FREE", "KP 0.01", "KD 0.004", "KI 0", "USAT 1",
                     "DSAT 0", "GRAV 7"},
        .reference_m = 0.35,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.55, 1.9},
                         {METRIC_OVERSHOOT_MM, 10, 250},
                         {METRIC_HOVER_RMS_MM, 48, 115},
                         {METRIC_HOVER_MEAN_ERROR_MM, -80, -8},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.3, 0.5}},
    },
    {
        .name = "pid-40cm",
        .summary = "figure A1.3: PID at 40 cm, its ropes slack all the time",
        .settings = {FLOWN_PID},
        .reference_m = 0.4,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.6, 2.1},
                         {METRIC_OVERSHOOT_MM, 20, 300},
                         {METRIC_HOVER_RMS_MM, 45, 110},
                         {METRIC_HOVER_MEAN_ERROR_MM, -35, 55},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.38, 0.52}},
    },
    {
        .name = "pid-40cm-tugs",
        .summary = "figure A1.3: PID at 40 cm, pulled by its ropes now and then",
        .settings = {FLOWN_PID},
        .reference_m = 0.4,
        .tug_rate_per_s = 0.4,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 5,
        .expectations = {{METRIC_RISE_TIME_S, 0.6, 2.8},
                         {METRIC_OVERSHOOT_MM, 20, 300},
                         {METRIC_HOVER_RMS_MM, 45, 135},
                         {METRIC_HOVER_MEAN_ERROR_MM, -65, 50},
                         {METRIC_THRUST_STD_N, 0.38, 0.52}},
    },
    {
        .name = "p-only-30cm",
        .summary = "Annex I: proportional action alone, bounces on the ground",
        .settings = {"LAW PD", "LAYOUT FRONT", "RELEASE FREE", "KP 0.0075", "KD 0", "KI 0", UNSATURATED,
                     "GRAV 7"},
        .reference_m = 0.3,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.3, 0.6},
                         {METRIC_OVERSHOOT_MM, 120, 420},
                         {METRIC_HOVER_RMS_MM, 100, 230},
                         {METRIC_HOVER_MEAN_ERROR_MM, -80, -10},
                         {METRIC_GROUND_CONTACTS, 1, 12},
                         {METRIC_THRUST_STD_N, 0.6, 1.7}},
    },
    {
        .name = "pd-unsaturated-30cm",
        .summary = "Annex I: best PD before the action was saturated, oscillates widely",
        .settings = {"LAW PD", "LAYOUT FRONT", "RELEASE FREE", "KP 0.0075", "KD 0.004", "KI 0", UNSATURATED,
                     "GRAV 7"},
        .reference_m = 0.3,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.3, 0.65},
                         {METRIC_OVERSHOOT_MM, 80, 360},
                         {METRIC_HOVER_RMS_MM, 60, 210},
                         {METRIC_HOVER_MEAN_ERROR_MM, -90, -30},
                         {METRIC_GROUND_CONTACTS, 0, 7},
                         {METRIC_THRUST_STD_N, 0.3, 1.6}},
    },
    {
        .name = "first-gains",
        .summary = "equation 7: the gains before any test, PD without saturation",
        .settings = {"LAW PD", "LAYOUT FRONT", "RELEASE FREE", "KP 0.00466", "KD 0.010", "KI 0", UNSATURATED,
                     "GRAV 7"},
        .reference_m = 0.3,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_EITHER,
        .expectation_count = 5,
        .expectations = {{METRIC_OVERSHOOT_MM, 0, 120},
                         {METRIC_HOVER_RMS_MM, 65, 135},
                         {METRIC_HOVER_MEAN_ERROR_MM, -130, -60},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.09, 0.32}},
    },
    {
        .name = "first-pid",
        .summary = "Annex I: the first PID, ki 0.001 on the saturated PD's gains",
        .settings = {"LAW PID", "LAYOUT FRONT", "RELEASE FREE", "KP 0.01", "KD 0.004", "KI 0.001", "USAT 1",
                     "DSAT 0", "GRAV 7"},
        .reference_m = 0.4,
        .land_s = 20.0,
        .end_s = 25.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.6, 2.1},
                         {METRIC_OVERSHOOT_MM, 15, 270},
                         {METRIC_HOVER_RMS_MM, 37, 110},
                         {METRIC_HOVER_MEAN_ERROR_MM, -35, 50},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.3, 0.52}},
    },
    {
        .name = "no-feedforward",
        .summary = "Annex I: without gravity feed-forward the vehicle does not lift",
        .settings = {"LAW PD", "LAYOUT FRONT", "RELEASE FREE", "KP 0.00466", "KD 0.010", "KI 0", UNSATURATED,
                     "GRAV 0"},
        .reference_m = 0.4,
        .land_s = 20.0,
        .end_s = 22.0,
        .fate = FATE_FAILS,
        .expectation_count = 4,
        .expectations = {{METRIC_OVERSHOOT_MM, 0, 0},
                         {METRIC_HOVER_RMS_MM, 399, 401},
                         {METRIC_HOVER_MEAN_ERROR_MM, -401, -399},
                         {METRIC_GROUND_CONTACTS, 0, 0}},
    },
    {
        .name = "hover-60s",
        .summary = "PID at 60 cm over flat ground for a minute",
        .settings = {FLOWN_PID},
        .reference_m = 0.6,
        .land_s = 61.0,
        .end_s = 67.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_RISE_TIME_S, 0.9, 2.8},
                         {METRIC_OVERSHOOT_MM, 15, 300},
                         {METRIC_HOVER_RMS_MM, 55, 150},
                         {METRIC_HOVER_MEAN_ERROR_MM, -80, 0},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.37, 0.5}},
    },
    {
        .name = "field-day",
        .summary = "sticks start the motors, hand-over, take-off, landing, take-off again, hand-back in the "
                   "air, pilot's landing",
        .settings = {"SEL NONE", "LAW EST", "TERRAIN FOLLOW", "PLANT THRUST", "GRAV 7", "CRATE 1",
                     FIELD_DAY_ARM},
        .climb_settings = {"PLANT CLIMB", "GRAV 5.88"},
        .later = {{28.0, "SETR", "0.6"}, {38.0, "STOP", "the pilot has it"}},
        .field_day = true,
        .reference_m = 0.6,
        .land_s = 20.0,
        .end_s = 52.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 8,
        .expectations = {{METRIC_RISE_TIME_S, 0.5, 1.2},
                         {METRIC_OVERSHOOT_MM, 0, 80},
                         {METRIC_HOVER_RMS_MM, 3, 30},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_AGAIN_RMS_MM, 3, 40},
                         {METRIC_BY_EYE_RMS_MM, 3, 150},
                         {METRIC_MOTOR_STOPS, 0, 0},
                         {METRIC_MOTORS_AT_END, 0, 0}},
    },
    {
        .name = "stick",
        .summary = "one person: the stick arms, takes off, sets the height and lands; the switch ends it",
        .settings = {"SEL PIN", "STICK PIN", "LAW EST", "TERRAIN FOLLOW", "PLANT THRUST", "GRAV 7",
                     "CRATE 1"},
        .climb_settings = {"PLANT CLIMB", "GRAV 5.88"},
        .plant = {"plant.stick 1"},
        .field_day = true,
        .by_stick = true,
        .reference_m = 0.6,
        .land_s = 20.0,
        .end_s = 34.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 6,
        .expectations = {{METRIC_HOVER_RMS_MM, 3, 100},
                         {METRIC_HOVER_MEAN_ERROR_MM, -90, 90},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_TAKEOVERS, 0, 0},
                         {METRIC_MOTOR_STOPS, 0, 0},
                         {METRIC_MOTORS_AT_END, 0, 0}},
    },
    {
        .name = "battery",
        .summary = "the battery empties: the firmware warns, and lands before the operator does",
        .settings = {"BAT PIN", "LAW EST", "TERRAIN FOLLOW", "PLANT THRUST", "GRAV 7", "CRATE 1"},
        .climb_settings = {"PLANT CLIMB", "GRAV 5.88"},
        .plant = {"plant.battery 1", "plant.battery_charge 0.3", "plant.battery_capacity 2"},
        .reference_m = 0.6,
        .land_s = 90.0,
        .end_s = 95.0,
        .fate = FATE_EITHER,
        .expectation_count = 5,
        .expectations = {{METRIC_ALOFT_S, 40, 70},
                         {METRIC_TOUCH_SPEED_MPS, 0.05, 0.5},
                         {METRIC_LANDED_UNORDERED, 1, 1},
                         {METRIC_TAKEOVERS, 0, 0},
                         {METRIC_CUTS, 0, 0}},
    },
    {
        .name = "bench",
        .summary = "no flight: the vehicle stands still at --height; for real sensors, and for a look at the "
                   "start-up",
        .bench = true,
        .end_s = 30.0,
        .fate = FATE_EITHER,
        .expectation_count = 2,
        .expectations = {{METRIC_SCANS, 175, 205}, {METRIC_SCANS_REJECTED, 0, 0}},
    },
};
const int scenario_count = sizeof scenarios / sizeof scenarios[0];

const scenario_t *scenario_find(const char *name)
{
    for (int i = 0; i < scenario_count; i++) {
        if (strcmp(scenarios[i].name, name) == 0) {
            return &scenarios[i];
        }
    }
    return NULL;
}

double scenario_reference_m(const later_line_t *line)
{
    if (strcasecmp(line->name, "SETR") == 0) {
        return strtod(line->value, NULL);
    }
    return strcasecmp(line->name, "LAND") == 0 || strcasecmp(line->name, "STOP") == 0 ? 0.0 : NAN;
}

bool scenario_met(const scenario_t *scenario, const metrics_t *metrics, const expectation_t **broken)
{
    *broken = NULL;
    for (int i = 0; i < scenario->expectation_count; i++) {
        const expectation_t *e = &scenario->expectations[i];
        double value = metrics->value[e->metric];

        if (!(value >= e->minimum && value <= e->maximum)) {
            *broken = e;
            return false;
        }
    }
    return scenario->fate == FATE_EITHER || metrics->failed == (scenario->fate == FATE_FAILS);
}
