/* A person at a terminal: the firmware paced by the wall clock, its radio on a pseudo-terminal. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "child.h"
#include "unity.h"

static pid_t pid;
static FILE *program;
static const char storage[] = SCRATCH "/realtime-storage.bin";

void setUp(void) {}

void tearDown(void)
{
    if (pid > 0) {
        kill(pid, SIGKILL);
        waitpid(pid, NULL, 0);
        pid = 0;
    }
}

static void start_with(const char *duration, const char *option, const char *value)
{
    int ends[2];

    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    pid = fork();
    if (pid == 0) {
        dup2(ends[1], 1);
        execl(PLOMADA, "plomada", "fly", "hover-60s", "--realtime", "--xbee", "pty", "--duration", duration,
              option, value, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    program = fdopen(ends[0], "r");
}

static void start(const char *duration)
{
    start_with(duration, NULL, NULL);
}

static int open_radio(void)
{
    char line[200] = "";
    struct termios raw;
    int fd;

    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, program));
    TEST_ASSERT_EQUAL_INT(0, strncmp(line, "xbee: /dev/pts/", 15));
    line[strcspn(line, "\n")] = '\0';
    fd = open(line + 6, O_RDWR | O_NOCTTY);
    TEST_ASSERT_TRUE(fd >= 0);
    tcgetattr(fd, &raw);
    cfmakeraw(&raw);
    tcsetattr(fd, TCSANOW, &raw);
    return fd;
}

static long now_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static bool hears(int fd, const char *text, long patience_ms)
{
    static char heard[20000];
    size_t count = 0;
    long end_ms = now_ms() + patience_ms;

    while (now_ms() < end_ms && count < sizeof heard - 1) {
        struct pollfd watched = {.fd = fd, .events = POLLIN};

        if (poll(&watched, 1, 50) > 0) {
            ssize_t got = read(fd, heard + count, sizeof heard - 1 - count);

            count += got > 0 ? (size_t)got : 0;
            heard[count] = '\0';
            if (strstr(heard, text) != NULL) {
                return true;
            }
        }
    }
    return false;
}

void test_typed_commands_are_answered_and_telemetry_flows(void)
{
    int fd, status;

    start("5");
    fd = open_radio();
    TEST_ASSERT_TRUE(hears(fd, "laser:WAIT", 2000));
    TEST_ASSERT_EQUAL_INT(9, (int)write(fd, "#PING hi\n", 9));
    TEST_ASSERT_TRUE(hears(fd, "OK PING hi\r\n", 3000));
    waitpid(pid, &status, 0);
    pid = 0;
    close(fd);
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

void test_ctrl_c_ends_it_in_good_order(void)
{
    int fd, status;

    start("60");
    fd = open_radio();
    TEST_ASSERT_TRUE(hears(fd, "alt:", 2000));
    kill(pid, SIGINT);
    waitpid(pid, &status, 0);
    pid = 0;
    close(fd);
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

static bool answers(int fd, const char *line, const char *answer)
{
    return write(fd, line, strlen(line)) == (ssize_t)strlen(line) && hears(fd, answer, 3000);
}

static void end_by(int signal_number)
{
    int status;

    kill(pid, signal_number);
    waitpid(pid, &status, 0);
    pid = 0;
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

/* docs/first_evening.md. Nobody but who types has ordered anything. */
void test_a_flight_by_hand_is_told_by_the_reference_that_was_typed(void)
{
    static char told[4000];
    int fd;

    start("60");
    fd = open_radio();
    TEST_ASSERT_TRUE(hears(fd, "laser:OK", 20000));
    TEST_ASSERT_TRUE(answers(fd, "#ARM\n", "OK ARM"));
    TEST_ASSERT_TRUE(answers(fd, "#SETR 0.5\n", "OK SETR 0.5"));
    TEST_ASSERT_FALSE(hears(fd, "no such line", 7000));
    TEST_ASSERT_TRUE(answers(fd, "#LAND\n", "OK LAND"));
    TEST_ASSERT_TRUE(hears(fd, "state:GROUND", 10000));
    TEST_ASSERT_FALSE(hears(fd, "no such line", 2000));
    end_by(SIGINT);
    told[fread(told, 1, sizeof told - 1, program)] = '\0';
    close(fd);
    TEST_ASSERT_NULL_MESSAGE(strstr(told, "\n!"), told);
    TEST_ASSERT_NULL_MESSAGE(strstr(told, "rise_time_s"), told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "Not judged: the scenario ordered nothing"), told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "\n  landed_unordered     0 "), told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "\n  max_error_mm"), told);
    TEST_ASSERT_TRUE_MESSAGE(atof(strstr(told, "\n  max_error_mm") + 23) < 100.0, told);
}

static void save_kp(const char *line, int signal_number)
{
    int fd;

    start_with("60", "--storage", storage);
    fd = open_radio();
    TEST_ASSERT_TRUE(answers(fd, line, "OK KP"));
    TEST_ASSERT_TRUE(answers(fd, "#SAVE\n", "OK SAVE generation:"));
    end_by(signal_number);
    close(fd);
}

static bool has_kp(const char *option, const char *value, const char *answer)
{
    bool has;
    int fd;

    start_with("60", option, value);
    fd = open_radio();
    has = answers(fd, "#GET KP\n", answer);
    end_by(SIGINT);
    close(fd);
    return has;
}

void test_what_one_run_saves_the_next_one_flies_with_however_it_was_ended(void)
{
    (void)remove(storage);
    save_kp("#KP 0.021\n", SIGINT);
    TEST_ASSERT_TRUE(has_kp("--storage", storage, "OK KP 0.021\r\n"));
    save_kp("#KP 0.022\n", SIGTERM);
    TEST_ASSERT_TRUE(has_kp("--storage", storage, "OK KP 0.022\r\n"));
    save_kp("#KP 0.023\n", SIGHUP);
    TEST_ASSERT_TRUE(has_kp("--storage", storage, "OK KP 0.023\r\n"));
    (void)remove(storage);
}

void test_what_is_not_saved_and_what_has_no_file_is_forgotten(void)
{
    (void)remove(storage);
    save_kp("#KP 0.021\n", SIGINT);
    start_with("60", "--storage", storage);
    int fd = open_radio();
    TEST_ASSERT_TRUE(answers(fd, "#KP 0.03\n", "OK KP 0.03 (LAW EST does not use it)\r\n"));
    end_by(SIGINT);
    close(fd);
    TEST_ASSERT_TRUE(has_kp("--storage", storage, "OK KP 0.021\r\n"));
    TEST_ASSERT_TRUE(has_kp(NULL, NULL, "OK KP 0.015\r\n"));
    (void)remove(storage);
}
