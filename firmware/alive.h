/* Tasks that must be alive before the watchdog is serviced: TaskControl and TaskSendLaser. Each must have
 * completed a cycle since the last service. Whether the scanner answers does not matter. */
#ifndef FIRMWARE_ALIVE_H
#define FIRMWARE_ALIVE_H

typedef enum { ALIVE_CONTROL, ALIVE_SEND_LASER, ALIVE_COUNT } alive_t;

/* Reports that `task` has completed a cycle. Context: that task. */
void alive_report(alive_t task);

/* Makes TaskSendLaser hang in its next alive_report(), to test the watchdog. Any task. */
void alive_hang(void);

#endif
