/* `plomada fly` alone, linked with one ray layout and bit rate (layouts.cmake). */
#include "tools/plomada/commands.h"

int main(int argc, char **argv)
{
    return command_fly(argc, argv);
}
