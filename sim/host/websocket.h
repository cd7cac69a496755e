/* A port whose other side is a browser: a WebSocket server (RFC 6455) on this machine only, for one client at
 * a time. */
#ifndef SIM_HOST_WEBSOCKET_H
#define SIM_HOST_WEBSOCKET_H

#include "sim/host/port.h"

/* Listens at 127.0.0.1:tcp_port from now on; port->name is the address with its key. A page of this machine
 * and a program that is no browser need no key; any other page does, or it is answered 403. What is written
 * while nobody is connected is dropped, so that a late client gets nothing stale; a second client is refused.
 * NULL when fine (then port_close), else what failed. */
const char *websocket_open(port_t *port, unsigned tcp_port);

/* Whether an Origin (RFC 6454) is a page of this machine: localhost, 127.0.0.1 or [::1], any port. */
bool websocket_is_local(const char *origin);

/* The key that a server answers to Sec-WebSocket-Key, 28 characters and a zero. */
#define WEBSOCKET_ACCEPT 29
void websocket_accept(const char *key, char answer[WEBSOCKET_ACCEPT]);

#endif
