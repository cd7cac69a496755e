#include "sim/scenarios/scenarios.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define FLOWN_PID "LAW PID", "RELEASE FREE", "KP 0.015", "KD 0.008", "KI 0.01", "USAT 1", "DSAT 0", "GRAV 7"
#define UNSATURATED "USAT 11.76", "DSAT 11.76"

/* Expectations stand for one flight with any seed; the means over many seeds are pinned in tests/integration. */
const scenario_t scenarios[] = {
    {
        .name = "pid-60cm-ramp",
        .summary = "seed chapter 6: PID at 60 cm over a ramp (7.3-8.0 s) and a 25 cm platform (edge at 11.0 s)",
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
                         {METRIC_UNDERSHOOT_MM, 25, 260},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.38, 0.52}},
    },
    {
        .name = "est-60cm-ramp",
        .summary = "the same course by estimator and cascade",
        .settings = {"LAW EST", "TERRAIN FOLLOW", "PLANT THRUST", "GRAV 7", "POSK 2.25", "VELK 7.2", "VUP 0.5", "VDN 1.3"},
        .reference_m = 0.6,
        .platform = true,
        .land_s = 20.0,
        .end_s = 26.0,
        .fate = FATE_SUCCEEDS,
        .expectation_count = 9,
        .expectations = {{METRIC_RISE_TIME_S, 0.7, 1.4},
                         {METRIC_OVERSHOOT_MM, 0, 50},
                         {METRIC_HOVER_RMS_MM, 5, 20},
                         {METRIC_HOVER_MEAN_ERROR_MM, -10, 10},
                         {METRIC_TERRAIN_RMS_MM, 60, 95},
                         {METRIC_RECOVERY_S, 0.55, 1.05},
                         {METRIC_UNDERSHOOT_MM, 0, 50},
                         {METRIC_GROUND_CONTACTS, 0, 0},
                         {METRIC_THRUST_STD_N, 0.25, 0.55}},
    },
    {
        .name = "pd-35cm",
        .summary = "figure A1.1: saturated PD at 35 cm, oscillates below its reference",
        .settings = {"LAW PD", "RELEASE FREE", "KP 0.01", "KD 0.004", "KI 0", "USAT 1", "DSAT 0", "GRAV 7"},
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
        .summary = "figure A1.3: PID at 40 cm, free of ropes",
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
        .settings = {"LAW PD", "RELEASE FREE", "KP 0.0075", "KD 0", "KI 0", UNSATURATED, "GRAV 7"},
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
        .settings = {"LAW PD", "RELEASE FREE", "KP 0.0075", "KD 0.004", "KI 0", UNSATURATED, "GRAV 7"},
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
        .settings = {"LAW PD", "RELEASE FREE", "KP 0.00466", "KD 0.010", "KI 0", UNSATURATED, "GRAV 7"},
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
        .settings = {"LAW PID", "RELEASE FREE", "KP 0.01", "KD 0.004", "KI 0.001", "USAT 1", "DSAT 0", "GRAV 7"},
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
        .settings = {"LAW PD", "RELEASE FREE", "KP 0.00466", "KD 0.010", "KI 0", UNSATURATED, "GRAV 0"},
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
        .name = "bench",
        .summary = "no flight: the vehicle stands still at --height; for real sensors, and for a look at the start-up",
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
