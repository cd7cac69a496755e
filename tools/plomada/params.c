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
    [PARAMETERS_MIRRORS] = "mirrors",     [PARAMETERS_BATTERY] = "battery",
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

static void print_title(void)
{
    printf("%-8s %-6s %-8s %-8s %-8s %-9s %s\n", "name", "unit", "min", "max", "default", "group", "meaning");
}

/* One row, and below it every choice. */
static int print_one(const char *name)
{
    const parameter_id_t id = parameter_find(name, strlen(name));

    if (id == PARAMETER_COUNT) {
        fprintf(stderr, "plomada params: no parameter %s\n", name);
        return 2;
    }
    print_title();
    print_row(&parameter_table[id]);
    for (int i = 0; parameter_table[id].choices != NULL && i <= (int)parameter_table[id].maximum; i++) {
        printf("%s%s", (i == 0) ? "one of: " : "|", parameter_table[id].choices[i]);
    }
    printf("%s", (parameter_table[id].choices != NULL) ? "\n" : "");
    return 0;
}

int command_params(int argc, char **argv)
{
    if (argc > 2 || (argc == 2 && strncmp(argv[1], "--", 2) == 0)) {
        int help = strcmp(argv[1], "--help") == 0;

        fprintf(
            help ? stdout : stderr,
            "usage: plomada params [NAME]\nThe parameter table: name, unit, limits, default, group; or the "
            "row of NAME, with its choices.\n");
        return help ? 0 : 2;
    }
    if (argc == 2) {
        return print_one(argv[1]);
    }
    print_title();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        print_row(&parameter_table[i]);
    }
    return 0;
}
