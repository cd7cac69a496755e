#include "tfmini.h"

#include <string.h>

#include "unity.h"

static tfmini_t sensor;
static uint32_t now_us;
static int readings;

void setUp(void)
{
    memset(&sensor, 0, sizeof sensor);
    now_us = UINT32_C(4294960000); /* wraps soon */
    readings = 0;
}

void tearDown(void) {}

static void feed(const octet_t *octets, int count)
{
    for (int i = 0; i < count; i++) {
        now_us += 87U;
        readings += tfmini_feed(&sensor, octets[i], now_us);
    }
}

static void finish(octet_t *frame, int count)
{
    unsigned sum = 0U;

    for (int i = 0; i < count - 1; i++) {
        sum += frame[i];
    }
    frame[count - 1] = octet_of((uint16_t)sum);
}

static void read_of(unsigned distance, unsigned strength)
{
    octet_t frame[9] = {0x59,
                        0x59,
                        octet_of((uint16_t)distance),
                        octet_of((uint16_t)(distance >> 8)),
                        octet_of((uint16_t)strength),
                        octet_of((uint16_t)(strength >> 8)),
                        0x60,
                        0x09,
                        0};

    now_us += 9217U;
    finish(frame, 9);
    feed(frame, 9);
}

static void confirm(void)
{
    static const octet_t reply[] = {0x5A, 0x05, 0x05, 0x06, 0x6A};

    feed(reply, 5);
}

void test_the_order_has_the_sums_of_its_two_commands(void)
{
    octet_t format[5], save[4];

    for (int i = 0; i < 5; i++) {
        format[i] = octet_of((uint16_t)tfmini_order[i]);
    }
    for (int i = 0; i < 4; i++) {
        save[i] = octet_of((uint16_t)tfmini_order[5 + i]);
    }
    finish(format, 5);
    finish(save, 4);
    TEST_ASSERT_EQUAL_HEX8(0x6A, format[4]);
    TEST_ASSERT_EQUAL_HEX8(0x6F, save[3]);
}

void test_a_reading_counts_when_the_sensor_has_repeated_the_order(void)
{
    read_of(705, 1000);
    TEST_ASSERT_EQUAL_INT(0, readings);
    confirm();
    read_of(705, 1000);
    TEST_ASSERT_EQUAL_INT(1, readings);
    TEST_ASSERT_TRUE(sensor.seen);
    TEST_ASSERT_EQUAL_UINT16(705U, sensor.distance_mm);
}

void test_another_reply_confirms_nothing(void)
{
    static const octet_t centimetres[] = {0x5A, 0x05, 0x05, 0x01, 0x65};

    feed(centimetres, 5);
    read_of(705, 1000);
    TEST_ASSERT_EQUAL_INT(0, readings);
}

void test_what_is_not_reliable_is_a_reading_without_a_distance(void)
{
    static const unsigned bad[][2] = {{705, 99},  {705, 65535},  {0, 1000},
                                      {99, 1000}, {12001, 1000}, {65535, 1000}};
    static const unsigned good[][2] = {{705, 100}, {705, 65534}, {100, 1000}, {12000, 1000}};

    confirm();
    for (int i = 0; i < 6; i++) {
        read_of(bad[i][0], bad[i][1]);
        TEST_ASSERT_FALSE(sensor.seen);
    }
    for (int i = 0; i < 4; i++) {
        read_of(good[i][0], good[i][1]);
        TEST_ASSERT_TRUE(sensor.seen);
    }
    TEST_ASSERT_EQUAL_INT(10, readings);
}

void test_no_single_damaged_octet_makes_a_reading(void)
{
    for (int at = 0; at < 9; at++) {
        for (unsigned bit = 0U; bit < 8U; bit++) {
            octet_t frame[9] = {0x59, 0x59, 0xC1, 0x02, 0xE8, 0x03, 0x60, 0x09, 0};

            setUp();
            confirm();
            finish(frame, 9);
            frame[at] ^= octet_of((uint16_t)(1U << bit));
            feed(frame, 9);
            TEST_ASSERT_EQUAL_INT(0, readings);
        }
    }
}

void test_it_finds_the_frames_again_after_any_octets(void)
{
    for (unsigned before = 0U; before < 256U; before++) {
        const octet_t rubbish[] = {0x59, octet_of((uint16_t)before), 0x5A, 0x59, 0x59};

        setUp();
        confirm();
        feed(rubbish, 5);
        for (int i = 0; i < 4; i++) {
            read_of(705, 1000);
        }
        TEST_ASSERT_TRUE(readings >= 2);
        TEST_ASSERT_EQUAL_UINT16(705U, sensor.distance_mm);
    }
}

void test_it_begins_anew_when_octets_were_lost(void)
{
    static const octet_t half[] = {0x59, 0x59, 0xC1, 0x02};

    confirm();
    feed(half, 4);
    TEST_ASSERT_EQUAL_UINT16(5U, tfmini_expected(&sensor));
    tfmini_line_broken(&sensor);
    TEST_ASSERT_EQUAL_UINT16(9U, tfmini_expected(&sensor));
    read_of(705, 1000);
    TEST_ASSERT_EQUAL_INT(1, readings);
    TEST_ASSERT_EQUAL_UINT32(0U, sensor.damaged);
}

/* Its supply may have failed, and its order with it. */
void test_a_sensor_that_was_silent_must_repeat_the_order_again(void)
{
    confirm();
    now_us += 40000U;
    read_of(705, 1000);
    TEST_ASSERT_EQUAL_INT(1, readings);
    now_us += 50000U;
    read_of(71, 1000);
    TEST_ASSERT_EQUAL_INT(1, readings);
    TEST_ASSERT_FALSE(sensor.millimetres);
    confirm();
    tfmini_watch(&sensor, now_us + 50001U);
    TEST_ASSERT_FALSE(sensor.millimetres);
}
