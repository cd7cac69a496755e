#include "child.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

static void write_all(int fd, const void *data, size_t size)
{
    const char *next = data;

    while (size > 0) {
        ssize_t put = write(fd, next, size);

        if (put <= 0) {
            _exit(3);
        }
        next += put;
        size -= (size_t)put;
    }
}

void child_run(child_work_t work, void *argument, void *result, size_t size)
{
    int ends[2], status;
    size_t have = 0;
    ssize_t got;
    pid_t pid;

    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    fflush(stdout); /* else the child says it again */
    pid = fork();
    TEST_ASSERT_NOT_EQUAL(-1, pid);
    if (pid == 0) {
        close(ends[0]);
        work(argument, result);
        write_all(ends[1], result, size);
        fflush(stdout);
        _exit(0);
    }
    close(ends[1]);
    while (have < size && (got = read(ends[0], (char *)result + have, size - have)) > 0) {
        have += (size_t)got;
    }
    close(ends[0]);
    waitpid(pid, &status, 0);
    TEST_ASSERT_TRUE_MESSAGE(WIFEXITED(status) && WEXITSTATUS(status) == 0 && have == size,
                             "the child crashed");
}

child_flights_t child_fly_seeds(const char *scenario, unsigned long seeds, const char *const *assignments)
{
    child_flights_t flights = {{0.0}, {0.0}};

    for (unsigned long seed = 1; seed <= seeds; seed++) {
        flight_result_t result;

        child_fly(scenario, seed, assignments, &result);
        TEST_ASSERT_TRUE(result.started);
        TEST_ASSERT_NULL(result.halt);
        for (int i = 0; i < METRIC_COUNT; i++) {
            const double value = result.metrics.value[i];

            flights.mean[i] += value / (double)seeds;
            flights.worst[i] = value > flights.worst[i] ? value : flights.worst[i];
        }
    }
    printf("%s", scenario);
    for (; *assignments != NULL; assignments++) {
        printf(" --set %s", *assignments);
    }
    printf(", seeds 1 to %lu: rms %.1f mm, overshoot %.0f mm, terrain %.1f mm, recovery %.2f s, touch %.2f "
           "m/s at most\n",
           seeds, flights.mean[METRIC_HOVER_RMS_MM], flights.mean[METRIC_OVERSHOOT_MM],
           flights.mean[METRIC_TERRAIN_RMS_MM], flights.mean[METRIC_RECOVERY_S],
           flights.worst[METRIC_TOUCH_SPEED_MPS]);
    return flights;
}

int child_plomada(const char *arguments, char *output, size_t size)
{
    char command[2048];
    FILE *pipe;
    size_t count;
    int status;

    snprintf(command, sizeof command, "cd '" SCRATCH "' && '" PLOMADA "' %s", arguments);
    pipe = popen(command, "r");
    TEST_ASSERT_NOT_NULL(pipe);
    count = fread(output, 1, size - 1, pipe);
    output[count] = '\0';
    status = pclose(pipe);
    TEST_ASSERT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

size_t child_read_file(const char *name, char *text, size_t size)
{
    char path[512];
    FILE *file;
    size_t count;

    snprintf(path, sizeof path, SCRATCH "/%s", name);
    file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    count = fread(text, 1, size - 1, file);
    text[count] = '\0';
    fclose(file);
    return count;
}

typedef struct {
    const char *scenario;
    unsigned long seed;
    const char *const *assignments;
    double land_s; /* 0: the scenario's own */
} order_t;

static void fly(void *argument, void *result)
{
    static flight_options_t options;
    const order_t *order = argument;

    options.seed = order->seed;
    options.duration_s = order->land_s;
    for (int i = 0; order->assignments != NULL && order->assignments[i] != NULL; i++) {
        if (flight_override(&options, order->assignments[i]) != NULL) {
            _exit(4);
        }
    }
    if (flight_prepare(scenario_find(order->scenario), &options) != NULL) {
        _exit(5);
    }
    flight_run(scenario_find(order->scenario), &options, result);
}

void child_fly_until(const char *scenario, unsigned long seed, const char *const *assignments, double land_s,
                     flight_result_t *result)
{
    order_t order = {scenario, seed, assignments, land_s};

    child_run(fly, &order, result, sizeof *result);
    TEST_ASSERT_TRUE_MESSAGE(result->started, "the sensors did not come up");
}

void child_fly(const char *scenario, unsigned long seed, const char *const *assignments,
               flight_result_t *result)
{
    child_fly_until(scenario, seed, assignments, 0.0, result);
}

void child_terminal_take(void *terminal, unsigned octet)
{
    child_terminal_t *t = terminal;

    if (t->length < sizeof t->text - 1) {
        t->text[t->length++] = (char)octet;
        t->text[t->length] = '\0';
    }
}
