/* The board, as TI's device.h describes it when _LAUNCHXL_F28377S is defined: 10 MHz crystal, SYSCLK 200 MHz,
 * LEDs. The chip model is this board always; on the target a build without the define is for another one. */
#ifndef DEVICE_H
#define DEVICE_H

#include "driverlib.h"

#define DEVICE_GPIO_PIN_LED1 12U /* LD9, red */
#define DEVICE_GPIO_PIN_LED2 13U /* LD10, blue */
#define DEVICE_GPIO_CFG_LED1 GPIO_12_GPIO12
#define DEVICE_GPIO_CFG_LED2 GPIO_13_GPIO13

#define DEVICE_GPIO_PIN_SCIRXDA 85U
#define DEVICE_GPIO_PIN_SCITXDA 84U
#define DEVICE_GPIO_CFG_SCIRXDA GPIO_85_SCIRXDA
#define DEVICE_GPIO_CFG_SCITXDA GPIO_84_SCITXDA

#define DEVICE_OSCSRC_FREQ 10000000U
#define DEVICE_SETCLOCK_CFG \
    (SYSCTL_OSCSRC_XTAL | SYSCTL_IMULT(40) | SYSCTL_FMULT_NONE | SYSCTL_SYSDIV(2) | SYSCTL_PLL_ENABLE)
#define DEVICE_SYSCLK_FREQ ((DEVICE_OSCSRC_FREQ * 40 * 1) / 2)
#define DEVICE_LSPCLK_FREQ (DEVICE_SYSCLK_FREQ / 4) /* for the reset prescaler of 4 only */

#endif
