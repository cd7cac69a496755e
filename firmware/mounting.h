/* How the scanner is used on this vehicle: bit rates and time to start. Which rays look at which mirror is
 * said by parameters (firmware/geometry.h). */
#ifndef FIRMWARE_MOUNTING_H
#define FIRMWARE_MOUNTING_H

#define LASER_FIRST_RATE 115200UL  /* bits per second after power-up, where none is stored */
#define LASER_STREAM_RATE 250000UL /* bits per second; the MAX3222's limit, no higher rate is tried */
#define LASER_WAIT_US 10000000UL   /* start-up time of sensor and RS232 adapter, seed document 5.2.1.3 */

#endif
