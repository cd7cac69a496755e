/* 115200 is not reachable: SCI_setBaud() rounds to register 108 (-0.45 %), SCI_setConfig() alone would
 * truncate to 107
 * (+0.47 %). The nearer one is taken; 250000, 57600 and 9600 come out the same either way.
 *
 * Only a software reset of the SCI clears a receive error or ends a break. It keeps the FIFOs, but cuts short
 * the octet that is on the transmit wire or just arriving. The receive-error interrupt is on beside the
 * FIFO's, because a break is detected after its last octet has been read, and reception would then stay
 * stopped unseen. */
#include "bsp/uart.h"

#include "device.h"

#define LSPCLK_HZ (DEVICE_SYSCLK_FREQ / 2U)
#define FORMAT_8N1 (SCI_CONFIG_WLEN_8 | SCI_CONFIG_STOP_ONE | (uint32_t)SCI_CONFIG_PAR_NONE)

typedef struct {
    uint32_t base;
    uint32_t receive_interrupt;
    uint32_t transmit_interrupt;
} port_t;

static const port_t PORTS[BSP_UART_COUNT] = {
    [BSP_UART_LASER] = {SCIA_BASE, INT_SCIA_RX, INT_SCIA_TX},
    [BSP_UART_IMU] = {SCIB_BASE, INT_SCIB_RX, INT_SCIB_TX},
    [BSP_UART_XBEE] = {SCIC_BASE, INT_SCIC_RX, INT_SCIC_TX},
};

int16_t bsp_uart_receive_interrupt(bsp_uart_t uart)
{
    return (int16_t)(PORTS[uart].receive_interrupt >> 16);
}

int16_t bsp_uart_transmit_interrupt(bsp_uart_t uart)
{
    return (int16_t)(PORTS[uart].transmit_interrupt >> 16);
}

void bsp_uart_open(bsp_uart_t uart, uint32_t bit_rate)
{
    const uint32_t base = PORTS[uart].base;

    SCI_disableInterrupt(base, SCI_INT_RXFF | SCI_INT_TXFF | SCI_INT_RXERR);
    SCI_setConfig(base, LSPCLK_HZ, bit_rate, FORMAT_8N1);
    SCI_setBaud(base, LSPCLK_HZ, bit_rate);
    SCI_resetChannels(base);
    SCI_enableFIFO(base);
    SCI_setFIFOInterruptLevel(base, SCI_FIFO_TX0, SCI_FIFO_RX1);
    SCI_resetTxFIFO(base);
    SCI_resetRxFIFO(base);
    SCI_performSoftwareReset(base);
    SCI_clearOverflowStatus(base);
    SCI_clearInterruptStatus(base, SCI_INT_RXFF | SCI_INT_TXFF);
    SCI_enableInterrupt(base, SCI_INT_RXFF | SCI_INT_RXERR);
}

void bsp_uart_set_receive_level(bsp_uart_t uart, uint16_t octets)
{
    SCI_setFIFOInterruptLevel(PORTS[uart].base, SCI_FIFO_TX0, (SCI_RxFIFOLevel)octets);
}

static void recover(uint32_t base, bsp_uart_burst_t *burst)
{
    const uint16_t status = SCI_getRxStatus(base);
    const bool overflow = SCI_getOverflowStatus(base);

    burst->overrun = overflow || (status & SCI_RXSTATUS_OVERRUN) != 0U;
    burst->framing = (status & (SCI_RXSTATUS_FRAMING | SCI_RXSTATUS_PARITY | SCI_RXSTATUS_BREAK)) != 0U;
    if ((status & SCI_RXSTATUS_ERROR) != 0U) {
        SCI_performSoftwareReset(base);
    }
    if (overflow) {
        SCI_clearOverflowStatus(base);
    }
}

void bsp_uart_receive(bsp_uart_t uart, bsp_uart_burst_t *burst)
{
    const uint32_t base = PORTS[uart].base;

    burst->count = 0U;
    while (burst->count < BSP_UART_FIFO_DEPTH && SCI_getRxFIFOStatus(base) != SCI_FIFO_RX0) {
        burst->octets[burst->count] = SCI_readCharNonBlocking(base);
        ++burst->count;
    }
    recover(base, burst);
    SCI_clearInterruptStatus(base, SCI_INT_RXFF);
}

uint16_t bsp_uart_transmit(bsp_uart_t uart, const uint16_t *octets, uint16_t count)
{
    const uint32_t base = PORTS[uart].base;
    uint16_t written = 0U;

    while (written < count && SCI_getTxFIFOStatus(base) != SCI_FIFO_TX16) {
        SCI_writeCharNonBlocking(base, octets[written] & 0xFFU);
        ++written;
    }
    return written;
}

void bsp_uart_transmit_interrupt_enable(bsp_uart_t uart, bool on)
{
    const uint32_t base = PORTS[uart].base;

    if (on) {
        SCI_enableInterrupt(base, SCI_INT_TXFF);
    } else {
        SCI_disableInterrupt(base, SCI_INT_TXFF);
        SCI_clearInterruptStatus(base, SCI_INT_TXFF);
    }
}

void bsp_uart_transmit_acknowledge(bsp_uart_t uart)
{
    SCI_clearInterruptStatus(PORTS[uart].base, SCI_INT_TXFF);
}

/* SCI_isTransmitterBusy() looks at the FIFO only; TXEMPTY knows of the octet on the wire. */
bool bsp_uart_transmitting(bsp_uart_t uart)
{
    const uint32_t base = PORTS[uart].base;
    return SCI_getTxFIFOStatus(base) != SCI_FIFO_TX0 || (HWREGH(base + SCI_O_CTL2) & SCI_CTL2_TXEMPTY) == 0U;
}
