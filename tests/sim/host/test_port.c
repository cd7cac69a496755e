#include "sim/host/port.h"

#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "unity.h"

static port_t own, users;

void setUp(void)
{
    TEST_ASSERT_NULL(port_open_pty(&own, 115200));
    TEST_ASSERT_NULL(port_open_device(&users, own.name, 115200));
}

void tearDown(void)
{
    port_close(&users);
    port_close(&own);
}

/* What the kernel holds back between the two ends arrives soon, not at once. */
static size_t read_some(port_t *port, unsigned char *octets, size_t wanted)
{
    size_t have = 0;
    bool lost = false;

    for (int i = 0; i < 500 && have < wanted; i++) {
        have += port_read(port, octets + have, wanted - have, &lost);
        TEST_ASSERT_FALSE(lost);
        if (have < wanted) {
            usleep(1000);
        }
    }
    return have;
}

void test_every_octet_passes_unchanged_in_both_directions(void)
{
    unsigned char sent[256], got[256] = {0};

    for (int i = 0; i < 256; i++) {
        sent[i] = (unsigned char)i;
    }
    port_write(&own, sent, sizeof sent);
    TEST_ASSERT_EQUAL_size_t(sizeof sent, read_some(&users, got, sizeof got));
    TEST_ASSERT_EQUAL_MEMORY(sent, got, sizeof sent);
    memset(got, 0, sizeof got);
    port_write(&users, sent, sizeof sent);
    TEST_ASSERT_EQUAL_size_t(sizeof sent, read_some(&own, got, sizeof got));
    TEST_ASSERT_EQUAL_MEMORY(sent, got, sizeof sent);
}

/* A pseudo-terminal has no framing errors, so the marks of a driver are written here as termios(3) has them.
 */
void test_a_framing_error_is_counted_and_read_as_an_octet_that_no_sensor_sends(void)
{
    static const unsigned char marked[] = {'a', 0xFF, 0xFF, 'b',  0xFF, 0,    'x', 0xFF,
                                           0,   0,    0,    0xFF, 0,    0xFF, 'c'};
    static const unsigned char meant[] = {
        'a', 0xFF, 'b', PORT_BROKEN_OCTET, PORT_BROKEN_OCTET, 0, PORT_BROKEN_OCTET, 'c'};

    for (size_t cut = 0; cut <= sizeof marked; cut++) {
        unsigned char octets[sizeof marked];
        size_t first, second;

        memcpy(octets, marked, sizeof marked);
        users.framing_errors = 0;
        first = port_resolve_marks(&users, octets, cut);
        second = port_resolve_marks(&users, octets + cut, sizeof marked - cut);
        memmove(octets + first, octets + cut, second);
        TEST_ASSERT_EQUAL_size_t(sizeof meant, first + second);
        TEST_ASSERT_EQUAL_MEMORY(meant, octets, sizeof meant);
        TEST_ASSERT_EQUAL_UINT32(3, users.framing_errors);
    }
}

void test_the_driver_of_a_device_is_asked_to_mark_framing_errors(void)
{
    struct termios settings;

    TEST_ASSERT_EQUAL_INT(0, tcgetattr(users.fd, &settings));
    TEST_ASSERT_EQUAL_UINT32(INPCK | PARMRK, settings.c_iflag);
    TEST_ASSERT_NULL(port_set_rate(&users, 250000));
    TEST_ASSERT_EQUAL_INT(0, tcgetattr(users.fd, &settings));
    TEST_ASSERT_EQUAL_UINT32(INPCK | PARMRK, settings.c_iflag);
}

void test_reading_an_empty_port_gives_nothing_and_does_not_wait(void)
{
    unsigned char octet;
    bool lost = true;

    TEST_ASSERT_EQUAL_size_t(0, port_read(&users, &octet, 1, &lost));
    TEST_ASSERT_FALSE(lost);
    TEST_ASSERT_EQUAL_size_t(0, port_read(&own, &octet, 1, &lost));
    TEST_ASSERT_FALSE(lost);
}

void test_a_pseudo_terminal_takes_any_rate_and_shows_it_to_the_other_side(void)
{
    static const unsigned long rates[] = {50,     9600,   19200,  57600,  115200,
                                          123457, 250000, 500000, 750000, 3000000};

    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        TEST_ASSERT_NULL(port_set_rate(&users, rates[i]));
        TEST_ASSERT_EQUAL_UINT32(rates[i], port_rate(&own));
        TEST_ASSERT_EQUAL_UINT32(rates[i], port_rate(&users));
    }
}

void test_a_rate_set_by_the_ordinary_termios_is_seen(void)
{
    struct termios settings;

    TEST_ASSERT_EQUAL_INT(0, tcgetattr(users.fd, &settings));
    cfsetispeed(&settings, B57600);
    cfsetospeed(&settings, B57600);
    TEST_ASSERT_EQUAL_INT(0, tcsetattr(users.fd, TCSANOW, &settings));
    TEST_ASSERT_EQUAL_UINT32(57600, port_rate(&own));
}

void test_no_rate_is_refused_and_the_port_stays_as_it_was(void)
{
    unsigned char octet = 'x', got = 0;

    TEST_ASSERT_NULL(port_set_rate(&users, 250000));
    TEST_ASSERT_NOT_NULL(port_set_rate(&users, 0));
    TEST_ASSERT_EQUAL_UINT32(250000, port_rate(&users));
    port_write(&own, &octet, 1);
    TEST_ASSERT_EQUAL_size_t(1, read_some(&users, &got, 1));
    TEST_ASSERT_EQUAL_UINT32('x', got);
}

void test_what_is_not_a_serial_port_is_refused_and_left_closed(void)
{
    port_t port = {.fd = 99, .slave = 99};

    TEST_ASSERT_NOT_NULL(port_open_device(&port, "/dev/null", 9600));
    TEST_ASSERT_EQUAL_INT(-1, port.fd);
    TEST_ASSERT_NOT_NULL(port_open_device(&port, "/no/such/device", 9600));
    TEST_ASSERT_EQUAL_INT(-1, port.fd);
    TEST_ASSERT_EQUAL_INT(-1, port.slave);
    TEST_ASSERT_NOT_NULL(port_open_device(&port, "/dev", 9600));
    TEST_ASSERT_EQUAL_INT(-1, port.fd);
}

void test_what_was_in_the_line_before_opening_is_dropped(void)
{
    unsigned char got = 0;
    port_t late;

    port_write(&own, (const unsigned char *)"stale", 5);
    usleep(20000);
    TEST_ASSERT_NULL(port_open_device(&late, own.name, 9600));
    port_write(&own, (const unsigned char *)"!", 1);
    TEST_ASSERT_EQUAL_size_t(1, read_some(&late, &got, 1));
    TEST_ASSERT_EQUAL_UINT32('!', got);
    port_close(&late);
}

void test_users_may_come_and_go(void)
{
    unsigned char octet = 'a', got = 0;
    bool lost = true;

    port_close(&users);
    TEST_ASSERT_EQUAL_size_t(0, port_read(&own, &got, 1, &lost));
    TEST_ASSERT_FALSE(lost);
    TEST_ASSERT_NULL(port_open_device(&users, own.name, 250000));
    port_write(&users, &octet, 1);
    TEST_ASSERT_EQUAL_size_t(1, read_some(&own, &got, 1));
    TEST_ASSERT_EQUAL_UINT32('a', got);
}

void test_a_port_whose_maker_has_gone_is_lost(void)
{
    unsigned char octet;
    bool lost = false;

    port_close(&own);
    TEST_ASSERT_EQUAL_size_t(0, port_read(&users, &octet, 1, &lost));
    TEST_ASSERT_TRUE(lost);
    TEST_ASSERT_EQUAL_UINT32(0, port_rate(&own));
}

void test_writing_to_a_full_line_drops_and_returns(void)
{
    static const unsigned char flood[1 << 20];
    unsigned char octet;
    bool lost;

    port_write(&own, flood, sizeof flood);
    TEST_ASSERT_EQUAL_size_t(1, port_read(&users, &octet, 1, &lost));
}

/* The kernel gives the number of a closed pseudo-terminal to the next one, whoever makes it. */
void test_a_link_is_its_programs_until_that_has_ended_and_then_anybodys(void)
{
    static const char path[] = "test_port.link";
    port_t other, next;

    unlink(path);
    TEST_ASSERT_NULL(port_link(&own, path));
    TEST_ASSERT_NULL(port_open_pty(&other, 115200));
    TEST_ASSERT_EQUAL_STRING("is in use by another program; end that one, or take another name",
                             port_link(&other, path));
    port_unlink(&other, path);
    TEST_ASSERT_EQUAL_INT(0, access(path, F_OK));
    port_close(&users);
    port_close(&own);
    TEST_ASSERT_NULL(port_open_pty(&next, 115200));
    TEST_ASSERT_NULL(port_link(&other, path));
    port_unlink(&other, path);
    TEST_ASSERT_NOT_EQUAL_INT(0, access(path, F_OK));
    port_close(&other);
    port_close(&next);
}

void test_closing_twice_is_harmless(void)
{
    port_close(&users);
    port_close(&users);
    TEST_ASSERT_EQUAL_INT(-1, users.fd);
}
