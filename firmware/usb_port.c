#include "firmware/usb_port.h"

#include <stdbool.h>
#include <stdint.h>

#include "bsp/usb.h"
#include "firmware/uart_port.h"
#include "firmware/verbs.h"
#include "firmware/version.h"

static bool borrowed;
static uint16_t number; /* of the next line of #PERF */
static answer_t answer;

/* A line that does not fit is left out. Nobody is known to listen, and the scanner's start must not
 * wait. */
static void send_line(void)
{
    telemetry_end(&answer.line);
    (void)uart_port_send(BSP_UART_LASER, answer.line.text, answer.line.length);
}

static void tell_version(void)
{
    telemetry_begin_answer(&answer.line);
    telemetry_text(&answer.line, "OK VERSION " PLOMADA_VERSION);
    send_line();
    number = 0U;
}

void usb_port_start(void)
{
    bsp_usb_transmit(true);
    borrowed = true;
    tell_version();
}

void usb_port_step(void)
{
    static const telecommand_t perf = {.name = "PERF", .name_length = 4U};

    if (!borrowed) {
        return;
    }
    answer.command = &perf;
    if (verb_perf_line(&answer, number)) {
        send_line();
        ++number;
    } else {
        tell_version();
    }
}

/* Called in each step, so it asks whether there is anything to give back. */
void usb_port_end(void)
{
    if (borrowed) {
        bsp_usb_transmit(false);
        borrowed = false;
    }
}
