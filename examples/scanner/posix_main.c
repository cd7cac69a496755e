/* `scanner DEVICE` prints each distance straight ahead until Ctrl-C. */
#include <signal.h>
#include <stdio.h>

#include "board.h"
#include "posix.h"

static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

void board_show(bool valid, uint16_t distance_mm)
{
    if (valid) {
        printf("%u mm\n", (unsigned)distance_mm);
    } else {
        printf("nothing\n");
    }
    fflush(stdout);
}

bool board_runs(void)
{
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
    signal(SIGINT, stop);
    signal(SIGTERM, stop);
    refused = scanner_run();
    if (refused != NULL) {
        fprintf(stderr, "scanner: %s\n", refused);
        return 1;
    }
    return 0;
}
