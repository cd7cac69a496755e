#include "sim/host/websocket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "unity.h"

#define TCP_PORT 18124
#define PATIENCE_MS 3000

static port_t port;

/* The server of the test before ends a moment after its port was closed. */
void setUp(void)
{
    const char *error = websocket_open(&port, TCP_PORT);

    for (int i = 0; i < 100 && error != NULL; i++) {
        usleep(20000);
        error = websocket_open(&port, TCP_PORT);
    }
    TEST_ASSERT_NULL(error);
}

void tearDown(void)
{
    port_close(&port);
}

static int connected(void)
{
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons(TCP_PORT), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int fd = socket(AF_INET, SOCK_STREAM, 0);

    TEST_ASSERT_EQUAL(0, connect(fd, (const struct sockaddr *)&address, sizeof address));
    return fd;
}

static size_t received(int fd, char *text, size_t capacity)
{
    struct pollfd polled = {fd, POLLIN, 0};
    ssize_t got;

    TEST_ASSERT_EQUAL_MESSAGE(1, poll(&polled, 1, PATIENCE_MS), "nothing came");
    got = recv(fd, text, capacity, 0);
    return got > 0 ? (size_t)got : 0;
}

/* `origin`: a whole header line, or nothing. */
static int asked(const char *path, const char *origin, char *answer, size_t capacity)
{
    char request[512];
    const int fd = connected();
    const int size = snprintf(
        request, sizeof request,
        "GET %s HTTP/1.1\r\nHost: x\r\n%sUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n",
        path, origin);

    TEST_ASSERT_EQUAL(size, send(fd, request, (size_t)size, 0));
    answer[received(fd, answer, capacity - 1)] = '\0';
    return fd;
}

static int shaken(void)
{
    char answer[512];
    const int fd = asked("/", "", answer, sizeof answer);

    TEST_ASSERT_EQUAL_STRING_LEN("HTTP/1.1 101 ", answer, 13);
    TEST_ASSERT_NOT_NULL(strstr(answer, "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"));
    return fd;
}

void test_the_answer_to_the_key_is_that_of_the_standards_example(void)
{
    char answer[WEBSOCKET_ACCEPT];

    websocket_accept("dGhlIHNhbXBsZSBub25jZQ==", answer);
    TEST_ASSERT_EQUAL_STRING("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=", answer);
}

void test_octets_go_both_ways_and_a_clients_mask_comes_off(void)
{
    static const unsigned char frame[] = {0x82, 0x83, 1, 2, 3, 4, 'a' ^ 1, 'b' ^ 2, 'c' ^ 3};
    const int fd = shaken();
    struct pollfd polled = {port.fd, POLLIN, 0};
    unsigned char text[8];
    char back[8];
    bool lost;

    TEST_ASSERT_EQUAL(sizeof frame, send(fd, frame, sizeof frame, 0));
    TEST_ASSERT_EQUAL(1, poll(&polled, 1, PATIENCE_MS));
    TEST_ASSERT_EQUAL(3, port_read(&port, text, sizeof text, &lost));
    TEST_ASSERT_EQUAL_MEMORY("abc", text, 3);
    port_write(&port, (const unsigned char *)"xy", 2);
    TEST_ASSERT_EQUAL(4, received(fd, back, sizeof back));
    TEST_ASSERT_EQUAL_MEMORY("\x82\x02xy", back, 4);
    close(fd);
}

void test_a_late_client_gets_nothing_that_was_written_before_it_came(void)
{
    char back[64];
    int fd;

    port_write(&port, (const unsigned char *)"stale", 5);
    usleep(100000);
    fd = shaken();
    port_write(&port, (const unsigned char *)"fresh", 5);
    TEST_ASSERT_EQUAL(7, received(fd, back, sizeof back));
    TEST_ASSERT_EQUAL_MEMORY("\x82\x05"
                             "fresh",
                             back, 7);
    close(fd);
}

void test_a_second_client_is_refused_and_one_that_left_makes_room(void)
{
    char answer[256] = "";
    int first = shaken(), second = connected();

    received(second, answer, sizeof answer - 1);
    TEST_ASSERT_EQUAL_STRING_LEN("HTTP/1.1 503 ", answer, 13);
    close(second);
    close(first);
    usleep(100000);
    close(shaken());
}

void test_what_is_no_websocket_is_sent_away(void)
{
    char answer[64];
    const int fd = connected();

    TEST_ASSERT_EQUAL(18, send(fd, "GET / HTTP/1.1\r\n\r\n", 18, 0));
    TEST_ASSERT_EQUAL(0, received(fd, answer, sizeof answer));
    close(fd);
}

/* The server takes one client at a time, and notices a moment later that one has left. */
static void enters(const char *status, const char *path, const char *origin)
{
    char answer[512];

    close(asked(path, origin, answer, sizeof answer));
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(status, answer, strlen(status), origin);
    usleep(50000);
}

void test_a_page_of_this_machine_enters_and_any_other_only_with_the_printed_address(void)
{
    static const char *const local[] = {"", "Origin: http://localhost:8123\r\n",
                                        "Origin: http://127.0.0.1\r\n", "origin: https://[::1]:8443\r\n"};
    static const char *const strange[] = {"Origin: https://strange.example\r\n",
                                          "Origin: http://localhost.strange.example\r\n",
                                          "Origin: http://localhost:80.strange.example\r\n",
                                          "Origin: http://127.0.0.1.strange.example:80\r\n",
                                          "Origin: http://notlocalhost\r\n",
                                          "Origin: null\r\n",
                                          "Origin: file://\r\n",
                                          "ORIGIN:https://strange.example\r\n"};
    const char *path = strrchr(port.name, '/');
    char near[32];

    TEST_ASSERT_EQUAL_MESSAGE(17, strlen(path), port.name);
    for (size_t i = 0; i < sizeof local / sizeof local[0]; i++) {
        enters("HTTP/1.1 101 ", "/", local[i]);
    }
    snprintf(near, sizeof near, "%s0", path);
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        enters("HTTP/1.1 403 ", "/", strange[i]);
        enters("HTTP/1.1 403 ", near, strange[i]);
        enters("HTTP/1.1 403 ", "/0123456789abcdef", strange[i]);
        enters("HTTP/1.1 101 ", path, strange[i]);
    }
}

void test_every_server_has_an_address_of_its_own(void)
{
    char first[sizeof port.name];

    snprintf(first, sizeof first, "%s", port.name);
    port_close(&port);
    setUp();
    TEST_ASSERT_EQUAL_STRING_LEN("ws://localhost:18124/", port.name, 21);
    TEST_ASSERT_NOT_EQUAL(0, strcmp(first, port.name));
}

void test_a_port_that_is_taken_is_told(void)
{
    port_t other;

    TEST_ASSERT_NOT_NULL(websocket_open(&other, TCP_PORT));
}
