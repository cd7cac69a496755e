/* What the board tells on the LaunchPad's own USB serial port, so that it can be tried with nothing but a USB
 * cable: its version, then the lines of `#PERF`, over and over, at 115200 bit/s, 8N1. It only talks.
 *
 * The port has no UART of its own. It borrows the transmitter of the scanner's, which has nothing to say
 * while it waits for the scanner to start up (LASER_WAIT_US). After a watchdog reset there is no such wait,
 * and no word here. Nobody needs to listen: there is no handshake. */
#ifndef FIRMWARE_USB_PORT_H
#define FIRMWARE_USB_PORT_H

/* Borrows the transmitter and tells the version. The first octets go out even when the kernel never starts.
 * The scanner's UART is open, at its first rate. main(). */
void usb_port_start(void);

/* Tells the next line. Does nothing unless the transmitter is borrowed. Calls are at least a line's time
 * apart. TaskSendLaser. */
void usb_port_step(void);

/* Gives the transmitter back: before the first octet for the scanner. TaskSendLaser. */
void usb_port_end(void);

#endif
