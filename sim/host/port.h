/* A serial port of the PC, or a pseudo-terminal that looks like one to another program. */
#ifndef SIM_HOST_PORT_H
#define SIM_HOST_PORT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    int fd;         /* -1: closed */
    int slave;      /* pseudo-terminal: our own hold on the far end, so that users may come and go */
    char name[128]; /* what the other side opens */
    unsigned long framing_errors;
    /* private */
    bool marks; /* the driver marks octets that came with a framing error */
    int marked; /* octets of a mark so far */
} port_t;

/* Raw mode, 8N1, non-blocking; what is already in the port's buffers is dropped. Any bit rate that the port's
 * driver can make, 250000 among them; a pseudo-terminal takes any. NULL when fine (then port_close), else
 * what failed. */
const char *port_open_pty(port_t *port, unsigned long bit_rate);
const char *port_open_device(port_t *port, const char *path, unsigned long bit_rate);
void port_close(port_t *port);

/* From now on the port runs at this rate. NULL when fine, else what failed, and the port is as it was. */
const char *port_set_rate(port_t *port, unsigned long bit_rate);
/* Bits per second that are set now, on a pseudo-terminal by either side; 0 when there is none. */
unsigned long port_rate(const port_t *port);

/* An octet that came with a framing error, or a break, is read as this one and counted in framing_errors: a
 * wrong rate is seen by both, where the port's driver tells (PARMRK). */
#define PORT_BROKEN_OCTET 0xFFU

/* Octets read now (0: none). Sets *lost when the port is gone: unplugged, or the far end's maker has closed
 * it. */
size_t port_read(port_t *port, unsigned char *octets, size_t capacity, bool *lost);
/* Resolves the marks of a driver in place (FF FF: one FF; FF 00 and any octet: a broken one), across calls.
 * Returns how many octets there are then. */
size_t port_resolve_marks(port_t *port, unsigned char *octets, size_t count);
/* Drops what the other side does not take; returns how many octets it took. */
size_t port_write(port_t *port, const unsigned char *octets, size_t count);

/* A pseudo-terminal of ours under a name of the user's choice, a symbolic link; one that an ended program has
 * left there is replaced, one that a program still has is not. NULL when fine (then port_unlink()), else what
 * failed. */
const char *port_link(const port_t *port, const char *path);
/* Removes the link, unless another program has taken it over. */
void port_unlink(const port_t *port, const char *path);

#endif
