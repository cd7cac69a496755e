/* `scanner DEVICE` prints each distance straight ahead until Ctrl-C. */
#include <signal.h>
#include <stdio.h>
#include <time.h>

#include "board.h"
#include "posix.h"

#define PATIENCE_S 12 /* a sensor starts within 10, and has its first scan 2 later */

static volatile sig_atomic_t stopped;
static bool silent = true; /* not a scan yet */
static time_t begun;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

void board_show(bool valid, uint16_t distance_mm)
{
    silent = false;
    if (valid) {
        printf("%u mm\n", (unsigned)distance_mm);
    } else {
        printf("nothing\n");
    }
    fflush(stdout);
}

bool board_runs(void)
{
    if (silent && time(NULL) - begun > PATIENCE_S) {
        silent = false;
        fprintf(stderr, "scanner: no scan yet: the right port? its 5 V? RX and TX crossed? I go on trying\n");
    }
    return stopped == 0;
}

int main(int argc, char **argv)
{
    const char *refused;

    if (argc != 2) {
        fprintf(stderr, "usage: scanner DEVICE\n");
        return 2;
    }
    posix_use(argv[1]);
    begun = time(NULL);
    signal(SIGINT, stop);
    signal(SIGTERM, stop);
    refused = scanner_run();
    if (refused != NULL) {
        fprintf(stderr, "scanner: %s\n", refused);
        return 1;
    }
    return 0;
}
