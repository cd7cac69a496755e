/* The laws, a row each: LAW(name, its step, what releases its cycles).
 *
 * Everything that knows the laws by name takes them from here: the choices of the parameter LAW, and so #LAW,
 * #HELP, the ground page, `plomada params` and the campaigns; the step that flies (laws.c); the events that
 * release it. So a new law is its file and its row. The order is that of control_law_t. The row's function
 * has the form law_step_t. */
#ifndef CONTROL_LAWS_TABLE_H
#define CONTROL_LAWS_TABLE_H

#define LAWS(LAW) \
    LAW(PD, law_pid_step, CYCLES_BY_RELEASE) \
    LAW(PID, law_pid_step, CYCLES_BY_RELEASE) \
    LAW(PIDT, law_pidt_step, CYCLES_BY_HEIGHT) \
    LAW(EST, law_est_hold, CYCLES_BY_FRAME)

/* What releases the cycles of a law. */
typedef enum {
    CYCLES_BY_RELEASE, /* as the parameter RELEASE says: a period of its own, or each height */
    CYCLES_BY_HEIGHT,  /* each height */
    CYCLES_BY_FRAME    /* each IMU frame and each height */
} law_cycles_t;

#endif
