/* Priorities, periods, deadlines and stacks of the six tasks and three Swis (seed document, Annex IV). A
 * larger number is a higher priority. Periods are in Clock ticks of 1 ms, stacks in 16-bit cells. */
#ifndef FIRMWARE_SCHEDULE_H
#define FIRMWARE_SCHEDULE_H

#define TASK_IMU_PRIORITY 6
#define TASK_RECEIVE_LASER_PRIORITY 5
#define TASK_CONTROL_PRIORITY 4
#define TASK_SEND_LASER_PRIORITY 3
#define TASK_SEND_COMM_PRIORITY 2
#define TASK_RECEIVE_COMM_PRIORITY 1

#define IMU_SWI_PRIORITY 3U
#define LASER_SWI_PRIORITY 2U
#define XBEE_SWI_PRIORITY 1U

#define CONTROL_PERIOD_MS 108U  /* release FREE */
#define CONTROL_TIMEOUT_MS 150U /* TaskControl runs at least this often, with any RELEASE */
#define SEND_LASER_PERIOD_MS 150U
#define SEND_LASER_TICK_MS 10U   /* of its Clock */
#define SEND_LASER_SEARCH_MS 40U /* shortest distance, while a lost scanner is searched: urg_pause_us() */
#define SEND_COMM_PERIOD_MS 200U

/* Deadlines, counted from the release. For a sporadic task: its shortest distance between two releases. */
#define TASK_IMU_DEADLINE_MS 25U
#define TASK_RECEIVE_LASER_DEADLINE_MS 100U
#define TASK_CONTROL_DEADLINE_MS 108U      /* release FREE */
#define TASK_CONTROL_SCAN_DEADLINE_MS 100U /* with each scan */
#define TASK_CONTROL_FRAME_DEADLINE_MS 25U /* with each IMU frame */
#define TASK_SEND_LASER_DEADLINE_MS 150U
#define TASK_SEND_COMM_DEADLINE_MS 200U
#define TASK_RECEIVE_COMM_DEADLINE_MS 300U

#define TASK_STACK_CELLS 1152U         /* docs/memory.md tells how much each task needs */
#define TASK_CONTROL_STACK_CELLS 1792U /* its own: the belief over three mirrors */

#if CONTROL_PERIOD_MS >= 65535U || CONTROL_TIMEOUT_MS >= 65535U
#error "SYS/BIOS takes 65535 ticks for ever on a C28x"
#endif

#endif
