#define _GNU_SOURCE
#include "sim/host/port.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

static speed_t speed_of(unsigned long bit_rate)
{
    switch (bit_rate) {
    case 9600: return B9600;
    case 19200: return B19200;
    case 57600: return B57600;
    case 115200: return B115200;
    default: return B0;
    }
}

static const char *make_raw(int fd, unsigned long bit_rate)
{
    struct termios settings;
    speed_t speed = speed_of(bit_rate);

    if (speed == B0) {
        return "this bit rate is not supported";
    }
    if (tcgetattr(fd, &settings) != 0) {
        return "not a serial port";
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    cfsetispeed(&settings, speed);
    cfsetospeed(&settings, speed);
    return tcsetattr(fd, TCSANOW, &settings) == 0 ? NULL : strerror(errno);
}

const char *port_open_pty(port_t *port)
{
    const char *error;

    port->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    port->slave = -1;
    if (port->fd < 0 || grantpt(port->fd) != 0 || unlockpt(port->fd) != 0 ||
        ptsname_r(port->fd, port->name, sizeof port->name) != 0) {
        return "no pseudo-terminal to be had";
    }
    port->slave = open(port->name, O_RDWR | O_NOCTTY);
    if (port->slave < 0) {
        return strerror(errno);
    }
    error = make_raw(port->slave, 9600);
    return error;
}

const char *port_open_device(port_t *port, const char *path, unsigned long bit_rate)
{
    port->slave = -1;
    snprintf(port->name, sizeof port->name, "%s", path);
    port->fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK);
    return port->fd < 0 ? strerror(errno) : make_raw(port->fd, bit_rate);
}

void port_close(port_t *port)
{
    if (port->fd >= 0) {
        close(port->fd);
    }
    if (port->slave >= 0) {
        close(port->slave);
    }
    port->fd = port->slave = -1;
}

size_t port_read(port_t *port, unsigned char *octets, size_t capacity)
{
    ssize_t got = read(port->fd, octets, capacity);

    return got > 0 ? (size_t)got : 0;
}

void port_write(port_t *port, const unsigned char *octets, size_t count)
{
    while (count > 0) {
        ssize_t put = write(port->fd, octets, count);

        if (put <= 0) {
            return;
        }
        octets += put;
        count -= (size_t)put;
    }
}
