/* A URG-04LX on Serial1: the distance straight ahead, ten times a second, on Serial. Needs a board with a second serial
 * port and a converter between RS232 (the sensor) and the board's level. */
#include <plomada_scip.h>

#define FIRST_STEP 367  /* 384 is straight ahead; 1024 steps make a turn */
#define LAST_STEP 401
#define POINTS (LAST_STEP - FIRST_STEP + 1)

static urg_driver_t urg;
static uint16_t points[2 * POINTS]; /* two scans: one is used while the next comes in */
static uint32_t stepped_us;

static void show_scan()
{
    const scip_group_t ahead = { FIRST_STEP, LAST_STEP };
    scip_scan_t scan;

    if (urg_take_scan(&urg, &scan)) {
        const scip_group_mean_t mean = scip_group_mean(&scan, &ahead);
        Serial.println(mean.valid ? mean.mean_mm : -1.0);
    }
}

static void send()
{
    urg_output_t output;

    if (urg_next_to_send(&urg, &output)) {
        if (output.set_rate) {
            Serial1.begin(output.rate);
        }
        Serial1.write(output.octets, output.count);
    }
}

void setup()
{
    urg_config_t config = {};

    config.wait_us = 0;             /* it may boot still: the search finds it as soon as it listens */
    config.first_rate = 19200;      /* as delivered */
    config.stream_rate = config.fastest_rate = 115200;
    config.stream = SCIP_STREAM_2;
    config.range.first_step = FIRST_STEP;
    config.range.last_step = LAST_STEP;
    config.range.cluster = 1;
    Serial.begin(115200);
    Serial1.begin(config.first_rate);
    if (!urg_init(&urg, &config, points, 2 * POINTS, micros())) {
        Serial.println("The sensor cannot do this.");
    }
}

void loop()
{
    while (Serial1.available() > 0) {
        const octet_t octet = (octet_t)Serial1.read();
        if (urg_feed(&urg, &octet, 1)) {
            urg_scan_at(&urg, micros());
            show_scan();
        }
    }
    if (micros() - stepped_us >= urg_pause_us(&urg)) {
        stepped_us = micros();
        urg_step(&urg, stepped_us);
        send();
    }
}
