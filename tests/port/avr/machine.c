/* Runs the image of a test for a machine with 16-bit int: an ATmega1284P of simavr, with its data space
 * widened to 64 KB and its flash to 192, whose spare I/O registers lead to this program (registers.h). usage:
 * machine IMAGE [CYCLES], the flash as avr-objcopy -O binary writes it, and how long it may take from one
 * line of its output to the next, which is one test: in its own cycles, however busy this PC is. Exit status:
 * the image's own, or 2 when the machine crashed, overflowed its stack, did not end or is not there.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <simavr/sim_avr.h>
#include <simavr/sim_io.h>

#include "registers.h"

#define MCU "atmega1284p"
#define RAM_LAST 0xFFFFU
#define FLASH_LAST 0x2FFFFU /* code has its 128 KB; behind it is what data begins with */
#define CYCLES_MAX \
    2000000000ULL /* two minutes of its time, half a minute of a PC's; left_out.txt goes by it */
#define CYCLES_TOLD 100000000ULL
/* The simulator runs so many cycles before this program looks at it again, which takes as long as a few of
 * them: one at a time makes it half as fast. A push takes two cycles. */
#define CYCLES_AT_ONCE 64U
#define UNSEEN_PUSHES (CYCLES_AT_ONCE / 2U)
#define SP_LOW 0x5DU
#define SP_HIGH 0x5EU

static bool ended;
static int status = 2;
static char path[512];
static size_t path_length;
static FILE *files[FILES_MAX];
static unsigned selected;
static bool end_of_file;
static unsigned stack_floor;
static avr_cycle_count_t line_began;

static void say(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)address, (void)unused;
    putchar(value);
    if (value == '\n') {
        const avr_cycle_count_t took = avr->cycle - line_began;
        if (took > CYCLES_TOLD) {
            printf("machine: that took %llu million cycles\n", (unsigned long long)took / 1000000U);
        }
        line_began = avr->cycle;
    }
}

static void leave(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    status = value;
    ended = true;
}

static void name_file(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    path[path_length] = (char)value;
    path_length = value == 0 ? 0 : (path_length + 1) % (sizeof path - 1);
}

static void select_file(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    selected = value % FILES_MAX;
}

/* Writing opens (1) or closes (0) the selected file; reading tells whether it is open. */
static void open_file(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    if (files[selected] != NULL) {
        fclose(files[selected]);
    }
    files[selected] = value == 1 ? fopen(path, "rb") : NULL;
}

static uint8_t is_open(struct avr_t *avr, avr_io_addr_t address, void *unused)
{
    (void)avr, (void)address, (void)unused;
    return files[selected] != NULL;
}

static uint8_t read_octet(struct avr_t *avr, avr_io_addr_t address, void *unused)
{
    const int octet = files[selected] == NULL ? EOF : fgetc(files[selected]);
    (void)avr, (void)address, (void)unused;
    end_of_file = octet == EOF;
    return (uint8_t)octet;
}

static uint8_t is_at_end(struct avr_t *avr, avr_io_addr_t address, void *unused)
{
    (void)avr, (void)address, (void)unused;
    return end_of_file;
}

static bool load(avr_t *avr, const char *image)
{
    FILE *file = fopen(image, "rb");
    size_t length;
    if (file == NULL) {
        return false;
    }
    length = fread(avr->flash, 1, avr->flashend + 1U, file);
    avr->codeend = (uint32_t)length;
    fclose(file);
    return length > 0;
}

static void set_floor_low(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    stack_floor = (stack_floor & 0xFF00U) | value;
}

static void set_floor_high(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)avr, (void)address, (void)unused;
    stack_floor = (stack_floor & 0xFFU) | (unsigned)value << 8;
}

static void run(avr_t *avr, unsigned long long cycles_max)
{
    while (!ended) {
        const int state = avr_run(avr);
        const unsigned stack = avr->data[SP_LOW] | (unsigned)avr->data[SP_HIGH] << 8;
        if (state == cpu_Done || state == cpu_Crashed) {
            printf("machine: crashed at %lx\n", (unsigned long)avr->pc);
            return;
        }
        if (stack < stack_floor + UNSEEN_PUSHES) {
            printf("machine: the stack at %x reached the variables, code at %lx\n", stack,
                   (unsigned long)avr->pc);
            return;
        }
        if (avr->cycle - line_began > cycles_max) {
            printf("machine: no end after %llu cycles, code at %lx\n", cycles_max, (unsigned long)avr->pc);
            return;
        }
    }
}

int main(int argc, char **argv)
{
    avr_t *avr = avr_make_mcu_by_name(MCU);
    if (argc < 2 || argc > 3 || avr == NULL) {
        fprintf(stderr, "usage: machine IMAGE [CYCLES]\n");
        return 2;
    }
    avr->ramend = RAM_LAST;
    avr->flashend = FLASH_LAST;
    avr_init(avr);
    avr->log = LOG_ERROR;
    avr->frequency = 16000000;
    avr->run_cycle_limit = CYCLES_AT_ONCE;
    avr_register_io_write(avr, REGISTER_SAY, say, NULL);
    avr_register_io_write(avr, REGISTER_LEAVE, leave, NULL);
    avr_register_io_write(avr, REGISTER_NAME, name_file, NULL);
    avr_register_io_write(avr, REGISTER_SELECT, select_file, NULL);
    avr_register_io_write(avr, REGISTER_OPEN, open_file, NULL);
    avr_register_io_read(avr, REGISTER_OPEN, is_open, NULL);
    avr_register_io_read(avr, REGISTER_READ, read_octet, NULL);
    avr_register_io_read(avr, REGISTER_END, is_at_end, NULL);
    avr_register_io_write(avr, REGISTER_FLOOR_LOW, set_floor_low, NULL);
    avr_register_io_write(avr, REGISTER_FLOOR_HIGH, set_floor_high, NULL);
    if (!load(avr, argv[1])) {
        fprintf(stderr, "machine: cannot read %s\n", argv[1]);
        return 2;
    }
    run(avr, argc == 3 ? strtoull(argv[2], NULL, 10) : CYCLES_MAX);
    return status;
}
