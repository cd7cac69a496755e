/* plomada laser: the scanner model on a pseudo-terminal, for a bare SCIP client, for plomada scip record, and
 * for the firmware itself. Paced by the wall clock. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "child.h"
#include "sim/host/port.h"
#include "unity.h"

#define LINK SCRATCH "/urg"

static pid_t server;
static port_t client;

void setUp(void)
{
    client.fd = client.slave = -1;
    unlink(LINK);
}

static int end_server(int signal_number)
{
    int status = -1;

    kill(server, signal_number);
    waitpid(server, &status, 0);
    server = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void tearDown(void)
{
    port_close(&client);
    if (server > 0) {
        end_server(SIGKILL);
    }
    unlink(LINK);
}

static long now_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static bool is_link(void)
{
    struct stat status;

    return lstat(LINK, &status) == 0 && S_ISLNK(status.st_mode);
}

/* The server's first line is there: it serves. */
static bool has_begun(void)
{
    struct stat status;

    return stat(SCRATCH "/laser.out", &status) == 0 && status.st_size > 10;
}

static void begin(const char *a, const char *b, const char *c, const char *d)
{
    const long end_ms = now_ms() + 10000;

    unlink(SCRATCH "/laser.out");
    server = fork();
    if (server == 0) {
        const int out = open(SCRATCH "/laser.out", O_WRONLY | O_CREAT | O_TRUNC, 0644);

        dup2(out, 1);
        dup2(out, 2);
        execl(PLOMADA, "plomada", "laser", "--link", LINK, a, b, c, d, (char *)NULL);
        _exit(127);
    }
    while (!has_begun() && now_ms() < end_ms) {
        usleep(5000);
    }
    TEST_ASSERT_TRUE_MESSAGE(has_begun() && is_link(), "no link");
}

static void start(const char *a, const char *b, const char *c, const char *d, unsigned long rate)
{
    begin(a, b, c, d);
    TEST_ASSERT_NULL(port_open_device(&client, LINK, rate));
}

static char heard[100000];
static size_t heard_count;

/* Octets at a wrong rate may be NUL, so this is no string. */
static bool hears(const char *text)
{
    return memmem(heard, heard_count, text, strlen(text)) != NULL;
}

static void listen_ms(long patience_ms, const char *until)
{
    const long end_ms = now_ms() + patience_ms;
    bool lost = false;

    heard_count = 0;
    heard[0] = '\0';
    while (now_ms() < end_ms && !lost && (until == NULL || !hears(until))) {
        struct pollfd watched = {.fd = client.fd, .events = POLLIN};

        poll(&watched, 1, 20);
        heard_count += port_read(&client, (unsigned char *)heard + heard_count,
                                 sizeof heard - 1 - heard_count, &lost);
        heard[heard_count] = '\0';
    }
}

static void say(const char *text)
{
    port_write(&client, (const unsigned char *)text, strlen(text));
}

static void answers(const char *command, const char *reply)
{
    say(command);
    listen_ms(3000, reply);
    TEST_ASSERT_EQUAL_STRING(reply, heard);
}

/* ---- a bare client ---- */

void test_a_client_talks_both_protocols_and_is_corrected(void)
{
    start(NULL, NULL, NULL, NULL, 115200);
    answers("QT\n", "QT\nE\n\n");
    answers("L0\n", "L0\n0\n\n");
    answers("scip2.0\n", "scip2.0\nE\n\n");
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
    answers("SCIP2.0\n", "SCIP2.0\n0Ee\n\n");
    answers("MS0372\n", "MS0372\n0Cc\n\n");
    answers("MS0372076901000\n", "MS0372076901000\n04T\n\n");
    answers("MSx372040601000\n", "MSx372040601000\n01Q\n\n");
    answers("QT;$\n", "QT;$\n0Hh\n\n");
    answers("GS0384038401\n", "GS0384038401\n10Q\n\n");
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
}

void test_the_rate_follows_ss_and_a_client_that_does_not_follow_hears_nonsense(void)
{
    static char report[4000];

    start("--height", "0.4", NULL, NULL, 115200);
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
    answers("SS250000\n", "SS250000\n00P\n\n");
    say("QT\n");
    listen_ms(300, NULL);
    TEST_ASSERT_EQUAL_size_t(0, heard_count);
    TEST_ASSERT_NULL(port_set_rate(&client, 250000));
    answers("QT\n", "QT\n00P\n\n");
    say("MS0372040601000\n");
    listen_ms(3000, "99b\n");
    TEST_ASSERT_TRUE(hears("99b\n"));
    TEST_ASSERT_NULL(port_set_rate(&client, 115200));
    listen_ms(200, NULL);
    listen_ms(400, NULL);
    TEST_ASSERT_TRUE(heard_count > 150);
    TEST_ASSERT_FALSE(hears("99b\n"));
    TEST_ASSERT_NULL(port_set_rate(&client, 250000));
    listen_ms(2000, "99b\n");
    TEST_ASSERT_TRUE(hears("99b\n"));
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGINT));
    child_read_file("laser.out", report, sizeof report);
    TEST_ASSERT_NOT_NULL(strstr(report, "at another rate: 3 octets ignored"));
    TEST_ASSERT_NULL(strstr(report, " 0 sent as nonsense"));
}

void test_the_power_up_rate_is_the_one_asked_for(void)
{
    start("--rate", "19200", NULL, NULL, 19200);
    TEST_ASSERT_EQUAL_UINT32(19200, port_rate(&client));
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
}

/* The pseudo-terminal itself has the power-up rate, for clients that set none. */
void test_a_client_that_sets_no_rate_is_understood(void)
{
    begin("--rate", "57600", NULL, NULL);
    client.fd = open(LINK, O_RDWR | O_NOCTTY | O_NONBLOCK);
    TEST_ASSERT_TRUE(client.fd >= 0);
    TEST_ASSERT_EQUAL_UINT32(57600, port_rate(&client));
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
}

void test_faults_strike_by_position(void)
{
    start("--fault", "drop@1", "--fault", "dup@9", 115200);
    answers("L0\n", "L\n0\n\n");
    answers("QT\n", "QT\nEE\n\n");
}

/* The times at which read() finds something, until a quiet time. */
static size_t reads_until_quiet(long quiet_ms, long at_ms[], size_t octets[], size_t room)
{
    size_t count = 0;
    bool lost = false;
    struct pollfd watched = {.fd = client.fd, .events = POLLIN};

    while (count < room && poll(&watched, 1, (int)quiet_ms) > 0 && !lost) {
        unsigned char part[4096];

        at_ms[count] = now_ms();
        octets[count++] = port_read(&client, part, sizeof part, &lost);
    }
    return count;
}

/* The answer of 21 octets, then a frame of 1435: 22 packets of 64 and one of 27. */
void test_packets_have_64_octets_and_the_last_one_of_a_reply_comes_at_its_end(void)
{
    static long at_ms[3000];
    static size_t octets[3000];
    size_t count, total = 0;

    start("--burst", NULL, NULL, NULL, 115200);
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
    say("MS0044072501001\n");
    count = reads_until_quiet(500, at_ms, octets, 3000);
    TEST_ASSERT_TRUE(count <= 24);
    for (size_t i = 0; i < count; i++) {
        total += octets[i];
        TEST_ASSERT_TRUE_MESSAGE(total == 21 || total == 21 + 1435 || (total - 21) % 64 == 0,
                                 "part of a packet");
    }
    TEST_ASSERT_EQUAL_size_t(21 + 1435, total);
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
}

/* 682 steps: 227 clusters of 3 and a step. 2 n characters in blocks of 64, 27 octets besides. */
void test_steps_that_fill_no_cluster_make_a_point_or_none(void)
{
    static const char *const options[] = {NULL, "--round-down"};
    static const size_t frame[] = {27 + 2 * 228 + 2 * 8, 27 + 2 * 227 + 2 * 8};
    static long at_ms[3000];
    static size_t octets[3000];

    for (int i = 0; i < 2; i++) {
        size_t count, total = 0;

        start("--burst", options[i], NULL, NULL, 115200);
        answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
        say("MS0044072503001\n");
        count = reads_until_quiet(500, at_ms, octets, 3000);
        for (size_t k = 0; k < count; k++) {
            total += octets[k];
        }
        TEST_ASSERT_EQUAL_size_t(21 + frame[i], total);
        TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
    }
}

/* Programs for the sensor's own USB port take a short reply by one read(). */
void test_a_short_reply_comes_in_one_packet_at_any_rate(void)
{
    static long at_ms[10];
    static size_t octets[10];

    start("--burst", "--rate", "19200", NULL, 19200);
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
    answers("TM0\n", "TM0\n00P\n\n");
    for (int i = 0; i < 8; i++) {
        say("TM1\n");
        TEST_ASSERT_EQUAL_size_t(1, reads_until_quiet(40, at_ms, octets, 10));
        TEST_ASSERT_EQUAL_size_t(15, octets[0]);
    }
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
}

void test_without_packets_octets_come_as_they_leave_the_sensor(void)
{
    static long at_ms[3000];
    static size_t octets[3000];

    start("--rate", "19200", NULL, NULL, 19200);
    answers("SCIP2.0\n", "SCIP2.0\n0\n\n");
    say("MS0044072501001\n"); /* 0.5 ms an octet */
    TEST_ASSERT_TRUE(reads_until_quiet(500, at_ms, octets, 3000) > 200);
}

/* ---- the link ---- */

void test_the_link_leads_to_the_terminal_and_both_signals_remove_it(void)
{
    static const int signals[] = {SIGINT, SIGTERM};
    char target[128] = "", line[256];

    for (int i = 0; i < 2; i++) {
        begin(NULL, NULL, NULL, NULL);
        TEST_ASSERT_TRUE(readlink(LINK, target, sizeof target - 1) > 0);
        TEST_ASSERT_EQUAL_STRING_LEN("/dev/pts/", target, 9);
        TEST_ASSERT_EQUAL_INT(0, end_server(signals[i]));
        TEST_ASSERT_FALSE(is_link());
        child_read_file("laser.out", line, sizeof line);
        TEST_ASSERT_EQUAL_STRING_LEN("laser: /dev/pts/", line, 16);
    }
}

void test_the_link_of_a_killed_server_is_replaced(void)
{
    begin(NULL, NULL, NULL, NULL);
    end_server(SIGKILL);
    TEST_ASSERT_TRUE(is_link());
    start(NULL, NULL, NULL, NULL, 115200);
    answers("L0\n", "L0\n0\n\n");
}

void test_the_link_of_a_server_that_runs_is_left_to_it(void)
{
    char output[1000];

    start(NULL, NULL, NULL, NULL, 115200);
    TEST_ASSERT_EQUAL_INT(2, child_plomada("laser --link '" LINK "' 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL(strstr(output, "is in use by another program"));
    TEST_ASSERT_TRUE(is_link());
    answers("L0\n", "L0\n0\n\n");
}

void test_a_link_that_leads_nowhere_is_replaced(void)
{
    TEST_ASSERT_EQUAL_INT(0, symlink("/no/such/thing", LINK));
    begin(NULL, NULL, NULL, NULL);
    TEST_ASSERT_EQUAL_INT(0, access(LINK, F_OK));
}

void test_anything_else_in_the_links_place_is_left_alone(void)
{
    char output[1000];
    FILE *file = fopen(LINK, "w");

    fputs("precious", file);
    fclose(file);
    TEST_ASSERT_EQUAL_INT(2, child_plomada("laser --link '" LINK "' 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL(strstr(output, "File exists"));
    TEST_ASSERT_EQUAL_size_t(8, child_read_file("urg", output, sizeof output));
    unlink(LINK);
    TEST_ASSERT_EQUAL_INT(0, symlink("/dev/null", LINK));
    TEST_ASSERT_EQUAL_INT(2, child_plomada("laser --link '" LINK "' 2>&1", output, sizeof output));
    TEST_ASSERT_TRUE(is_link());
}

void test_usage_errors_exit_2_and_help_tells_of_every_fault(void)
{
    static const char *const bad[] = {
        "laser",
        "laser x",
        "laser --link",
        "laser --link '" LINK "' --rate 38400",
        "laser --link '" LINK "' --rate x",
        "laser --link '" LINK "' --height -1",
        "laser --link '" LINK "' --fault drop",
        "laser --link '" LINK "' --seed x",
        "laser --link /no/such/directory/urg",
        "laser --link '" LINK "' more",
        "laser --bogus",
    };
    static char output[10000], command[256];

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        snprintf(command, sizeof command, "%s 2>&1", bad[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, child_plomada(command, output, sizeof output), bad[i]);
        TEST_ASSERT_FALSE(is_link());
    }
    TEST_ASSERT_EQUAL_INT(0, child_plomada("laser --help", output, sizeof output));
    TEST_ASSERT_NOT_NULL(strstr(output, "status@N:CODE"));
    TEST_ASSERT_NOT_NULL(strstr(output, "TCSETS2"));
}

/* ---- record ---- */

/* Every octet of both directions is in the table once, in order. */
static void check_time_table(const char *table, long rx_octets, long tx_octets)
{
    long expected[2] = {0, 0};
    long long last_us = 0;

    TEST_ASSERT_EQUAL_STRING_LEN("dir,t_us,offset,length\n", table, 23);
    for (const char *p = strchr(table, '\n') + 1; *p != '\0'; p = strchr(p, '\n') + 1) {
        char dir[3];
        long long t_us;
        long offset, length;
        int tx;

        TEST_ASSERT_EQUAL_INT(4, sscanf(p, "%2[rtx],%lld,%ld,%ld\n", dir, &t_us, &offset, &length));
        tx = dir[0] == 't';
        TEST_ASSERT_EQUAL_INT64(expected[tx], offset);
        TEST_ASSERT_TRUE(length > 0 && t_us >= last_us);
        expected[tx] += length;
        last_us = t_us;
    }
    TEST_ASSERT_EQUAL_INT64(rx_octets, expected[0]);
    TEST_ASSERT_EQUAL_INT64(tx_octets, expected[1]);
    TEST_ASSERT_TRUE(last_us > 1000000);
}

/* The scan that was on the line when the recording ended is in it too, and was not counted. At this rate the
 * line hardly rests. */
void test_a_recording_tells_as_many_scans_as_are_read_from_it(void)
{
    static char text[200000];
    char told[40];

    begin("--height", "0.4", "--rate", "57600");
    TEST_ASSERT_EQUAL_INT(0, child_plomada("scip record '" LINK
                                           "' slow.bin --force --seconds 1 --rate 57600 2>&1",
                                           text, sizeof text));
    const char *scans = strstr(text, "\nscans: ");
    TEST_ASSERT_NOT_NULL_MESSAGE(scans, text);
    snprintf(told, sizeof told, "%.*s\n", (int)strcspn(scans + 1, "\n"), scans + 1);
    TEST_ASSERT_EQUAL_INT(0, child_plomada("scip decode slow.bin 2>&1 >slow.csv", text, sizeof text));
    TEST_ASSERT_EQUAL_STRING_LEN(told, text, strlen(told));
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
}

void test_a_recording_at_the_fastest_rate(void)
{
    static char text[200000];

    begin("--height", "0.4", NULL, NULL);
    TEST_ASSERT_EQUAL_INT(0, child_plomada("scip record '" LINK
                                           "' fast.bin --force --seconds 1 --rate 750000 2>&1",
                                           text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "damaged: 0\n"));
    child_read_file("fast.bin.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "| rate of the stream | 750000 bit/s, 10.0"));
    TEST_ASSERT_EQUAL_INT(0, end_server(SIGTERM));
}

void test_a_recording_is_whole_and_has_its_birth_certificate(void)
{
    static char text[200000], octets[200000];
    size_t rx, tx;

    begin("--height", "0.4", "--rate", "57600");
    TEST_ASSERT_EQUAL_INT(0, child_plomada("scip record '" LINK
                                           "' live.bin --force --seconds 2 --rate 250000 2>&1",
                                           text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "damaged: 0\n"));
    rx = child_read_file("live.bin", octets, sizeof octets);
    TEST_ASSERT_TRUE(rx > 15 * 1435);
    TEST_ASSERT_NOT_NULL(strstr(octets, "MS0044072501000\n00P\n\n"));
    tx = child_read_file("live.bin.tx", octets, sizeof octets);
    TEST_ASSERT_NOT_NULL(strstr(octets, "SS250000\n"));
    child_read_file("live.bin.csv", text, sizeof text);
    check_time_table(text, (long)rx, (long)tx);
    child_read_file("live.bin.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "# live.bin: birth certificate\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "FIRM:3.1.04(02/Aug./2007)\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "SERI:H0706400\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "DMAX:5600\n"));
    TEST_ASSERT_NOT_NULL(strstr(text, "| rate of the stream | 250000 bit/s, 10.0"));
    TEST_ASSERT_NULL(strstr(text, "Cut off"));
    TEST_ASSERT_NOT_NULL(strstr(text, " UTC, from `" LINK "` |"));
    TEST_ASSERT_EQUAL_INT(
        0, child_plomada("scip decode live.bin 2>/dev/null | grep -c '^[0-9]'", text, sizeof text));
    TEST_ASSERT_TRUE(atoi(text) >= 18);
    TEST_ASSERT_EQUAL_INT(0,
                          child_plomada("scip mirrors live.bin --height 0.4 2>/dev/null", text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "\n#LAYOUT THREE\n#S1 128\n#SF 389\n#S2 640\n#SW 17\n"));
}

static pid_t start_recorder(const char *name, const char *before)
{
    const pid_t recorder = fork();

    if (recorder == 0) {
        char command[1024];

        snprintf(command, sizeof command,
                 "%s exec '" PLOMADA "' scip record '" LINK "' '" SCRATCH
                 "/%s' --seconds 600 --steps 372..406 --force 2>'" SCRATCH "/%s.err'",
                 before, name, name);
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    return recorder;
}

static int end_recorder(pid_t recorder, int signal_number)
{
    int status = 0;

    if (signal_number != 0) {
        kill(recorder, signal_number);
    }
    waitpid(recorder, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void test_ctrl_c_ends_a_recording_in_good_order(void)
{
    static char text[100000];
    pid_t recorder;

    begin(NULL, NULL, NULL, NULL);
    recorder = start_recorder("cut.bin", "");
    usleep(1800000);
    TEST_ASSERT_EQUAL_INT(0, end_recorder(recorder, SIGINT));
    child_read_file("cut.bin.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "SERI:H0706400\n"));
    TEST_ASSERT_NULL(strstr(text, "Cut off"));
}

/* Octets that the time table and the recording both hold are whole; it began at most a second before the end.
 */
static void is_cut_at_most(const char *name, double lasted_s, double lost_s)
{
    static char table[200000], octets[200000];
    char path[64];
    long rx;
    double last_s = 0.0;

    snprintf(path, sizeof path, "%s.csv", name);
    child_read_file(path, table, sizeof table);
    rx = (long)child_read_file(name, octets, sizeof octets);
    for (const char *p = strchr(table, '\n') + 1; *p != '\0' && strchr(p, '\n') != NULL;
         p = strchr(p, '\n') + 1) {
        char dir[3];
        long long t_us;
        long offset, length;

        TEST_ASSERT_EQUAL_INT(4, sscanf(p, "%2[rtx],%lld,%ld,%ld\n", dir, &t_us, &offset, &length));
        last_s = (double)t_us * 1e-6;
        TEST_ASSERT_TRUE(dir[0] == 't' || offset + length <= rx);
    }
    TEST_ASSERT_TRUE_MESSAGE(last_s > lasted_s - lost_s, table);
}

void test_a_killed_recorder_has_lost_its_last_second_at_most(void)
{
    static char text[4000];
    pid_t recorder;
    long begun_ms;

    begin(NULL, NULL, NULL, NULL);
    begun_ms = now_ms();
    recorder = start_recorder("killed.bin", "");
    usleep(3700000);
    TEST_ASSERT_EQUAL_INT(-1, end_recorder(recorder, SIGKILL));
    /* 0.4 s: the program's own start, the wait for the next octet, a busy machine */
    is_cut_at_most("killed.bin", (double)(now_ms() - begun_ms) * 1e-3, 1.4);
    child_read_file("killed.bin.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "Cut off"));
    child_read_file("killed.bin.err", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, " scans/s, "));
    TEST_ASSERT_NOT_NULL(strstr(text, ": 10.0 scans/s, "));
}

/* A file may not grow beyond two blocks of 512 octets: as on a full disk, writing fails from there on. */
void test_a_full_disk_ends_the_recording_with_what_there_was(void)
{
    static char text[4000];

    begin(NULL, NULL, NULL, NULL);
    TEST_ASSERT_EQUAL_INT(2, end_recorder(start_recorder("full.bin", "trap '' XFSZ; ulimit -f 2;"), 0));
    child_read_file("full.bin.err", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "File too large"), text);
    TEST_ASSERT_NOT_NULL(strstr(text, "not written whole"));
    TEST_ASSERT_TRUE(child_read_file("full.bin", text, sizeof text) >= 1000);
}

void test_a_port_that_goes_away_ends_the_recording_with_1(void)
{
    static char text[4000];
    pid_t recorder;

    begin(NULL, NULL, NULL, NULL);
    recorder = start_recorder("gone.bin", "");
    usleep(2500000);
    end_server(SIGTERM);
    TEST_ASSERT_EQUAL_INT(1, end_recorder(recorder, 0));
    child_read_file("gone.bin.err", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "the port is gone"));
    child_read_file("gone.bin.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "Cut off"));
    TEST_ASSERT_NOT_NULL(strstr(text, "| rate of the stream | 115200 bit/s, 10.0"));
}

void test_a_recording_is_never_overwritten_unless_forced(void)
{
    static const char *const names[] = {"kept", "kept.tx", "kept.csv", "kept.md"};
    static char text[4000];

    begin(NULL, NULL, NULL, NULL);
    for (int i = 0; i < 4; i++) {
        char command[256];

        snprintf(command, sizeof command, "true; cd '" SCRATCH "' && rm -f kept* && echo precious >%s",
                 names[i]);
        TEST_ASSERT_EQUAL_INT(0, system(command));
        TEST_ASSERT_EQUAL_INT(
            2, child_plomada("scip record '" LINK "' kept --seconds 0.3 2>&1", text, sizeof text));
        TEST_ASSERT_NOT_NULL(strstr(text, names[i]));
        TEST_ASSERT_NOT_NULL(strstr(text, "--force"));
        child_read_file(names[i], text, sizeof text);
        TEST_ASSERT_EQUAL_STRING("precious\n", text);
        TEST_ASSERT_EQUAL_INT(0, system("test $(ls '" SCRATCH "' | grep -c '^kept') = 1"));
    }
    TEST_ASSERT_EQUAL_INT(
        0, child_plomada("scip record '" LINK "' kept --seconds 0.3 --force 2>&1", text, sizeof text));
    child_read_file("kept.md", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "# kept: birth certificate"));
}

/* A pseudo-terminal tells no framing errors: octets above 7FH must be enough. */
void test_a_stream_at_250000_is_found_within_a_second_by_a_port_that_tells_no_framing_errors(void)
{
    static char text[200000];
    double first_s = 1e9;
    pid_t recorder;

    begin(NULL, NULL, NULL, NULL);
    TEST_ASSERT_EQUAL_INT(0, child_plomada("scip record '" LINK
                                           "' a.bin --force --seconds 0.5 --rate 250000 --steps "
                                           "372..406 2>&1; true",
                                           text, sizeof text));
    TEST_ASSERT_NULL(port_open_device(&client, LINK, 250000));
    answers("QT\n", "QT\n00P\n\n");
    say("MS0372040601000\n");
    port_close(&client);
    recorder = fork();
    if (recorder == 0) {
        freopen(SCRATCH "/found.err", "w", stderr);
        execl(PLOMADA, "plomada", "scip", "record", LINK, SCRATCH "/found.bin", "--seconds", "1", "--rate",
              "250000", "--steps", "372..406", "--force", (char *)NULL);
        _exit(127);
    }
    TEST_ASSERT_EQUAL_INT(0, end_recorder(recorder, 0));
    child_read_file("found.err", text, sizeof text);
    for (const char *p = text; (p = strstr(p, " s: ")) != NULL && first_s > 1e8; p++) {
        unsigned long scans = 0;

        if (sscanf(strstr(p, "scans/s, "), "scans/s, %lu", &scans) == 1 && scans > 0) {
            first_s = atof(p - 6);
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(first_s <= 1.2, text); /* shown at the first whole second */
}

void test_mirrors_are_found_on_a_live_sensor(void)
{
    static char text[10000];

    begin("--height", "1.2", NULL, NULL);
    TEST_ASSERT_EQUAL_INT(
        0, child_plomada("scip mirrors '" LINK "' --height 1.2 2>/dev/null", text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "\n#LAYOUT THREE\n#S1 128\n#SF 389\n#S2 640\n#SW 17\n"));
}

/* ---- the firmware ---- */

static void heights_are(const char *text, double expected_m, int at_least)
{
    int count = 0;
    double height_m;

    for (const char *p = text; (p = strstr(p, "alt:")) != NULL; p++) {
        if (sscanf(p, "alt:%lf", &height_m) == 1) {
            TEST_ASSERT_DOUBLE_WITHIN(0.025, expected_m, height_m);
            count++;
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(count >= at_least, text);
}

static long number_after(const char *text, const char *label)
{
    const char *at = strstr(text, label);

    TEST_ASSERT_NOT_NULL_MESSAGE(at, label);
    return strtol(at + strlen(label), NULL, 10);
}

/* The first run finds the sensor in SCIP1.1 after its ten seconds of patience; the second finds it streaming
 * at 250000, as after a reset of the host, and need not wait: it is heard. */
void test_the_firmware_flies_on_a_sensor_behind_a_port_and_finds_it_again_after_its_own_reset(void)
{
    static char text[40000];
    const char *answer;

    begin("--height", "0.4", NULL, NULL);
    TEST_ASSERT_EQUAL_INT(
        0, child_plomada("fly bench --realtime --laser '" LINK "' --duration 13", text, sizeof text));
    TEST_ASSERT_NOT_NULL(strstr(text, "laser:WAIT"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "laser:OK"), text);
    heights_are(text, 0.4, 5);
    answer = strstr(text, "\nOK LASER ");
    TEST_ASSERT_NOT_NULL_MESSAGE(answer, text);
    TEST_ASSERT_NULL(strstr(answer + 1, "\nalt:"));
    TEST_ASSERT_EQUAL_INT(250000, number_after(answer, "rate:"));
    TEST_ASSERT_TRUE(number_after(answer, "frames:") > 10);
    TEST_ASSERT_EQUAL_INT(0, number_after(answer, "sum:"));
    TEST_ASSERT_EQUAL_INT(0, child_plomada("fly bench --laser '" LINK "' --duration 9", text, sizeof text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "laser:OK"), text);
    heights_are(text, 0.4, 5);
}
