/* The LaunchPad's own USB serial port: a COM port of its debugger, on GPIO84. Of the chip's UARTs only the
 * scanner's reaches that pin. */
#ifndef BSP_USB_H
#define BSP_USB_H

#include <stdbool.h>

/* Chooses where the scanner's UART transmits: on the USB serial port (true), or on the scanner's pin, as
 * after bsp_board_init(). It receives from the scanner in both cases. No pin is low meanwhile. Call while
 * nothing is being transmitted, because an octet on the wire would be cut. main() or Task. */
void bsp_usb_transmit(bool on);

#endif
