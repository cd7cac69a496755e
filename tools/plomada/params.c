#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "control/parameters.h"

/* One word each: the browser page names them in its languages (ground/src/texts.ts). */
static const char *const group_names[] = {
    [PARAMETERS_LAWS] = "laws",           [PARAMETERS_PD_PID] = "pd-pid",
    [PARAMETERS_PIDT] = "pidt",           [PARAMETERS_EST] = "est",
    [PARAMETERS_EST_MODEL] = "est-model", [PARAMETERS_THROTTLE] = "throttle",
    [PARAMETERS_RADIO] = "radio",         [PARAMETERS_IMU] = "imu",
    [PARAMETERS_MIRRORS] = "mirrors",
};
_Static_assert(sizeof group_names / sizeof group_names[0] == PARAMETER_GROUP_COUNT, "every group has a name");

static void print_row(const parameter_row_t *row)
{
    const char *group = group_names[row->group];

    if (row->choices == NULL) {
        printf("%-8s %-6s %-8g %-8g %-8g %-9s %s\n", row->name, row->unit, (double)row->minimum,
               (double)row->maximum, (double)row->initial, group, row->meaning);
        return;
    }
    printf("%-8s %-6s %-8s %-8s %-8s %-9s %s\n", row->name, row->unit, row->choices[0],
           row->choices[(int)row->maximum], row->choices[(int)row->initial], group, row->meaning);
}

int command_params(int argc, char **argv)
{
    if (argc > 1) {
        int help = strcmp(argv[1], "--help") == 0;

        fprintf(help ? stdout : stderr,
                "usage: plomada params\nThe parameter table: name, unit, limits, default, group.\n");
        return help ? 0 : 2;
    }
    printf("%-8s %-6s %-8s %-8s %-8s %-9s %s\n", "name", "unit", "min", "max", "default", "group", "meaning");
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        print_row(&parameter_table[i]);
    }
    return 0;
}
