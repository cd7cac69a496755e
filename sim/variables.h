/* The firmware's variables. The build gives their sections names of their own (room() in the top
 * CMakeLists.txt), so that the firmware alone can be put back to where the start-up code of the chip begins
 * it. */
#ifndef SIM_VARIABLES_H
#define SIM_VARIABLES_H

/* Every variable of the product as before main(), but those in section .retained. Not while the firmware
 * runs. */
void variables_reset(void);

#endif
