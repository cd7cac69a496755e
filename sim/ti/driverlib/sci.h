/* SCI (UART): the used subset of TI's driverlib header of this name, plain functions. Modelled: 8N1 with the
 * FIFOs on; with the FIFOs off nothing is sent or received. While the peripheral clock is off writes are
 * lost, reads give 0. */
#ifndef SCI_H
#define SCI_H

#include <stdbool.h>
#include <stdint.h>

#include "inc/hw_memmap.h"
#include "inc/hw_sci.h"
#include "inc/hw_types.h"

#define SCI_INT_RXERR 0x01U
#define SCI_INT_RXRDY_BRKDT 0x02U
#define SCI_INT_TXRDY 0x04U
#define SCI_INT_TXFF 0x08U
#define SCI_INT_RXFF 0x10U
#define SCI_INT_FE 0x20U
#define SCI_INT_OE 0x40U
#define SCI_INT_PE 0x80U

#define SCI_CONFIG_WLEN_8 0x0007U
#define SCI_CONFIG_STOP_ONE 0x0000U
#define SCI_CONFIG_STOP_TWO 0x0080U

typedef enum {
    SCI_CONFIG_PAR_NONE = 0x0000U,
    SCI_CONFIG_PAR_EVEN = 0x0060U,
    SCI_CONFIG_PAR_ODD = 0x0020U
} SCI_ParityType;

#define SCI_RXSTATUS_WAKE 0x0002U
#define SCI_RXSTATUS_PARITY 0x0004U
#define SCI_RXSTATUS_OVERRUN 0x0008U
#define SCI_RXSTATUS_FRAMING 0x0010U
#define SCI_RXSTATUS_BREAK 0x0020U
#define SCI_RXSTATUS_READY 0x0040U
#define SCI_RXSTATUS_ERROR 0x0080U

typedef enum {
    SCI_FIFO_TX0 = 0,
    SCI_FIFO_TX1 = 1,
    SCI_FIFO_TX2 = 2,
    SCI_FIFO_TX3 = 3,
    SCI_FIFO_TX4 = 4,
    SCI_FIFO_TX5 = 5,
    SCI_FIFO_TX6 = 6,
    SCI_FIFO_TX7 = 7,
    SCI_FIFO_TX8 = 8,
    SCI_FIFO_TX9 = 9,
    SCI_FIFO_TX10 = 10,
    SCI_FIFO_TX11 = 11,
    SCI_FIFO_TX12 = 12,
    SCI_FIFO_TX13 = 13,
    SCI_FIFO_TX14 = 14,
    SCI_FIFO_TX15 = 15,
    SCI_FIFO_TX16 = 16
} SCI_TxFIFOLevel;

typedef enum {
    SCI_FIFO_RX0 = 0,
    SCI_FIFO_RX1 = 1,
    SCI_FIFO_RX2 = 2,
    SCI_FIFO_RX3 = 3,
    SCI_FIFO_RX4 = 4,
    SCI_FIFO_RX5 = 5,
    SCI_FIFO_RX6 = 6,
    SCI_FIFO_RX7 = 7,
    SCI_FIFO_RX8 = 8,
    SCI_FIFO_RX9 = 9,
    SCI_FIFO_RX10 = 10,
    SCI_FIFO_RX11 = 11,
    SCI_FIFO_RX12 = 12,
    SCI_FIFO_RX13 = 13,
    SCI_FIFO_RX14 = 14,
    SCI_FIFO_RX15 = 15,
    SCI_FIFO_RX16 = 16
} SCI_RxFIFOLevel;

/* Stops the SCI, turns the FIFOs off, sets format and baud rate register (quotient truncated), starts the
 * SCI. */
void SCI_setConfig(uint32_t base, uint32_t lspclkHz, uint32_t baud, uint32_t config);
/* Baud rate register alone, rounded to the nearest. */
void SCI_setBaud(uint32_t base, uint32_t lspclkHz, uint32_t baud);

void SCI_enableModule(uint32_t base);
void SCI_disableModule(uint32_t base);
/* Clears the receive errors, lets reception go on after a break, cuts short the octet on the transmit wire
 * and the one that is just arriving. Keeps the configuration and what is in the FIFOs. */
void SCI_performSoftwareReset(uint32_t base);
void SCI_resetChannels(uint32_t base);

void SCI_enableFIFO(uint32_t base);
void SCI_resetRxFIFO(uint32_t base);
void SCI_resetTxFIFO(uint32_t base);
void SCI_setFIFOInterruptLevel(uint32_t base, SCI_TxFIFOLevel txLevel, SCI_RxFIFOLevel rxLevel);
SCI_TxFIFOLevel SCI_getTxFIFOStatus(uint32_t base);
SCI_RxFIFOLevel SCI_getRxFIFOStatus(uint32_t base);

/* Transmit FIFO not empty. Says nothing of the octet on the wire: see TXEMPTY in SCICTL2. */
bool SCI_isTransmitterBusy(uint32_t base);
/* A full FIFO drops the character. */
void SCI_writeCharNonBlocking(uint32_t base, uint16_t data);
/* The oldest character in the FIFO without its two error flags, 0 when there is none. */
uint16_t SCI_readCharNonBlocking(uint32_t base);

/* RXFF, TXFF and RXERR are modelled. */
void SCI_enableInterrupt(uint32_t base, uint32_t intFlags);
void SCI_disableInterrupt(uint32_t base, uint32_t intFlags);
/* A flag comes back, as a new interrupt, while its condition holds. Clearing an error flag is a software
 * reset. */
void SCI_clearInterruptStatus(uint32_t base, uint32_t intFlags);

uint16_t SCI_getRxStatus(uint32_t base);
/* While the overflow flag is set the RXFF interrupt stays silent. */
bool SCI_getOverflowStatus(uint32_t base);
void SCI_clearOverflowStatus(uint32_t base);

#endif
