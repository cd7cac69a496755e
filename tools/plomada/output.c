#include "output.h"

#include <errno.h>
#include <string.h>

bool output_is_stdout(const output_t *output)
{
    return output->path != NULL && strcmp(output->path, "-") == 0;
}

static bool complain(const output_t *output)
{
    fprintf(stderr, "plomada: %s: %s\n", output_is_stdout(output) ? "stdout" : output->path,
            errno != 0 ? strerror(errno) : "could not be written");
    return false;
}

bool output_open(output_t *output)
{
    if (output->path == NULL) {
        return true;
    }
    output->file = output_is_stdout(output) ? stdout : fopen(output->path, "w");
    return output->file != NULL || complain(output);
}

bool output_close(output_t *output)
{
    if (output->file == NULL) {
        return true;
    }
    /* fclose() alone does not tell of an earlier write that failed. */
    const bool failed_before = ferror(output->file) != 0;
    errno = 0;
    const bool flushed = fflush(output->file) == 0;
    const bool closed = output_is_stdout(output) || fclose(output->file) == 0;

    if (output_is_stdout(output)) {
        clearerr(stdout); /* said here, not again at the program's end */
    }
    output->file = NULL;
    return (flushed && closed && !failed_before) || complain(output);
}
