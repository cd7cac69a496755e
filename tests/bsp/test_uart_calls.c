/* Order of the driverlib calls on the UARTs. */
#include "device.h"
#include "mock_hw_types.h"
#include "mock_sci.h"
#include "bsp/uart.h"
#include "unity.h"

static bsp_uart_burst_t burst;

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

void test_open_sets_rate_then_fifos_then_resets_and_enables_interrupts_last(void)
{
    SCI_disableInterrupt_Expect(SCIA_BASE, SCI_INT_RXFF | SCI_INT_TXFF | SCI_INT_RXERR);
    SCI_setConfig_Expect(SCIA_BASE, 100000000U, 115200, 0x0007);
    SCI_setBaud_Expect(SCIA_BASE, 100000000U, 115200); /* after SCI_setConfig, which truncates */
    SCI_resetChannels_Expect(SCIA_BASE);
    SCI_enableFIFO_Expect(SCIA_BASE); /* after SCI_setConfig, which turns it off */
    SCI_setFIFOInterruptLevel_Expect(SCIA_BASE, SCI_FIFO_TX0, SCI_FIFO_RX1);
    SCI_resetTxFIFO_Expect(SCIA_BASE);
    SCI_resetRxFIFO_Expect(SCIA_BASE);
    SCI_performSoftwareReset_Expect(SCIA_BASE);
    SCI_clearOverflowStatus_Expect(SCIA_BASE);
    SCI_clearInterruptStatus_Expect(SCIA_BASE, SCI_INT_RXFF | SCI_INT_TXFF);
    SCI_enableInterrupt_Expect(SCIA_BASE, SCI_INT_RXFF | SCI_INT_RXERR);
    bsp_uart_open(BSP_UART_LASER, 115200);
}

static void expect_octets(uint32_t base, const char *octets, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        SCI_getRxFIFOStatus_ExpectAndReturn(base, (SCI_RxFIFOLevel)(count - i));
        SCI_readCharNonBlocking_ExpectAndReturn(base, (uint16_t)octets[i]);
    }
}

void test_receive_without_error_clears_the_interrupt_flag_only(void)
{
    expect_octets(SCIB_BASE, "ab", 2);
    SCI_getRxFIFOStatus_ExpectAndReturn(SCIB_BASE, SCI_FIFO_RX0);
    SCI_getRxStatus_ExpectAndReturn(SCIB_BASE, SCI_RXSTATUS_READY);
    SCI_getOverflowStatus_ExpectAndReturn(SCIB_BASE, false);
    SCI_clearInterruptStatus_Expect(SCIB_BASE, SCI_INT_RXFF);
    bsp_uart_receive(BSP_UART_IMU, &burst);
    TEST_ASSERT_EQUAL_UINT16(2, burst.count);
    TEST_ASSERT_EQUAL_HEX16('b', burst.octets[1]);
}

void test_receive_saves_the_octets_before_it_resets_and_clears_the_flag_last(void)
{
    expect_octets(SCIC_BASE, "xyz", 3);
    SCI_getRxFIFOStatus_ExpectAndReturn(SCIC_BASE, SCI_FIFO_RX0);
    SCI_getRxStatus_ExpectAndReturn(SCIC_BASE, SCI_RXSTATUS_ERROR | SCI_RXSTATUS_PARITY);
    SCI_getOverflowStatus_ExpectAndReturn(SCIC_BASE, true);
    SCI_performSoftwareReset_Expect(SCIC_BASE);
    SCI_clearOverflowStatus_Expect(SCIC_BASE);
    SCI_clearInterruptStatus_Expect(SCIC_BASE, SCI_INT_RXFF);
    bsp_uart_receive(BSP_UART_XBEE, &burst);
    TEST_ASSERT_EQUAL_UINT16(3, burst.count);
    TEST_ASSERT_TRUE(burst.framing);
    TEST_ASSERT_TRUE(burst.overrun);
}

void test_receive_stops_at_sixteen_however_fast_octets_come(void)
{
    for (unsigned i = 0; i < 16; i++) {
        SCI_getRxFIFOStatus_ExpectAndReturn(SCIA_BASE, SCI_FIFO_RX16);
        SCI_readCharNonBlocking_ExpectAndReturn(SCIA_BASE, (uint16_t)i);
    }
    SCI_getRxStatus_ExpectAndReturn(SCIA_BASE, SCI_RXSTATUS_ERROR | SCI_RXSTATUS_OVERRUN);
    SCI_getOverflowStatus_ExpectAndReturn(SCIA_BASE, false);
    SCI_performSoftwareReset_Expect(SCIA_BASE);
    SCI_clearInterruptStatus_Expect(SCIA_BASE, SCI_INT_RXFF);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(16, burst.count);
    TEST_ASSERT_TRUE(burst.overrun);
    TEST_ASSERT_FALSE(burst.framing);
}

void test_transmit_stops_at_a_full_fifo(void)
{
    static const uint16_t OCTETS[] = {0x1241, 0x42, 0x43};
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIC_BASE, SCI_FIFO_TX14);
    SCI_writeCharNonBlocking_Expect(SCIC_BASE, 0x41);
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIC_BASE, SCI_FIFO_TX15);
    SCI_writeCharNonBlocking_Expect(SCIC_BASE, 0x42);
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIC_BASE, SCI_FIFO_TX16);
    TEST_ASSERT_EQUAL_UINT16(2, bsp_uart_transmit(BSP_UART_XBEE, OCTETS, 3));
}

void test_the_transmit_interrupt_is_off_before_its_flag_is_cleared(void)
{
    SCI_enableInterrupt_Expect(SCIA_BASE, SCI_INT_TXFF);
    bsp_uart_transmit_interrupt_enable(BSP_UART_LASER, true);
    SCI_disableInterrupt_Expect(SCIA_BASE, SCI_INT_TXFF);
    SCI_clearInterruptStatus_Expect(SCIA_BASE, SCI_INT_TXFF);
    bsp_uart_transmit_interrupt_enable(BSP_UART_LASER, false);
    SCI_clearInterruptStatus_Expect(SCIB_BASE, SCI_INT_TXFF);
    bsp_uart_transmit_acknowledge(BSP_UART_IMU);
}

void test_transmitting_asks_the_fifo_then_the_shift_register(void)
{
    static const uint16_t BUSY = SCI_CTL2_TXRDY, EMPTY = SCI_CTL2_TXRDY | SCI_CTL2_TXEMPTY;
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIA_BASE, SCI_FIFO_TX1);
    TEST_ASSERT_TRUE(bsp_uart_transmitting(BSP_UART_LASER));
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIA_BASE, SCI_FIFO_TX0);
    driverlib_halfword_ExpectAndReturn(0x7204, &BUSY);
    TEST_ASSERT_TRUE(bsp_uart_transmitting(BSP_UART_LASER));
    SCI_getTxFIFOStatus_ExpectAndReturn(SCIA_BASE, SCI_FIFO_TX0);
    driverlib_halfword_ExpectAndReturn(0x7204, &EMPTY);
    TEST_ASSERT_FALSE(bsp_uart_transmitting(BSP_UART_LASER));
}

void test_the_receive_level_leaves_the_transmit_interrupt_at_empty(void)
{
    SCI_setFIFOInterruptLevel_Expect(SCIB_BASE, SCI_FIFO_TX0, SCI_FIFO_RX12);
    bsp_uart_set_receive_level(BSP_UART_IMU, 12U);
    SCI_setFIFOInterruptLevel_Expect(SCIA_BASE, SCI_FIFO_TX0, SCI_FIFO_RX1);
    bsp_uart_set_receive_level(BSP_UART_LASER, 1U);
}
