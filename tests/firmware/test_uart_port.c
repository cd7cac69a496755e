/* The transmit ring, the receive levels, the six Hwis and the tick, on a mocked UART whose FIFO takes 16
 * octets. */
#include "firmware/uart_port.h"

#include <string.h>

#include "kernel.h"
#include "mock_cpu_time.h"
#include "mock_uart.h"
#include "unity.h"

#define FIFO 16U
#define WIRE_MAX 60000U
#define RECEIVE_NUMBER 40
#define TRANSMIT_NUMBER 50

static struct {
    uint16_t fifo;           /* octets in it */
    uint16_t wire[WIRE_MAX]; /* all that was put into the FIFO */
    uint32_t sent;
    bool interrupt_on;
    uint32_t rate;
    uint16_t opened;
    bsp_uart_burst_t burst; /* what the next receive interrupt finds */
    bsp_uart_burst_t received;
    uint16_t receptions;
    uint16_t asked; /* by the receiver: octets until it wants to be called again */
    uint16_t level; /* of the receive interrupt */
    uint16_t level_changes;
} uarts[BSP_UART_COUNT];
static bool in_hwi;

static int16_t receive_number(bsp_uart_t uart, int calls)
{
    (void)calls;
    return (int16_t)(RECEIVE_NUMBER + (int)uart);
}

static int16_t transmit_number(bsp_uart_t uart, int calls)
{
    (void)calls;
    return (int16_t)(TRANSMIT_NUMBER + (int)uart);
}

static void open(bsp_uart_t uart, uint32_t bit_rate, int calls)
{
    (void)calls;
    uarts[uart].fifo = 0;
    uarts[uart].rate = bit_rate;
    uarts[uart].opened++;
    uarts[uart].interrupt_on = false;
    uarts[uart].level = 1U;
}

static void set_level(bsp_uart_t uart, uint16_t octets, int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(in_hwi || kernel.hwi.depth > 0, "the receive Hwi is not excluded");
    TEST_ASSERT_TRUE(octets >= 1U && octets <= FIFO);
    uarts[uart].level = octets;
    uarts[uart].level_changes++;
}

static void receive(bsp_uart_t uart, bsp_uart_burst_t *burst, int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(in_hwi || kernel.hwi.depth > 0, "the receive Hwi is not excluded");
    *burst = uarts[uart].burst;
}

static uint16_t transmit(bsp_uart_t uart, const uint16_t *octets, uint16_t count, int calls)
{
    uint16_t taken = 0;

    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(in_hwi || kernel.hwi.depth > 0, "the transmit Hwi is not excluded");
    while (taken < count && uarts[uart].fifo < FIFO) {
        TEST_ASSERT_LESS_THAN(WIRE_MAX, uarts[uart].sent);
        uarts[uart].wire[uarts[uart].sent++] = octets[taken++];
        uarts[uart].fifo++;
    }
    return taken;
}

static void interrupt_enable(bsp_uart_t uart, bool on, int calls)
{
    (void)calls;
    uarts[uart].interrupt_on = on;
    kernel_note(on ? "on" : "off");
}

static void acknowledge(bsp_uart_t uart, int calls)
{
    (void)uart;
    (void)calls;
    kernel_note("acknowledge");
}

static uint16_t received(bsp_uart_t uart, const bsp_uart_burst_t *burst)
{
    uarts[uart].received = *burst;
    uarts[uart].receptions++;
    return uarts[uart].asked;
}

static uint16_t laser_received(const bsp_uart_burst_t *burst)
{
    return received(BSP_UART_LASER, burst);
}
static uint16_t imu_received(const bsp_uart_burst_t *burst)
{
    return received(BSP_UART_IMU, burst);
}
static uint16_t xbee_received(const bsp_uart_burst_t *burst)
{
    return received(BSP_UART_XBEE, burst);
}

void setUp(void)
{
    kernel_reset();
    in_hwi = false;
    (void)memset(uarts, 0, sizeof uarts);
    bsp_uart_receive_interrupt_Stub(receive_number);
    bsp_uart_transmit_interrupt_Stub(transmit_number);
    bsp_uart_open_Stub(open);
    bsp_uart_receive_Stub(receive);
    bsp_uart_set_receive_level_Stub(set_level);
    bsp_uart_transmit_Stub(transmit);
    bsp_uart_transmit_interrupt_enable_Stub(interrupt_enable);
    bsp_uart_transmit_acknowledge_Stub(acknowledge);
    for (int job = CPU_TIME_LASER_RECEIVE; job <= CPU_TIME_XBEE_TRANSMIT; job++) {
        cpu_time_watch_Expect((cpu_time_job_t)job, NULL);
        cpu_time_watch_IgnoreArg_handle();
    }
    uart_port_create(BSP_UART_LASER, 115200U, laser_received);
    uart_port_create(BSP_UART_IMU, 57600U, imu_received);
    uart_port_create(BSP_UART_XBEE, 9600U, xbee_received);
    for (uint16_t u = 0; u < BSP_UART_COUNT; u++) {
        uarts[u].asked = 1U;
    }
    uart_port_start();
}

void tearDown(void)
{
    kernel_check();
    for (uint16_t u = 0; u < BSP_UART_COUNT; u++) {
        uart_port_reopen((bsp_uart_t)u, 9600U);
    }
}

static void receive_hwi(bsp_uart_t uart)
{
    in_hwi = true;
    kernel_interrupt(RECEIVE_NUMBER + (Int)uart);
    in_hwi = false;
}

static void tick(void)
{
    kernel.clock.function(kernel.clock.params.arg);
    kernel_no_lock();
}

/* The FIFO ran empty. */
static void transmit_hwi(bsp_uart_t uart)
{
    TEST_ASSERT_TRUE_MESSAGE(uarts[uart].interrupt_on, "the transmit interrupt is off");
    uarts[uart].fifo = 0;
    kernel.notes[0] = '\0';
    in_hwi = true;
    kernel_interrupt(TRANSMIT_NUMBER + (Int)uart);
    in_hwi = false;
}

static void send_all(bsp_uart_t uart)
{
    for (uint16_t n = 0; uarts[uart].interrupt_on; n++) {
        TEST_ASSERT_LESS_THAN(UART_PORT_TRANSMIT_CELLS, n);
        transmit_hwi(uart);
    }
    uarts[uart].fifo = 0;
}

void test_create_opens_each_uart_at_its_rate_and_makes_its_two_hwis(void)
{
    TEST_ASSERT_EQUAL_UINT16(6, kernel.hwi.count);
    for (uint16_t u = 0; u < BSP_UART_COUNT; u++) {
        TEST_ASSERT_EQUAL_UINT16(1, uarts[u].opened);
        TEST_ASSERT_EQUAL_INT(RECEIVE_NUMBER + u, kernel.hwi.made[2U * u].number);
        TEST_ASSERT_EQUAL_INT(TRANSMIT_NUMBER + u, kernel.hwi.made[2U * u + 1U].number);
        TEST_ASSERT_EQUAL_UINT64(u, kernel.hwi.made[2U * u].params.arg);
        TEST_ASSERT_EQUAL_UINT64(u, kernel.hwi.made[2U * u + 1U].params.arg);
    }
    TEST_ASSERT_EQUAL_UINT32(115200, uarts[BSP_UART_LASER].rate);
    TEST_ASSERT_EQUAL_UINT32(57600, uarts[BSP_UART_IMU].rate);
    TEST_ASSERT_EQUAL_UINT32(9600, uarts[BSP_UART_XBEE].rate);
}

void test_a_receive_interrupt_hands_its_burst_to_its_own_receiver_alone(void)
{
    for (uint16_t u = 0; u < BSP_UART_COUNT; u++) {
        uarts[u].burst.count = (uint16_t)(3U + u);
        uarts[u].burst.octets[2] = (uint16_t)(0x41U + u);
        uarts[u].burst.framing = u == 1U;
        uarts[u].burst.overrun = u == 2U;
        receive_hwi((bsp_uart_t)u);
        TEST_ASSERT_EQUAL_UINT16(1, uarts[u].receptions);
        TEST_ASSERT_EQUAL_UINT16(3U + u, uarts[u].received.count);
        TEST_ASSERT_EQUAL_HEX16(0x41U + u, uarts[u].received.octets[2]);
        TEST_ASSERT_EQUAL(u == 1U, uarts[u].received.framing);
        TEST_ASSERT_EQUAL(u == 2U, uarts[u].received.overrun);
    }
    TEST_ASSERT_EQUAL_UINT16(1, uarts[0].receptions);
}

void test_what_fits_the_fifo_goes_at_once_and_needs_no_interrupt(void)
{
    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_LASER, "0123456789abcdef", 16U));
    TEST_ASSERT_EQUAL_UINT32(16, uarts[BSP_UART_LASER].sent);
    TEST_ASSERT_FALSE(uarts[BSP_UART_LASER].interrupt_on);
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(BSP_UART_LASER));
}

void test_one_character_more_than_the_fifo_holds_needs_the_interrupt(void)
{
    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_LASER, "0123456789abcdefg", 17U));
    TEST_ASSERT_EQUAL_UINT32(16, uarts[BSP_UART_LASER].sent);
    TEST_ASSERT_TRUE(uarts[BSP_UART_LASER].interrupt_on);
    TEST_ASSERT_EQUAL_UINT16(1023, uart_port_room(BSP_UART_LASER));
    transmit_hwi(BSP_UART_LASER);
    TEST_ASSERT_EQUAL_UINT32(17, uarts[BSP_UART_LASER].sent);
    TEST_ASSERT_EQUAL_HEX16('g', uarts[BSP_UART_LASER].wire[16]);
    TEST_ASSERT_FALSE(uarts[BSP_UART_LASER].interrupt_on);
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(BSP_UART_LASER));
}

void test_the_transmit_hwi_acknowledges_last_and_stays_on_while_something_waits(void)
{
    static const char text[40] = "0123456789012345678901234567890123456789";

    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_XBEE, text, 40U));
    transmit_hwi(BSP_UART_XBEE);
    TEST_ASSERT_EQUAL_STRING("on acknowledge ", kernel.notes);
    transmit_hwi(BSP_UART_XBEE);
    TEST_ASSERT_EQUAL_STRING("off acknowledge ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT32(40, uarts[BSP_UART_XBEE].sent);
}

void test_all_of_a_text_is_queued_or_nothing(void)
{
    static char text[UART_PORT_TRANSMIT_CELLS + 1U];
    const bsp_uart_t uart = BSP_UART_IMU;

    (void)memset(text, 'x', sizeof text);
    uarts[uart].fifo = FIFO;
    TEST_ASSERT_FALSE(uart_port_send(uart, text, 1025U));
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(uart));
    TEST_ASSERT_TRUE(uart_port_send(uart, text, 1000U));
    TEST_ASSERT_EQUAL_UINT16(24, uart_port_room(uart));
    TEST_ASSERT_FALSE(uart_port_send(uart, "yyyyyyyyyyyyyyyyyyyyyyyyy", 25U));
    TEST_ASSERT_EQUAL_UINT16(24, uart_port_room(uart));
    TEST_ASSERT_TRUE(uart_port_send(uart, "zzzzzzzzzzzzzzzzzzzzzzzz", 24U));
    TEST_ASSERT_EQUAL_UINT16(0, uart_port_room(uart));
    TEST_ASSERT_FALSE(uart_port_send(uart, "y", 1U));
    TEST_ASSERT_TRUE(uart_port_send(uart, "", 0U));
    send_all(uart);
    TEST_ASSERT_EQUAL_UINT32(1024, uarts[uart].sent);
    TEST_ASSERT_EACH_EQUAL_UINT16('x', uarts[uart].wire, 1000);
    TEST_ASSERT_EACH_EQUAL_UINT16('z', &uarts[uart].wire[1000], 24);
}

void test_a_refused_text_still_moves_what_waits_into_the_fifo(void)
{
    static char text[UART_PORT_TRANSMIT_CELLS];

    (void)memset(text, 'x', sizeof text);
    uarts[0].fifo = FIFO;
    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_LASER, text, 1024U));
    TEST_ASSERT_TRUE(uarts[0].interrupt_on);
    TEST_ASSERT_FALSE(uart_port_send(BSP_UART_LASER, "y", 1U));
    TEST_ASSERT_TRUE(uarts[0].interrupt_on);
    send_all(BSP_UART_LASER);
    TEST_ASSERT_EQUAL_UINT32(1024, uarts[0].sent);
}

void test_texts_of_any_length_leave_whole_and_in_their_order_round_the_ring_many_times(void)
{
    static char queued[WIRE_MAX];
    static char text[300];
    uint32_t count = 0;
    uint16_t refused = 0;
    const bsp_uart_t uart = BSP_UART_XBEE;

    kernel_random_seed(20260719U);
    while (count < 50000U) {
        const uint16_t length = kernel_random(sizeof text + 1U);
        const uint16_t room = uart_port_room(uart);

        for (uint16_t i = 0; i < length; i++) {
            text[i] = (char)(' ' + (char)kernel_random(95U));
        }
        if (uart_port_send(uart, text, length)) {
            TEST_ASSERT_GREATER_OR_EQUAL_UINT16(length, room);
            (void)memcpy(&queued[count], text, length);
            count += length;
        } else {
            TEST_ASSERT_LESS_THAN_UINT16(length, room);
            refused++;
        }
        TEST_ASSERT_EQUAL_UINT16(UART_PORT_TRANSMIT_CELLS - (count - uarts[uart].sent), uart_port_room(uart));
        for (uint16_t n = kernel_random(16U); n > 0U && uarts[uart].interrupt_on; n--) {
            transmit_hwi(uart);
        }
        uarts[uart].fifo = kernel_random(FIFO + 1U); /* some octets have left it meanwhile */
        if (uarts[uart].fifo == 0U && !uarts[uart].interrupt_on) {
            TEST_ASSERT_EQUAL_UINT32(count, uarts[uart].sent);
        }
    }
    send_all(uart);
    TEST_ASSERT_GREATER_THAN_UINT16(10, refused);
    TEST_ASSERT_EQUAL_UINT32(count, uarts[uart].sent);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_HEX16(queued[i], uarts[uart].wire[i]);
    }
}

void test_the_interrupt_is_on_exactly_while_something_waits_in_the_ring(void)
{
    kernel_random_seed(4U);
    for (uint16_t n = 0; n < 2000U; n++) {
        (void)uart_port_send(BSP_UART_IMU, "0123456789012345678901234567890", kernel_random(32U));
        TEST_ASSERT_EQUAL(uart_port_room(BSP_UART_IMU) < UART_PORT_TRANSMIT_CELLS,
                          uarts[BSP_UART_IMU].interrupt_on);
        if (uarts[BSP_UART_IMU].interrupt_on) {
            transmit_hwi(BSP_UART_IMU);
        }
        TEST_ASSERT_EQUAL(uart_port_room(BSP_UART_IMU) < UART_PORT_TRANSMIT_CELLS,
                          uarts[BSP_UART_IMU].interrupt_on);
    }
}

/* The ring's end is no reason for a second interrupt: what waits on both sides of it fills one FIFO. */
void test_the_fifo_is_filled_from_both_ends_of_the_ring(void)
{
    const bsp_uart_t uart = BSP_UART_LASER;
    static char text[UART_PORT_TRANSMIT_CELLS];

    (void)memset(text, 'x', sizeof text);
    for (uint16_t to_end = 1; to_end < 2U * FIFO; to_end++) {
        uart_port_reopen(uart, 115200U); /* the ring begins at its first cell */
        uarts[uart].sent = 0U;
        TEST_ASSERT_TRUE(uart_port_send(uart, text, (uint16_t)(UART_PORT_TRANSMIT_CELLS - to_end)));
        send_all(uart);
        uarts[uart].fifo = FIFO;
        TEST_ASSERT_TRUE(uart_port_send(uart, "0123456789abcdef0123456789ABCDEF+", 33U));
        uarts[uart].sent = 0U;
        transmit_hwi(uart);
        TEST_ASSERT_EQUAL_UINT32(16, uarts[uart].sent);
        transmit_hwi(uart);
        TEST_ASSERT_EQUAL_UINT32(32, uarts[uart].sent);
        TEST_ASSERT_TRUE(uarts[uart].interrupt_on);
        transmit_hwi(uart);
        TEST_ASSERT_EQUAL_UINT32(33, uarts[uart].sent);
        TEST_ASSERT_FALSE(uarts[uart].interrupt_on);
        for (uint16_t i = 0; i < 33U; i++) {
            TEST_ASSERT_EQUAL_HEX16("0123456789abcdef0123456789ABCDEF+"[i], uarts[uart].wire[i]);
        }
    }
}

void test_a_reopened_uart_has_dropped_what_was_not_sent(void)
{
    const bsp_uart_t uart = BSP_UART_LASER;

    TEST_ASSERT_TRUE(uart_port_send(uart, "0123456789012345678901234567890", 31U));
    uart_port_reopen(uart, 250000U);
    TEST_ASSERT_EQUAL_UINT32(250000, uarts[uart].rate);
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(uart));
    TEST_ASSERT_EQUAL_UINT32(16, uarts[uart].sent);
    TEST_ASSERT_TRUE(uart_port_send(uart, "QT\n", 3U));
    TEST_ASSERT_EQUAL_UINT32(19, uarts[uart].sent);
    TEST_ASSERT_EQUAL_HEX16('Q', uarts[uart].wire[16]);
    TEST_ASSERT_EQUAL_HEX16('T', uarts[uart].wire[17]);
    TEST_ASSERT_EQUAL_HEX16('\n', uarts[uart].wire[18]);
    TEST_ASSERT_FALSE(uarts[uart].interrupt_on);
}

void test_only_the_low_eight_bits_of_a_character_reach_the_uart(void)
{
    const char text[] = {(char)0xE9, (char)0xFF, (char)0x80, 'a'};

    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_XBEE, text, 4U));
    TEST_ASSERT_EQUAL_HEX16(0xE9, uarts[BSP_UART_XBEE].wire[0]);
    TEST_ASSERT_EQUAL_HEX16(0xFF, uarts[BSP_UART_XBEE].wire[1]);
    TEST_ASSERT_EQUAL_HEX16(0x80, uarts[BSP_UART_XBEE].wire[2]);
    TEST_ASSERT_EQUAL_HEX16('a', uarts[BSP_UART_XBEE].wire[3]);
}

void test_the_three_uarts_have_rings_of_their_own(void)
{
    static char text[UART_PORT_TRANSMIT_CELLS];

    (void)memset(text, 'x', sizeof text);
    uarts[BSP_UART_LASER].fifo = FIFO;
    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_LASER, text, 1024U));
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(BSP_UART_IMU));
    TEST_ASSERT_EQUAL_UINT16(1024, uart_port_room(BSP_UART_XBEE));
    TEST_ASSERT_TRUE(uart_port_send(BSP_UART_XBEE, "OK", 2U));
    TEST_ASSERT_EQUAL_UINT32(2, uarts[BSP_UART_XBEE].sent);
    TEST_ASSERT_EQUAL_UINT32(0, uarts[BSP_UART_IMU].sent);
    TEST_ASSERT_EQUAL_UINT32(0, uarts[BSP_UART_LASER].sent);
}

void test_start_makes_one_tick_a_millisecond(void)
{
    TEST_ASSERT_EQUAL_UINT16(1, kernel.clock.created);
    TEST_ASSERT_EQUAL_UINT(1, kernel.clock.timeout);
    TEST_ASSERT_EQUAL_UINT32(1, kernel.clock.params.period);
    TEST_ASSERT_TRUE(kernel.clock.params.startFlag);
}

void test_the_level_is_what_the_receiver_asks_for_and_leaves_half_of_the_fifo_free(void)
{
    for (uint16_t asked = 1; asked <= 300U; asked++) {
        uarts[0].asked = asked;
        receive_hwi(BSP_UART_LASER);
        TEST_ASSERT_EQUAL_UINT16(asked < 8U ? asked : 8U, uarts[0].level);
    }
    TEST_ASSERT_EQUAL_UINT16(7, uarts[0].level_changes); /* 1 is there already, 8 is set once */
    TEST_ASSERT_EQUAL_UINT16(0, uarts[1].level_changes);
    TEST_ASSERT_EQUAL_UINT16(0, uarts[2].level_changes);
}

void test_the_tick_takes_what_waits_and_sets_the_next_level(void)
{
    uarts[0].asked = 12U;
    receive_hwi(BSP_UART_LASER);
    uarts[0].burst.count = 7U;
    uarts[0].burst.framing = true;
    uarts[0].asked = 3U;
    tick();
    TEST_ASSERT_EQUAL_UINT16(2, uarts[0].receptions);
    TEST_ASSERT_EQUAL_UINT16(7, uarts[0].received.count);
    TEST_ASSERT_TRUE(uarts[0].received.framing);
    TEST_ASSERT_EQUAL_UINT16(3, uarts[0].level);
}

void test_the_tick_looks_after_every_uart_also_where_every_octet_interrupts(void)
{
    uarts[0].asked = uarts[1].asked = 5U;
    receive_hwi(BSP_UART_LASER);
    receive_hwi(BSP_UART_IMU);
    receive_hwi(BSP_UART_XBEE);
    tick();
    tick();
    for (uint16_t u = 0; u < BSP_UART_COUNT; u++) {
        TEST_ASSERT_EQUAL_UINT16(3, uarts[u].receptions);
    }
    TEST_ASSERT_EQUAL_UINT16(0, uarts[BSP_UART_XBEE].level_changes);
}

void test_a_reopened_uart_begins_with_an_interrupt_per_octet(void)
{
    uarts[0].asked = 12U;
    receive_hwi(BSP_UART_LASER);
    uart_port_reopen(BSP_UART_LASER, 250000U);
    TEST_ASSERT_EQUAL_UINT16(1, uarts[0].level);
    TEST_ASSERT_EQUAL_UINT16(1, uarts[0].receptions);
    receive_hwi(BSP_UART_LASER);
    TEST_ASSERT_EQUAL_UINT16(8, uarts[0].level);
    TEST_ASSERT_EQUAL_UINT16(2, uarts[0].level_changes);
}
