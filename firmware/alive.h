/* Who must be alive for the watchdog to be serviced: TaskControl and TaskSendLaser, each having completed a cycle since
 * the time before. Whether the scanner answers does not matter. */
#ifndef FIRMWARE_ALIVE_H
#define FIRMWARE_ALIVE_H

typedef enum { ALIVE_CONTROL, ALIVE_SEND_LASER, ALIVE_COUNT } alive_t;

/* That task has completed a cycle. Task. */
void alive_report(alive_t task);

/* From now on TaskSendLaser never returns from its report: what the watchdog is for, on purpose. Any task. */
void alive_hang(void);

#endif
