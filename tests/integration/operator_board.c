/* The PC board in virtual time for a script, with everybody around it: an operator who types, a pilot with
 * switch and sticks, hands that hold the vehicle. Each line of the standard input is an order; its answer is
 * what the operator's terminal has received meanwhile, and a line with a point.
 *
 *   on [running]                power on; what was stored is kept. Held on the ground, switch at the pilot;
 *                               or free, motors running whatever is commanded, the firmware's throttle
 *   type TEXT                   a line, Enter behind it
 *   wait SECONDS
 *   hold METRES ROLL PITCH      in two seconds brought there and held: degrees, right side and nose up
 *   free                        let go: flies by its own motors
 *   switch pilot|launchpad
 *   stick SHARE                 of the throttle's range
 *   corners on|off              both sticks in the lower corners
 *   laser on|off, imu on|off    its plug
 *   mirror covered|free
 *   keep                        a copy goes on from here
 *   back                        the copy ends, and what it went through has not happened
 *   truth                       answers `= height_m thrust_n motors` */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sim/board.h"
#include "sim/timeline.h"

#define HEARD_MAX 2000000U
#define FRAME (20 * SIM_MS) /* of the receiver */
#define MOVE_STEPS 100
#define NO_THRUST_US 2000.0
#define FULL_US 1000.0

static board_config_t config;
static bool is_on;
static char heard[HEARD_MAX];
static size_t heard_count;
static double stick_share;
static unsigned long seed = 1; /* or the program's argument */

static void terminal(void *context, unsigned octet)
{
    (void)context;
    if (heard_count < HEARD_MAX) {
        heard[heard_count++] = (char)octet;
    }
}

/* Whole lines; the rest stays for the next answer. */
static void answer(void)
{
    size_t whole = heard_count;

    while (whole > 0U && heard[whole - 1U] != '\n') {
        whole--;
    }
    fwrite(heard, 1U, whole, stdout);
    memmove(heard, heard + whole, heard_count - whole);
    heard_count -= whole;
    puts(".");
    fflush(stdout);
}

static void stick_frame(void *unused)
{
    (void)unused;
    (void)timeline_after(FRAME, stick_frame, NULL);
    board_stick((sim_time_t)((NO_THRUST_US + (FULL_US - NO_THRUST_US) * stick_share) * 1e3));
}

static void switch_on(bool running)
{
    if (is_on) {
        board_power_off();
    }
    config = board_config(seed);
    config.quadrotor.anchored = !running;
    config.quadrotor.sag_per_s = 0.0; /* an evening has more than one battery */
    config.quadrotor.naza.stop_type = running ? NAZA_ALWAYS_ARMED : NAZA_IMMEDIATELY;
    board_power_on(&config, terminal, NULL);
    quadrotor_set_origin(board_quadrotor(), timeline_now()); /* scenario time: since power-on */
    board_select(running);
    stick_share = 0.0;
    stick_frame(NULL);
    is_on = true;
}

static void let_pass(double seconds)
{
    if (!kernel_run_until(timeline_now() + (sim_time_t)llround(seconds * 1e9))) {
        fprintf(stderr, "the firmware has stopped: %s\n", kernel_halt_reason());
        exit(1);
    }
}

static void hold(const char *where)
{
    const quadrotor_config_t from = config.quadrotor;
    quadrotor_config_t *now = &config.quadrotor;
    double height_m, roll_deg, pitch_deg;

    if (sscanf(where, "%lf %lf %lf", &height_m, &roll_deg, &pitch_deg) != 3) {
        exit(2);
    }
    now->anchored = true;
    for (int i = 1; i <= MOVE_STEPS; i++) {
        const double share = (double)i / MOVE_STEPS;

        now->bench_height_m = from.bench_height_m + share * (height_m - from.bench_height_m);
        now->bench_roll_rad = from.bench_roll_rad + share * (roll_deg * M_PI / 180.0 - from.bench_roll_rad);
        now->bench_pitch_rad = from.bench_pitch_rad +
                               share * (pitch_deg * M_PI / 180.0 - from.bench_pitch_rad);
        board_change(&config);
        let_pass(2.0 / MOVE_STEPS);
    }
}

static void tell_truth(void)
{
    const quadrotor_state_t *state = quadrotor_state(board_quadrotor());

    printf("= %.3f %.2f %d\n", state->height_m, state->thrust_n, state->motors ? 1 : 0);
}

static void set_free(void)
{
    config.quadrotor.anchored = false;
    board_change(&config);
}

static void type(const char *text)
{
    board_type(text, strlen(text));
    board_type("\r", 1U);
}

/* Returns in the copy; then again, in whoever was copied, when the copy was told to go back. */
static void keep(void)
{
    int status = 1;
    const pid_t copy = fork();

    if (copy != 0 && (waitpid(copy, &status, 0) != copy || status != 0)) {
        exit(1);
    }
}

static void obey(const char *order, const char *rest)
{
    const bool on = strcmp(rest, "on") == 0;

    if (strcmp(order, "on") == 0) {
        switch_on(strcmp(rest, "running") == 0);
    } else if (strcmp(order, "type") == 0) {
        type(rest);
    } else if (strcmp(order, "wait") == 0) {
        let_pass(atof(rest));
    } else if (strcmp(order, "hold") == 0) {
        hold(rest);
    } else if (strcmp(order, "free") == 0) {
        set_free();
    } else if (strcmp(order, "switch") == 0) {
        board_select(strcmp(rest, "launchpad") == 0);
    } else if (strcmp(order, "stick") == 0) {
        stick_share = atof(rest);
    } else if (strcmp(order, "corners") == 0) {
        quadrotor_hold_corners(board_quadrotor(), on);
    } else if (strcmp(order, "laser") == 0) {
        board_power_laser(on);
    } else if (strcmp(order, "imu") == 0) {
        board_power_imu(on);
    } else if (strcmp(order, "mirror") == 0) {
        config.scene.rays_lost = strcmp(rest, "covered") == 0 ? 1.0 : 0.0;
        board_change(&config);
    } else if (strcmp(order, "keep") == 0) {
        keep();
    } else if (strcmp(order, "back") == 0) {
        _exit(0); /* whoever was copied answers */
    } else if (strcmp(order, "truth") == 0) {
        tell_truth();
    } else {
        fprintf(stderr, "no such order: %s\n", order);
        exit(2);
    }
}

int main(int argc, char **argv)
{
    char line[256];

    if (argc > 1) {
        seed = strtoul(argv[1], NULL, 10);
    }
    switch_on(false);
    while (fgets(line, sizeof line, stdin) != NULL) {
        char *rest = line + strcspn(line, " \n");

        line[strcspn(line, "\n")] = '\0';
        if (*rest != '\0') {
            *rest++ = '\0';
        }
        obey(line, rest);
        answer();
    }
    return 0;
}
