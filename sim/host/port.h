/* A serial port of the PC, or a pseudo-terminal that looks like one to another program. */
#ifndef SIM_HOST_PORT_H
#define SIM_HOST_PORT_H

#include <stddef.h>

typedef struct {
    int fd;                 /* -1: closed */
    int slave;              /* pseudo-terminal: our own hold on the far end, so that users may come and go */
    char name[128];         /* what the other side opens */
} port_t;

/* Raw mode, 8N1, non-blocking. NULL when fine, else what failed. */
const char *port_open_pty(port_t *port);
const char *port_open_device(port_t *port, const char *path, unsigned long bit_rate);
void port_close(port_t *port);

/* Octets read now (0: none). */
size_t port_read(port_t *port, unsigned char *octets, size_t capacity);
/* Drops what the other side does not take. */
void port_write(port_t *port, const unsigned char *octets, size_t count);

#endif
