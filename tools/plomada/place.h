/* A place file from the disk, sim/scenarios/place_file.h. */
#ifndef TOOLS_PLOMADA_PLACE_H
#define TOOLS_PLOMADA_PLACE_H

/* The text of a file that place_file_read() takes. NULL: said on stderr what is wrong, with its line. Stands
 * until the next call. */
const char *place_read(const char *path);

#endif
