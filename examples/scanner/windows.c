/* board.h on Windows (compiled in continuous integration, not tried): `scanner COM5` prints each distance
 * straight ahead. Any bit rate that the port can make, 250000 too. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <windows.h>

#include "board.h"

#define PATIENCE_S 12 /* a sensor starts within 10, and has its first scan 2 later */
#define WAIT_MS 5     /* less than an eighth of what urg_pause_us() asks for at least */

static const char *device;
static HANDLE port = INVALID_HANDLE_VALUE;
static volatile sig_atomic_t stopped;
static bool silent = true; /* not a scan yet */
static time_t begun;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

static void fail(const char *what)
{
    fprintf(stderr, "scanner: %s: %s (error %lu)\n", device, what, (unsigned long)GetLastError());
    exit(1);
}

uint32_t board_time_us(void)
{
    LARGE_INTEGER ticks, ticks_per_s;
    uint64_t seconds, rest;

    QueryPerformanceFrequency(&ticks_per_s);
    QueryPerformanceCounter(&ticks);
    seconds = (uint64_t)(ticks.QuadPart / ticks_per_s.QuadPart);
    rest = (uint64_t)(ticks.QuadPart % ticks_per_s.QuadPart);
    return (uint32_t)(seconds * 1000000U + rest * 1000000U / (uint64_t)ticks_per_s.QuadPart);
}

static void open_port(void)
{
    char name[64];
    COMMTIMEOUTS limits = {0};

    snprintf(name, sizeof name, "\\\\.\\%s", device); /* COM10 and above have no other name */
    port = CreateFileA(name, GENERIC_READ | GENERIC_WRITE, 0, NULL, OPEN_EXISTING, 0, NULL);
    limits.ReadIntervalTimeout = MAXDWORD; /* so a read waits for the first octet, and takes what is there */
    limits.ReadTotalTimeoutMultiplier = MAXDWORD;
    limits.ReadTotalTimeoutConstant = WAIT_MS;
    limits.WriteTotalTimeoutConstant = 100; /* 21 octets at 19200 bit/s take 11 */
    if (port == INVALID_HANDLE_VALUE || !SetCommTimeouts(port, &limits)) {
        fail("cannot be opened");
    }
}

void board_uart_open(uint32_t bit_rate)
{
    DCB settings = {0};

    if (port == INVALID_HANDLE_VALUE) {
        open_port();
    }
    settings.DCBlength = sizeof settings;
    settings.BaudRate = bit_rate;
    settings.ByteSize = 8;
    settings.Parity = NOPARITY;
    settings.StopBits = ONESTOPBIT;
    settings.fBinary = TRUE;
    settings.fDtrControl = DTR_CONTROL_ENABLE; /* some converters are powered by it */
    settings.fRtsControl = RTS_CONTROL_ENABLE;
    if (!SetCommState(port, &settings)) {
        fail("cannot make this bit rate");
    }
}

size_t board_uart_read(octet_t *octets, size_t most)
{
    DWORD count = 0;

    if (!ReadFile(port, octets, (DWORD)most, &count, NULL)) {
        fail("is gone");
    }
    return count;
}

void board_uart_write(const octet_t *octets, size_t count)
{
    DWORD taken = 0;

    if (!WriteFile(port, octets, (DWORD)count, &taken, NULL) || taken != count) {
        fail("takes nothing");
    }
}

/* Windows tells that there were some, not how many. */
uint32_t board_uart_errors(void)
{
    DWORD errors = 0;

    if (!ClearCommError(port, &errors, NULL)) {
        fail("is gone");
    }
    return (errors & (CE_FRAME | CE_OVERRUN | CE_RXOVER)) != 0 ? 1 : 0;
}

void board_cycle_sensor_power(void) {}

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
        fprintf(stderr, "usage: scanner COM5\n");
        return 2;
    }
    device = argv[1];
    begun = time(NULL);
    signal(SIGINT, stop);
    refused = scanner_run();
    if (refused != NULL) {
        fprintf(stderr, "scanner: %s\n", refused);
        return 1;
    }
    return 0;
}
