#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* As fopen() for writing, but what is in it stays for now. */
static bool open_whole(output_t *output)
{
    if (output->path == NULL || output_is_stdout(output)) {
        output->file = output->path == NULL ? NULL : stdout;
        return true;
    }
    int there = open(output->path, O_WRONLY | O_CREAT | O_EXCL, 0666);

    output->made = there >= 0;
    if (!output->made) {
        there = open(output->path, O_WRONLY | O_CREAT, 0666);
    }
    output->file = there < 0 ? NULL : fdopen(there, "w");
    return output->file != NULL || complain(output);
}

static bool make_empty(output_t *output)
{
    struct stat what;
    const bool is_file = output->file != NULL && !output_is_stdout(output) &&
                         fstat(fileno(output->file), &what) == 0 && S_ISREG(what.st_mode);

    return !is_file || ftruncate(fileno(output->file), 0) == 0 || complain(output);
}

/* Closes them. Those that were made are removed. */
static void undo(output_t *const outputs[], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (outputs[i]->file != NULL && !output_is_stdout(outputs[i])) {
            fclose(outputs[i]->file);
        }
        outputs[i]->file = NULL;
        if (outputs[i]->made) {
            unlink(outputs[i]->path);
            outputs[i]->made = false;
        }
    }
}

bool output_open_all(output_t *const outputs[], size_t count)
{
    bool opened = true;

    for (size_t i = 0; i < count && opened; i++) {
        opened = open_whole(outputs[i]);
    }
    for (size_t i = 0; i < count && opened; i++) {
        opened = make_empty(outputs[i]);
    }
    if (!opened) {
        undo(outputs, count);
    }
    return opened;
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

static bool is_dash(const char *path)
{
    return strcmp(path, "-") == 0;
}

static bool look(const char *path, struct stat *what)
{
    return is_dash(path) ? fstat(STDOUT_FILENO, what) == 0 : stat(path, what) == 0;
}

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash == NULL ? path : slash + 1;
}

static bool look_at_folder(const char *path, struct stat *what)
{
    char folder[PATH_MAX];
    const int length = (int)(base_of(path) - path);

    snprintf(folder, sizeof folder, "%.*s", length, path);
    return stat(length == 0 ? "." : folder, what) == 0;
}

/* Neither is there: by folder and name. */
static bool same_to_be(const char *one, const char *other)
{
    struct stat first, second;

    if (!look_at_folder(one, &first) || !look_at_folder(other, &second)) {
        return strcmp(one, other) == 0;
    }
    return first.st_dev == second.st_dev && first.st_ino == second.st_ino &&
           strcmp(base_of(one), base_of(other)) == 0;
}

bool output_same(const char *one, const char *other)
{
    struct stat first, second;
    const bool has_first = look(one, &first), has_second = look(other, &second);

    if (is_dash(one) && is_dash(other)) {
        return true;
    }
    if (has_first && has_second) {
        return S_ISREG(first.st_mode) && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
    }
    return !has_first && !has_second && same_to_be(one, other);
}

static bool clash(const output_use_t *one, const output_use_t *other)
{
    return one->path != NULL && other->path != NULL && (one->written || other->written) &&
           output_same(one->path, other->path);
}

bool output_apart(const char *command, const output_use_t *uses, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (clash(&uses[i], &uses[k])) {
                fprintf(stderr, "plomada %s: %s: %s and %s are one file\n", command, uses[i].path,
                        uses[k].name, uses[i].name);
                return false;
            }
        }
    }
    return true;
}
