#include "input.h"

#include <errno.h>
#include <sys/stat.h>

FILE *input_open(const char *path)
{
    struct stat what;

    if (stat(path, &what) == 0 && S_ISDIR(what.st_mode)) {
        errno = EISDIR;
        return NULL;
    }
    return fopen(path, "r");
}
