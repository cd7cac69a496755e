/* A real radio and a real IMU on the PC board: here the test is the device at the other end of a
 * pseudo-terminal. */
#define _GNU_SOURCE
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "sim/host/port.h"
#include "unity.h"

static pid_t firmware;
static port_t device;

void setUp(void)
{
    TEST_ASSERT_NULL(port_open_pty(&device, 19200));
}

void tearDown(void)
{
    if (firmware > 0) {
        kill(firmware, SIGKILL);
        waitpid(firmware, NULL, 0);
        firmware = 0;
    }
    port_close(&device);
}

static long now_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static int start(const char *option, const char *duration)
{
    int ends[2];

    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    firmware = fork();
    if (firmware == 0) {
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        execl(PLOMADA, "plomada", "fly", "bench", option, device.name, "--duration", duration, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    return ends[0];
}

static int finish(int out, char *text, size_t size)
{
    size_t count = 0;
    ssize_t got;
    int status;

    while (count < size - 1 && (got = read(out, text + count, size - 1 - count)) > 0) {
        count += (size_t)got;
    }
    text[count] = '\0';
    close(out);
    waitpid(firmware, &status, 0);
    firmware = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static bool hears(const char *text, long patience_ms)
{
    static char heard[20000];
    size_t count = 0;
    long end_ms = now_ms() + patience_ms;
    bool lost = false;

    heard[0] = '\0';
    while (now_ms() < end_ms && !lost && strstr(heard, text) == NULL) {
        struct pollfd watched = {.fd = device.fd, .events = POLLIN};

        poll(&watched, 1, 20);
        count += port_read(&device, (unsigned char *)heard + count, sizeof heard - 1 - count, &lost);
        heard[count] = '\0';
    }
    return strstr(heard, text) != NULL;
}

void test_a_radio_on_a_port_carries_commands_and_telemetry_at_9600(void)
{
    static const char commands[] = "#PING one\n#PING two\n#GET KP\n";
    static char text[40000];
    int out = start("--xbee", "4");

    TEST_ASSERT_TRUE(hears("alt:-", 3000));
    TEST_ASSERT_EQUAL_UINT32(9600, port_rate(&device));
    port_write(&device, (const unsigned char *)commands, strlen(commands));
    TEST_ASSERT_TRUE(hears("OK KP ", 3000));
    TEST_ASSERT_EQUAL_INT(0, finish(out, text, sizeof text));
    TEST_ASSERT_EQUAL_STRING_LEN("alt:", text, 4);
    TEST_ASSERT_NOT_NULL(strstr(text, "\nOK PING one\nOK PING two\nOK KP "));
    TEST_ASSERT_NOT_NULL(strstr(text, "\nOK LASER "));
}

/* 40 frames a second, level. */
static void be_the_imu(long span_ms)
{
    static const char *const frames[2] = {"#A-C=0.00,0.00,256.00\r\n#YPR=10.00,0.50,-0.50\r\n",
                                          "#A-C=0.00,0.00,256.00\r\n#YPR=10.01,0.50,-0.50\r\n"};
    const long begin_ms = now_ms();

    for (long k = 0; k * 25 < span_ms; k++) {
        port_write(&device, (const unsigned char *)frames[k % 2], strlen(frames[k % 2]));
        while (now_ms() < begin_ms + (k + 1) * 25) {
            usleep(2000);
        }
    }
}

/* Of the flags, 2 stands for no fresh attitude. */
void test_an_imu_on_a_port_gives_the_attitude_at_57600(void)
{
    static char text[40000];
    int out = start("--imu", "4");
    const char *last;

    usleep(1500000);
    TEST_ASSERT_EQUAL_UINT32(57600, port_rate(&device));
    be_the_imu(4000);
    TEST_ASSERT_EQUAL_INT(0, finish(out, text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "flags:3\n"));
    last = strstr(text, "\nOK LASER ");
    TEST_ASSERT_NOT_NULL(last);
    TEST_ASSERT_EQUAL_STRING_LEN("flags:1\n", last - 7, 8);
}

void test_a_device_that_goes_away_is_reported_and_the_firmware_goes_on(void)
{
    static char text[40000];
    int out = start("--imu", "2");

    usleep(500000);
    port_close(&device);
    TEST_ASSERT_EQUAL_INT(0, finish(out, text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "\nOK LASER "));
}
