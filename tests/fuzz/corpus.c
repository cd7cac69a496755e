/* The fuzz target without libFuzzer: over inputs made here (mutations of a few good ones), or over files.
 *
 *   corpus [-n RUNS] [-s SEED]   runs
 *   corpus -w DIRECTORY          writes the good inputs, for libFuzzer to begin with
 *   corpus FILE...               runs these, for instance one that libFuzzer found */
#include <getopt.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INPUT_MAX 1024

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct {
    const char *octets;
    size_t length;
} good[] = {
#define INPUT(text) \
    { \
        text, sizeof text - 1 \
    }
    INPUT("MS0372040601000\n00P\n\n\x87\x11\x87\x12\x88\x35\x87\x13MS0372040601000\n50U\n\n"),
    INPUT("\x81\x08\x85"
          "00P\n\n\x87\x01\x87\x02\x88\x71\x87\x03"),
    INPUT("\x81\x05\x87\x21\x81\x06\x87\x31\x81\x07\x87\x41\x81\x0d\x87\x51\x82\x02\x87\x52\x82\x01\x87\x53"),
    INPUT("\x81\x80L0\n0\n\n\x81\x81SCIP2.0\n0\n\n\x81\x82QT\n00P\n\n\x81\x82QT\nE\n\n"),
    INPUT("\x81\x83TM1\n00P\n0001\x84\n\x81\x87RS\n00P\n\n"),
    INPUT("\x81\x84VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nSERI:H0706400;F\nI\n\n"),
    INPUT("\x81\x85PP\n00P\nDMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\nAMAX:725;o\nAFRT:384;6\nSCAN:"
          "600;e\n\n"),
    INPUT("\x81\x86II\n00P\nLASR:ON;9\nSBPS:19200[bps]\nTIME:00173B;V\nSTAT:Sensor works well.;8\n\n"),
    INPUT("\x81\x04\x85\x86\x83"
          "0001\x84"
          "CB\x84\n\x87\x09"),
    INPUT("\x81\x14\x87\x01\x81\x17\x87\x02\x82\x02\x87\x03\x82\x01\x87\x04"),
    INPUT("xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
          "\x87\x01"
          "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\x87\x02"),
    INPUT("\x81\x01\x85\x86"
          "0001\x84"
          "1Dh9H09H09H09H09H09H09H0"
          "\x84\n\x83x\x80\xff\x87\x07"),
};
#define GOOD (sizeof good / sizeof good[0])

static uint64_t state;

static uint32_t roll(uint32_t limit)
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return (uint32_t)(((state * 0x2545F4914F6CDD1DULL) >> 32) * limit >> 32);
}

static size_t append(uint8_t *input, size_t length, const char *octets, size_t count)
{
    count = count < INPUT_MAX - length ? count : INPUT_MAX - length;
    memcpy(input + length, octets, count);
    return length + count;
}

static size_t mutate(uint8_t *input, size_t length)
{
    const size_t at = roll((uint32_t)length);

    switch (roll(4)) {
    case 0:
        input[at] = (uint8_t)roll(256);
        break;
    case 1:
        input[at] ^= (uint8_t)(1U << roll(8));
        break;
    case 2:
        memmove(input + at, input + at + 1, length - at - 1);
        return length - 1;
    default:
        if (length < INPUT_MAX) {
            memmove(input + at + 1, input + at, length - at);
            input[at] = (uint8_t)(roll(3) == 0 ? 0x80 + roll(9) : roll(256));
            return length + 1;
        }
    }
    return length;
}

/* Up to five good inputs one after the other, with up to seven changes. */
static void run_one(void)
{
    uint8_t input[INPUT_MAX];
    size_t length = 0;

    for (uint32_t parts = 1 + roll(5); parts > 0; parts--) {
        const size_t which = roll(GOOD);
        length = append(input, length, good[which].octets, good[which].length);
    }
    for (uint32_t changes = roll(8); changes > 0 && length > 1; changes--) {
        length = mutate(input, length);
    }
    LLVMFuzzerTestOneInput(input, length);
}

static int run_file(const char *name)
{
    static uint8_t input[1 << 20];
    FILE *file = fopen(name, "rb");

    if (file == NULL) {
        perror(name);
        return 1;
    }
    const size_t length = fread(input, 1, sizeof input, file);
    fclose(file);
    LLVMFuzzerTestOneInput(input, length);
    return 0;
}

static int write_good(const char *directory)
{
    for (size_t i = 0; i < GOOD; i++) {
        char name[512];
        snprintf(name, sizeof name, "%s/good%zu", directory, i);
        FILE *file = fopen(name, "wb");
        if (file == NULL) {
            perror(name);
            return 1;
        }
        fwrite(good[i].octets, 1, good[i].length, file);
        fclose(file);
    }
    return 0;
}

int main(int argc, char **argv)
{
    unsigned long runs = 100000;
    int option, failed = 0;

    state = 20260801;
    while ((option = getopt(argc, argv, "n:s:w:")) != -1) {
        switch (option) {
        case 'n':
            runs = strtoul(optarg, NULL, 10);
            break;
        case 's':
            state = strtoull(optarg, NULL, 10);
            break;
        case 'w':
            return write_good(optarg);
        default:
            fprintf(stderr, "usage: corpus [-n RUNS] [-s SEED] [-w DIRECTORY] [FILE...]\n");
            return 2;
        }
    }
    for (int i = optind; i < argc; i++) {
        failed |= run_file(argv[i]);
    }
    if (optind == argc) {
        printf("%lu inputs, seed %llu\n", runs, (unsigned long long)state);
        for (unsigned long i = 0; i < runs; i++) {
            run_one();
        }
    }
    return failed;
}
