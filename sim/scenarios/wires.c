#include "sim/scenarios/wires.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/host/pace.h"
#include "sim/host/port.h"

const char *const wire_names[] = {"laser", "imu", "xbee"};
_Static_assert(sizeof wire_names / sizeof wire_names[0] == BOARD_WIRES, "every wire has a name");

static const unsigned long nominal_rates[BOARD_WIRES] = {115200UL, 57600UL, 9600UL};

typedef struct {
    bool real;
    port_t port;
    unsigned long rate; /* last asked of the port */
} end_t;

static struct {
    end_t ends[BOARD_WIRES];
    bool has_terminal;
    port_t terminal;
    board_terminal_t heard;
    void *heard_context;
} wires;

static const char *open_terminal(void)
{
    const char *error = port_open_pty(&wires.terminal, nominal_rates[BOARD_RADIO]);

    if (error == NULL) {
        wires.has_terminal = true;
        printf("%s: %s\n", wire_names[BOARD_RADIO], wires.terminal.name);
        fflush(stdout);
    }
    return error;
}

static const char *open_end(board_wire_t wire, const char *device)
{
    end_t *end = &wires.ends[wire];
    const char *error = port_open_device(&end->port, device, nominal_rates[wire]);

    end->real = error == NULL;
    end->rate = nominal_rates[wire];
    return error;
}

const char *wires_open(const char *const device[BOARD_WIRES], board_wire_t *failed)
{
    memset(&wires, 0, sizeof wires);
    for (int i = BOARD_WIRES - 1; i >= 0; i--) {
        const bool terminal = i == BOARD_RADIO && device[i] != NULL && strcmp(device[i], WIRES_PTY) == 0;
        const char *error = NULL;

        if (device[i] != NULL) {
            error = terminal ? open_terminal() : open_end((board_wire_t)i, device[i]);
        }
        if (error != NULL) {
            *failed = (board_wire_t)i;
            wires_close();
            return error;
        }
    }
    return NULL;
}

static void out(void *context, unsigned octet)
{
    end_t *end = context;
    const unsigned char c = (unsigned char)octet;

    port_write(&end->port, &c, 1);
    if (end == &wires.ends[BOARD_RADIO]) {
        wires.heard(wires.heard_context, octet);
    }
}

static void in(void *context, const unsigned char *octets, size_t count)
{
    const end_t *end = context;

    board_receive((board_wire_t)(end - wires.ends), octets, count);
}

static void typed(void *context, const unsigned char *octets, size_t count)
{
    (void)context;
    board_type((const char *)octets, count);
}

void wires_connect(board_terminal_t heard, void *heard_context)
{
    wires.heard = heard;
    wires.heard_context = heard_context;
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (wires.ends[i].real) {
            board_connect((board_wire_t)i, out, &wires.ends[i]);
            pace_watch(&wires.ends[i].port, in, &wires.ends[i]);
        }
    }
    if (wires.has_terminal) {
        pace_watch(&wires.terminal, typed, NULL);
    }
}

void wires_show(unsigned octet)
{
    const unsigned char c = (unsigned char)octet;

    if (wires.has_terminal) {
        port_write(&wires.terminal, &c, 1);
    }
}

/* The nominal rate next to what a UART's divider makes of it. */
static unsigned long nominal(double rate)
{
    static const unsigned long known[] = {9600, 19200, 57600, 115200, 250000};

    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (fabs(rate / (double)known[i] - 1.0) < 0.02) {
            return known[i];
        }
    }
    return (unsigned long)lround(rate);
}

static void follow(board_wire_t wire)
{
    end_t *end = &wires.ends[wire];
    const unsigned long rate = nominal(board_rate(wire));
    const char *error;

    if (!end->real || rate == 0 || rate == end->rate) {
        return;
    }
    end->rate = rate;
    error = port_set_rate(&end->port, rate);
    if (error != NULL) {
        fprintf(stderr, "%s at %lu bit/s: %s\n", end->port.name, rate, error);
    }
}

void wires_pace(sim_time_t next)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        follow((board_wire_t)i);
    }
    pace_wait(next);
}

void wires_close(void)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (wires.ends[i].real) {
            port_close(&wires.ends[i].port);
        }
    }
    if (wires.has_terminal) {
        port_close(&wires.terminal);
    }
    memset(&wires, 0, sizeof wires);
}
