#define _GNU_SOURCE
#include "sim/host/port.h"

#include <asm/termbits.h> /* termios2 has any rate; <termios.h> has not, and cannot be included beside it */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

/* A driver may make the nearest rate that its clock can; a receiver samples 4.5 % off. */
static bool near_enough(unsigned long made, unsigned long asked)
{
    return asked > 0 && made * 50 >= asked * 49 && made * 50 <= asked * 51;
}

static const char *configure(int fd, unsigned long bit_rate, bool marks)
{
    struct termios2 settings;

    if (ioctl(fd, TCGETS2, &settings) != 0) {
        return "not a serial port";
    }
    settings.c_iflag = marks ? INPCK | PARMRK : 0; /* the drivers report nothing without INPCK */
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
    settings.c_ispeed = settings.c_ospeed = (speed_t)bit_rate;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (ioctl(fd, TCSETS2, &settings) != 0) {
        return strerror(errno);
    }
    if (ioctl(fd, TCGETS2, &settings) != 0 || !near_enough(settings.c_ospeed, bit_rate)) {
        return "this bit rate is not supported";
    }
    return NULL;
}

static const char *finish_open(port_t *port, const char *error)
{
    if (error != NULL) {
        port_close(port);
        return error;
    }
    ioctl(port->fd, TCFLSH, TCIOFLUSH);
    return NULL;
}

const char *port_open_pty(port_t *port, unsigned long bit_rate)
{
    port->framing_errors = 0;
    port->marks = false;
    port->marked = 0;
    port->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    port->slave = -1;
    if (port->fd < 0 || grantpt(port->fd) != 0 || unlockpt(port->fd) != 0 ||
        ptsname_r(port->fd, port->name, sizeof port->name) != 0) {
        return finish_open(port, "no pseudo-terminal to be had");
    }
    port->slave = open(port->name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    return finish_open(port, port->slave < 0 ? strerror(errno) : configure(port->slave, bit_rate, false));
}

const char *port_open_device(port_t *port, const char *path, unsigned long bit_rate)
{
    port->slave = -1;
    port->framing_errors = 0;
    port->marks = true;
    port->marked = 0;
    snprintf(port->name, sizeof port->name, "%s", path);
    port->fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    return finish_open(port, port->fd < 0 ? strerror(errno) : configure(port->fd, bit_rate, true));
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

const char *port_set_rate(port_t *port, unsigned long bit_rate)
{
    unsigned long before = port_rate(port);
    const char *error = configure(port->fd, bit_rate, port->marks);

    if (error != NULL && before != 0) {
        (void)configure(port->fd, before, port->marks);
    }
    return error;
}

unsigned long port_rate(const port_t *port)
{
    struct termios2 settings;

    return ioctl(port->fd, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

/* The octet that `octet` completes, or -1 within a mark. */
static int resolve(port_t *port, unsigned char octet)
{
    const int marked = port->marked;

    port->marked = 0;
    if (marked == 2) {
        port->framing_errors++;
        return PORT_BROKEN_OCTET;
    }
    if (marked == 1 && octet != 0) {
        return octet;
    }
    if (marked == 1 || octet == 0xFF) {
        port->marked = marked + 1;
        return -1;
    }
    return octet;
}

size_t port_resolve_marks(port_t *port, unsigned char *octets, size_t count)
{
    size_t kept = 0;

    for (size_t i = 0; i < count; i++) {
        const int octet = resolve(port, octets[i]);

        if (octet >= 0) {
            octets[kept++] = (unsigned char)octet;
        }
    }
    return kept;
}

size_t port_read(port_t *port, unsigned char *octets, size_t capacity, bool *lost)
{
    ssize_t got = read(port->fd, octets, capacity);

    *lost = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
    if (got <= 0) {
        return 0;
    }
    return port->marks ? port_resolve_marks(port, octets, (size_t)got) : (size_t)got;
}

size_t port_write(port_t *port, const unsigned char *octets, size_t count)
{
    size_t taken = 0;

    while (taken < count) {
        ssize_t put = write(port->fd, octets + taken, count - taken);

        if (put <= 0) {
            break;
        }
        taken += (size_t)put;
    }
    return taken;
}

/* Whoever has a link holds this lock on the pseudo-terminal, and it ends with the program. It is not
 * flock()'s, which users of a serial port take for themselves. */
static bool lock(int fd, int command, struct flock *wanted)
{
    *wanted = (struct flock){.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_len = 1};
    return fcntl(fd, command, wanted) == 0;
}

static bool is_in_use(const char *path)
{
    struct flock found;
    const int fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    const bool locked = fd >= 0 && lock(fd, F_OFD_GETLK, &found) && found.l_type != F_UNLCK;

    if (fd >= 0) {
        close(fd);
    }
    return locked;
}

/* Whether the path is a link to a pseudo-terminal, or one that leads nowhere. */
static bool is_of_port(const char *path)
{
    char target[16] = "";
    struct stat status;

    if (readlink(path, target, sizeof target - 1) < 0) {
        return false;
    }
    return stat(path, &status) != 0 || strncmp(target, "/dev/pts/", 9) == 0;
}

const char *port_link(const port_t *port, const char *path)
{
    struct flock own;

    if (is_of_port(path)) {
        if (is_in_use(path)) {
            return "is in use by another program; end that one, or take another name";
        }
        unlink(path); /* left by a program that was killed */
    }
    if (!lock(port->slave, F_OFD_SETLK, &own)) {
        return strerror(errno);
    }
    return symlink(port->name, path) == 0 ? NULL : strerror(errno);
}

void port_unlink(const port_t *port, const char *path)
{
    char target[sizeof port->name] = "";

    if (readlink(path, target, sizeof target - 1) > 0 && strcmp(target, port->name) == 0) {
        unlink(path);
    }
}
