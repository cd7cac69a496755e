#include <stdio.h>
#include <string.h>

#include "commands.h"
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

int command_list(int argc, char **argv)
{
    if (argc > 1) {
        int help = strcmp(argv[1], "--help") == 0;

        fprintf(help ? stdout : stderr, "usage: plomada list\nThe scenarios, what they type and what each must look like.\n");
        return help ? 0 : 2;
    }
    for (int i = 0; i < scenario_count; i++) {
        print_scenario(&scenarios[i]);
    }
    return 0;
}
