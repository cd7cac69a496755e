/* board.h on Linux, macOS and the BSDs (tried on Linux): `scanner DEVICE` prints each distance straight
 * ahead. Any bit rate that the port can make, 250000 too, for which <termios.h> has no name. */
#ifdef __linux__
#include <asm/termbits.h> /* in place of <termios.h>, which hides any rate without a name */
#else
#include <termios.h>
#endif
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>
#ifdef __APPLE__
#include <IOKit/serial/ioss.h>
#endif

#include "board.h"
#include "posix.h"

#define WAIT_MS 5 /* less than an eighth of what urg_pause_us() asks for at least */

static const char *device;
static int port = -1;

static void fail(const char *what)
{
    fprintf(stderr, "scanner: %s: %s\n", device, what);
    exit(1);
}

void posix_use(const char *path)
{
    device = path;
}

#ifdef __linux__
static bool set_rate(uint32_t bit_rate)
{
    struct termios2 settings;

    memset(&settings, 0, sizeof settings);
    settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
    settings.c_ispeed = settings.c_ospeed = bit_rate;
    return ioctl(port, TCSETS2, &settings) == 0;
}
#else
static bool set_rate(uint32_t bit_rate)
{
    struct termios settings;
    speed_t rate = bit_rate;

    if (tcgetattr(port, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CREAD | CLOCAL;
#ifdef __APPLE__
    return tcsetattr(port, TCSANOW, &settings) == 0 && ioctl(port, IOSSIOSPEED, &rate) == 0;
#else
    return cfsetspeed(&settings, rate) == 0 && tcsetattr(port, TCSANOW, &settings) == 0;
#endif
}
#endif

uint32_t board_time_us(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)now.tv_sec * 1000000U + (uint32_t)(now.tv_nsec / 1000);
}

void board_uart_open(uint32_t bit_rate)
{
    if (port < 0) {
        port = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK);
    }
    if (port < 0 || !set_rate(bit_rate)) {
        fail(strerror(errno));
    }
}

size_t board_uart_read(octet_t *octets, size_t most)
{
    struct pollfd wanted = {.fd = port, .events = POLLIN};
    ssize_t count;

    if (poll(&wanted, 1, WAIT_MS) <= 0) {
        return 0;
    }
    count = read(port, octets, most);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) {
        fail("is gone");
    }
    return count > 0 ? (size_t)count : 0;
}

/* A command has 21 octets at most: an output buffer without room for them is that of a port that is gone. */
void board_uart_write(const octet_t *octets, size_t count)
{
    if (write(port, octets, count) != (ssize_t)count) {
        fail("takes nothing");
    }
}

uint32_t board_uart_errors(void)
{
    return 0; /* not told here: what a wrong rate makes of the octets is enough for the driver */
}

void board_cycle_sensor_power(void) {}
