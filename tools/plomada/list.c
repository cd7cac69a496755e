#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "sim/scenarios/plant.h"
#include "sim/scenarios/scenarios.h"

static void print_scenario(const scenario_t *scenario)
{
    printf("%s\n    %s\n   ", scenario->name, scenario->summary);
    if (!scenario->bench) {
        printf(" ref %.2f m, lands at %.0f s;", scenario->reference_m, scenario->land_s);
    }
    for (int i = 0; i < SCENARIO_SETTINGS_MAX && scenario->settings[i] != NULL; i++) {
        printf(" #%s", scenario->settings[i]);
    }
    for (const later_line_t *line = scenario->later; line->name != NULL; line++) {
        printf("; at %g s #%s %s", line->t_s, line->name, line->value);
    }
    printf("\n    expects");
    if (scenario->fate == FATE_FAILS) {
        printf(" never to reach 90 %% of the reference;");
    }
    for (int i = 0; i < scenario->expectation_count; i++) {
        const expectation_t *e = &scenario->expectations[i];

        printf("%s %s %g..%g", i > 0 ? "," : "", metric_names[e->metric], e->minimum, e->maximum);
    }
    printf("\n");
}

static int print_plant(void)
{
    printf("The plant figures of --set plant.NAME=VALUE: name, unit, value unless set, meaning. Times are "
           "scenario time:\n"
           "the reference comes at 1 s. Several at once combine.\n\n");
    plant_print(stdout);
    return 0;
}

int command_list(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--plant") == 0) {
        return print_plant();
    }
    if (argc > 1) {
        int help = argc == 2 && strcmp(argv[1], "--help") == 0;

        fprintf(help ? stdout : stderr,
                "usage: plomada list [--plant]\nThe scenarios, what they type and what each must look like; "
                "or, by --plant, "
                "the figures of the\nvehicle, its sensors and the world that --set changes.\n");
        return help ? 0 : 2;
    }
    for (int i = 0; i < scenario_count; i++) {
        print_scenario(&scenarios[i]);
    }
    return 0;
}
