/* One direction of a serial line, bit by bit: what a receiver at another rate makes of the octets follows
 * from the levels on the wire, as on a real UART. Times in nanoseconds. */
#ifndef TESTS_FAULTS_UART_H
#define TESTS_FAULTS_UART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define UART_QUEUE 8192U
#define UART_SEEN 64U

typedef int64_t ns_t;
#define US ((ns_t)1000)
#define MS (1000 * US)
#define S (1000 * MS)
#define TICK (100 * US) /* uart_run() is called as often while anything is due */
#define NEVER INT64_MAX

typedef void (*uart_sink_t)(void *context, unsigned octet, bool framing_error);

typedef struct {
    ns_t begin, bit;
    unsigned octet;
} uart_octet_t;

typedef struct {
    ns_t sender_bit, receiver_bit;
    uint8_t queue[UART_QUEUE];
    size_t head, count;
    ns_t free_at;                  /* the sender's line */
    uart_octet_t sent[UART_SEEN];  /* the latest ones */
    unsigned long sent_n, heard_n; /* heard_n: the receiver is done with those before */
    ns_t listen_from;              /* the receiver looks for a start bit from here on */
    uart_sink_t sink;
    void *context;
} uart_t;

void uart_open(uart_t *uart, uint32_t rate, uart_sink_t sink, void *context);
void uart_sender_rate(uart_t *uart, uint32_t rate);
void uart_receiver_rate(uart_t *uart, uint32_t rate, ns_t now);
void uart_send(uart_t *uart, const char *text, size_t length);
/* What was not sent yet is not sent any more. */
void uart_flush(uart_t *uart, ns_t now);
bool uart_idle(const uart_t *uart, ns_t now);
/* Everything on the line up to now. */
void uart_run(uart_t *uart, ns_t now);
/* Before that time uart_run() does nothing, unless somebody else does something first; NEVER. */
ns_t uart_due(uart_t *uart);

#endif
