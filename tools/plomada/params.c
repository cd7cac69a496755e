#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "control/parameters.h"

static void print_row(const parameter_row_t *row)
{
    if (row->choices == NULL) {
        printf("%-8s %-6s %-8g %-8g %-8g %s\n", row->name, row->unit, (double)row->minimum,
               (double)row->maximum, (double)row->initial, row->meaning);
        return;
    }
    printf("%-8s %-6s %-8s %-8s %-8s %s\n", row->name, row->unit, row->choices[0],
           row->choices[(int)row->maximum], row->choices[(int)row->initial], row->meaning);
}

int command_params(int argc, char **argv)
{
    if (argc > 1) {
        int help = strcmp(argv[1], "--help") == 0;

        fprintf(help ? stdout : stderr,
                "usage: plomada params\nThe parameter table: name, unit, limits, default.\n");
        return help ? 0 : 2;
    }
    printf("%-8s %-6s %-8s %-8s %-8s %s\n", "name", "unit", "min", "max", "default", "meaning");
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        print_row(&parameter_table[i]);
    }
    return 0;
}
