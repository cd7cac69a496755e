/* The subcommands of the plomada program. Each takes its own argv (argv[0] is the subcommand's name) and
 * returns the program's exit status: 0 done, 1 expectations not met, 2 usage. */
#ifndef TOOLS_PLOMADA_COMMANDS_H
#define TOOLS_PLOMADA_COMMANDS_H

/* In the directory of `fly --record`. */
#define RECORDING_NAME "flight.plomada"

int command_accept(int argc, char **argv);
int command_board(int argc, char **argv);
int command_fly(int argc, char **argv);
int command_hil(int argc, char **argv);
int command_laser(int argc, char **argv);
int command_list(int argc, char **argv);
int command_log(int argc, char **argv);
int command_params(int argc, char **argv);
int command_replay(int argc, char **argv);
int command_scip(int argc, char **argv);
int command_why(int argc, char **argv);

#endif
