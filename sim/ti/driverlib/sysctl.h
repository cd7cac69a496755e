/* Clocks, peripheral gates and watchdog: the used subset of TI's driverlib header of this name, plain
 * functions. */
#ifndef SYSCTL_H
#define SYSCTL_H

#include <stdbool.h>
#include <stdint.h>

#define SYSCTL_SYSDIV_M 0x00001F80UL
#define SYSCTL_SYSDIV_S 7U
#define SYSCTL_SYSDIV(x) ((((x) / 2U) << SYSCTL_SYSDIV_S) & SYSCTL_SYSDIV_M)
#define SYSCTL_IMULT_M 0x0000007FUL
#define SYSCTL_IMULT_S 0U
#define SYSCTL_IMULT(x) (((x) << SYSCTL_IMULT_S) & SYSCTL_IMULT_M)
#define SYSCTL_FMULT_M 0x00006000UL
#define SYSCTL_FMULT_S 13U
#define SYSCTL_FMULT_NONE 0x00000000UL
#define SYSCTL_OSCSRC_M 0x00030000UL
#define SYSCTL_OSCSRC_S 16U
#define SYSCTL_OSCSRC_OSC2 0x00000000UL
#define SYSCTL_OSCSRC_XTAL 0x00010000U
#define SYSCTL_OSCSRC_OSC1 0x00020000UL
#define SYSCTL_PLL_ENABLE 0x80000000U
#define SYSCTL_PLL_DISABLE 0x00000000U
#define SYSCTL_DEFAULT_OSC_FREQ 10000000U

#define SYSCTL_CAUSE_POR 0x00000001U
#define SYSCTL_CAUSE_XRS 0x00000002U
#define SYSCTL_CAUSE_WDRS 0x00000004U
#define SYSCTL_CAUSE_NMIWDRS 0x00000008U
#define SYSCTL_CAUSE_SCCRESET 0x00000100U

typedef enum { SYSCTL_WD_MODE_RESET, SYSCTL_WD_MODE_INTERRUPT } SysCtl_WDMode;

typedef enum {
    SYSCTL_WD_PRESCALE_1 = 1,
    SYSCTL_WD_PRESCALE_2 = 2,
    SYSCTL_WD_PRESCALE_4 = 3,
    SYSCTL_WD_PRESCALE_8 = 4,
    SYSCTL_WD_PRESCALE_16 = 5,
    SYSCTL_WD_PRESCALE_32 = 6,
    SYSCTL_WD_PRESCALE_64 = 7
} SysCtl_WDPrescaler;

/* Bit << 8 | number of the PCLKCR register. */
typedef enum {
    SYSCTL_PERIPH_CLK_TIMER0 = 0x0300,
    SYSCTL_PERIPH_CLK_TIMER1 = 0x0400,
    SYSCTL_PERIPH_CLK_TIMER2 = 0x0500,
    SYSCTL_PERIPH_CLK_TBCLKSYNC = 0x1200,
    SYSCTL_PERIPH_CLK_EPWM2 = 0x0102,
    SYSCTL_PERIPH_CLK_ECAP1 = 0x0003,
    SYSCTL_PERIPH_CLK_SCIA = 0x0007,
    SYSCTL_PERIPH_CLK_SCIB = 0x0107,
    SYSCTL_PERIPH_CLK_SCIC = 0x0207,
    SYSCTL_PERIPH_CLK_ADCA = 0x000D
} SysCtl_PeripheralPCLOCKCR;

typedef enum {
    SYSCTL_LSPCLK_PRESCALE_1 = 0,
    SYSCTL_LSPCLK_PRESCALE_2 = 1,
    SYSCTL_LSPCLK_PRESCALE_4 = 2,
    SYSCTL_LSPCLK_PRESCALE_6 = 3,
    SYSCTL_LSPCLK_PRESCALE_8 = 4,
    SYSCTL_LSPCLK_PRESCALE_10 = 5,
    SYSCTL_LSPCLK_PRESCALE_12 = 6,
    SYSCTL_LSPCLK_PRESCALE_14 = 7
} SysCtl_LSPCLKPrescaler;

typedef enum { SYSCTL_EPWMCLK_DIV_1, SYSCTL_EPWMCLK_DIV_2 } SysCtl_EPWMCLKDivider;

/* Oscillator, PLL and divider from one word. False when the clock of the oscillator failed. TI's takes some
 * milliseconds and spins for ever on a crystal that never starts; this one takes no virtual time. It borrows
 * CPU timers 1 and 2: their settings are restored, their counts are not. */
bool SysCtl_setClock(uint32_t config);
/* SYSCLK in Hz; the argument is the frequency of the crystal. */
uint32_t SysCtl_getClock(uint32_t clockInHz);
/* SYSCLKDIVSEL: 0 divides by 1, n by 2n. */
void SysCtl_setPLLSysClk(uint16_t divider);
void SysCtl_setLowSpeedClock(SysCtl_LSPCLKPrescaler prescaler);
void SysCtl_setEPWMClockDivider(SysCtl_EPWMCLKDivider divider);
void SysCtl_enablePeripheral(SysCtl_PeripheralPCLOCKCR peripheral);
void SysCtl_disablePeripheral(SysCtl_PeripheralPCLOCKCR peripheral);

/* The watchdog: 8 bits, from reset on counting internal oscillator 1 (10 MHz) / 512 / prescaler, at first 1.
 * When it overflows the chip is reset; the interrupt in place of the reset is not modelled. */
void SysCtl_setWatchdogMode(SysCtl_WDMode mode);
void SysCtl_setWatchdogPrescaler(SysCtl_WDPrescaler prescaler);
void SysCtl_enableWatchdog(void);
/* Stops the count where it stands. */
void SysCtl_disableWatchdog(void);
/* The count begins again at 0. */
void SysCtl_serviceWatchdog(void);

/* Sticky, so possibly several. A watchdog reset also pulls the reset pin. What the boot ROM noted of power-on
 * and pin is added, and stays after a clear. */
uint32_t SysCtl_getResetCause(void);
void SysCtl_clearResetCause(uint32_t rstCauses);

#endif
