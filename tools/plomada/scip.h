/* The tools behind `plomada scip`. Each gets its own arguments, argv[0] being its name, and returns the exit
 * status. */
#ifndef TOOLS_PLOMADA_SCIP_H
#define TOOLS_PLOMADA_SCIP_H

int scip_decode(int argc, char **argv);
int scip_mirrors(int argc, char **argv);
int scip_record(int argc, char **argv);

#endif
