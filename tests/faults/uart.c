#include "uart.h"

#include <stdlib.h>
#include <string.h>

#define LINE_BITS 10

static ns_t bit_of(uint32_t rate)
{
    return (S + rate / 2) / rate;
}

void uart_open(uart_t *uart, uint32_t rate, uart_sink_t sink, void *context)
{
    memset(uart, 0, sizeof *uart);
    uart->sender_bit = uart->receiver_bit = bit_of(rate);
    uart->sink = sink;
    uart->context = context;
}

void uart_sender_rate(uart_t *uart, uint32_t rate)
{
    uart->sender_bit = bit_of(rate);
}

void uart_receiver_rate(uart_t *uart, uint32_t rate, ns_t now)
{
    uart->receiver_bit = bit_of(rate);
    uart->listen_from = now;
}

void uart_send(uart_t *uart, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (uart->count == UART_QUEUE) {
            abort();
        }
        uart->queue[(uart->head + uart->count) % UART_QUEUE] = (uint8_t)text[i];
        uart->count++;
    }
}

void uart_flush(uart_t *uart, ns_t now)
{
    uart->count = 0;
    uart->free_at = uart->free_at > now ? now : uart->free_at;
}

bool uart_idle(const uart_t *uart, ns_t now)
{
    return uart->count == 0 && uart->free_at <= now;
}

/* ---- the levels on the wire ---- */

static unsigned levels_of(const uart_octet_t *octet)
{
    return octet->octet << 1 | 1U << 9; /* start bit 0, eight bits, stop bit 1 */
}

static const uart_octet_t *octet_at(const uart_t *uart, unsigned long number)
{
    return &uart->sent[number % UART_SEEN];
}

static ns_t end_of(const uart_octet_t *octet)
{
    return octet->begin + LINE_BITS * octet->bit;
}

static bool level_at(const uart_t *uart, ns_t when)
{
    for (unsigned long i = uart->heard_n; i < uart->sent_n; i++) {
        const uart_octet_t *octet = octet_at(uart, i);
        if (when >= octet->begin && when < end_of(octet)) {
            return levels_of(octet) >> ((when - octet->begin) / octet->bit) & 1U;
        }
    }
    return true;
}

/* The first change from 1 to 0 that the receiver may take for a start bit; -1: none yet. */
static ns_t start_edge(uart_t *uart)
{
    while (uart->heard_n < uart->sent_n && end_of(octet_at(uart, uart->heard_n)) <= uart->listen_from) {
        uart->heard_n++;
    }
    for (unsigned long i = uart->heard_n; i < uart->sent_n; i++) {
        const uart_octet_t *octet = octet_at(uart, i);
        for (int bit = 0; bit < LINE_BITS - 1; bit++) {
            const ns_t edge = octet->begin + bit * octet->bit;
            const bool before = bit == 0 || (levels_of(octet) >> (bit - 1) & 1U);
            if (edge >= uart->listen_from && before && !(levels_of(octet) >> bit & 1U)) {
                return edge;
            }
        }
    }
    return -1;
}

static void hear(uart_t *uart, ns_t now)
{
    const ns_t bit = uart->receiver_bit;
    ns_t edge = start_edge(uart);
    while (edge >= 0 && edge + bit * 19 / 2 <= now && bit == uart->receiver_bit) {
        unsigned octet = 0;
        for (int i = 0; i < 8; i++) {
            octet |= (unsigned)level_at(uart, edge + bit * (3 + 2 * i) / 2) << i;
        }
        uart->listen_from = edge + bit * 19 / 2;
        uart->sink(uart->context, octet, !level_at(uart, uart->listen_from));
        edge = start_edge(uart);
    }
}

void uart_run(uart_t *uart, ns_t now)
{
    while (uart->count > 0 && uart->free_at <= now) {
        uart_octet_t *octet = &uart->sent[uart->sent_n % UART_SEEN];
        const ns_t begin = uart->free_at > now - TICK ? uart->free_at : now;
        *octet = (uart_octet_t){begin, uart->sender_bit, uart->queue[uart->head]};
        uart->head = (uart->head + 1) % UART_QUEUE;
        uart->count--;
        uart->sent_n++;
        uart->free_at = end_of(octet);
    }
    hear(uart, now);
}

ns_t uart_due(uart_t *uart)
{
    const ns_t edge = start_edge(uart);
    const ns_t sent = uart->count > 0 ? uart->free_at : NEVER;
    const ns_t heard = edge >= 0 ? edge + uart->receiver_bit * 19 / 2 : NEVER;
    return sent < heard ? sent : heard;
}
