/* `plomada fly` alone, linked with one bit rate (layouts.cmake). */
#include "tools/plomada/commands.h"

int main(int argc, char **argv)
{
    return command_fly(argc, argv);
}
