/* Why a flight went as it did: tools/why, in the Python that `make why` installs. */
#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"

#define SCRIPT "/../tools/why/why.py"
#define PYTHON "/../build/venv/bin/python"
#define PACKAGES "/../build/venv/campaign.txt" /* setup.sh writes it when they are installed */
#define PROGRAM_OPTION "--program"
#define FIXED_WORDS 6 /* python, -B, the script, the option, its value, and the NULL behind the last */

/* Beside the program, as it was built: build/plomada in the tree of the sources. */
static bool beside(char path[PATH_MAX], const char *directory, const char *name)
{
    return snprintf(path, PATH_MAX, "%s%s", directory, name) < PATH_MAX && access(path, R_OK) == 0;
}

static int complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada why: %s: %s\n", subject, what);
    return 2;
}

int command_why(int argc, char **argv)
{
    static char self[PATH_MAX], directory[PATH_MAX], script[PATH_MAX], python[PATH_MAX], packages[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);

    if (length <= 0) {
        return complain(strerror(errno), "/proc/self/exe");
    }
    strcpy(directory, self);
    *strrchr(directory, '/') = '\0';
    if (!beside(script, directory, SCRIPT)) {
        return complain("needs the sources; run the program that `make build` built in their tree",
                        "tools/why");
    }
    if (!beside(packages, directory, PACKAGES) || !beside(python, directory, PYTHON)) {
        return complain("is not installed; `make why LOG=FILE` installs it", "its Python");
    }
    char **words = calloc((size_t)argc + FIXED_WORDS, sizeof *words);
    int count = 0;

    if (words == NULL) {
        abort();
    }
    words[count++] = python;
    words[count++] = "-B";
    words[count++] = script;
    words[count++] = PROGRAM_OPTION;
    words[count++] = self;
    for (int i = 1; i < argc; i++) {
        words[count++] = argv[i];
    }
    fflush(stdout);
    execv(python, words);
    free(words);
    return complain(strerror(errno), python);
}
