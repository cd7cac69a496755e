#include "scip.h"

#include <stdio.h>
#include <string.h>

#include "commands.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
} tools[] = {
    {"decode", scip_decode, "FILE|-                 scans of a recording, also of flexiport, as CSV"},
    {"mirrors", scip_mirrors, "FILE|DEVICE --height M which steps look at which mirror"},
    {"record", scip_record, "DEVICE FILE            records a real sensor"},
};
#define TOOL_COUNT (sizeof tools / sizeof tools[0])

static void print_usage(FILE *out)
{
    fprintf(out, "usage: plomada scip TOOL [ARGUMENT]...\n\n");
    for (size_t i = 0; i < TOOL_COUNT; i++) {
        fprintf(out, "  %-8s %s\n", tools[i].name, tools[i].summary);
    }
    fprintf(out, "\n`plomada scip TOOL --help` tells more.\n");
}

int command_scip(int argc, char **argv)
{
    for (size_t i = 0; argc > 1 && i < TOOL_COUNT; i++) {
        if (strcmp(argv[1], tools[i].name) == 0) {
            return tools[i].run(argc - 1, argv + 1);
        }
    }
    if (argc > 1 && strcmp(argv[1], "--help") == 0) {
        print_usage(stdout);
        return 0;
    }
    print_usage(stderr);
    return 2;
}
