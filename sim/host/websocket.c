#define _GNU_SOURCE
#include "sim/host/websocket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#define ROOM 8192
#define PAYLOAD_MAX 4096U
#define KEY 16 /* hexadecimal digits: 64 bits, which no page can try out */

enum { OPCODE_BINARY = 2, OPCODE_CLOSE = 8, OPCODE_PING = 9, OPCODE_PONG = 10 };

/* SHA-1 (RFC 3174), of up to 119 octets: two blocks
 * ------------------------------------------------------------ */

static uint32_t turn(uint32_t value, unsigned by)
{
    return value << by | value >> (32U - by);
}

static void mix(uint32_t h[5], const unsigned char block[64])
{
    static const uint32_t constants[4] = {0x5A827999U, 0x6ED9EBA1U, 0x8F1BBCDCU, 0xCA62C1D6U};
    uint32_t w[80], a = h[0], b = h[1], c = h[2], d = h[3], e = h[4];

    for (int i = 0; i < 80; i++) {
        w[i] = i < 16 ? (uint32_t)block[4 * i] << 24 | (uint32_t)block[4 * i + 1] << 16 |
                            (uint32_t)block[4 * i + 2] << 8 | block[4 * i + 3]
                      : turn(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
        const uint32_t f = i < 20              ? (b & c) | (~b & d)
                           : i >= 40 && i < 60 ? (b & c) | (b & d) | (c & d)
                                               : b ^ c ^ d;
        const uint32_t next = turn(a, 5) + f + e + constants[i / 20] + w[i];

        e = d;
        d = c;
        c = turn(b, 30);
        b = a;
        a = next;
    }
    h[0] += a;
    h[1] += b;
    h[2] += c;
    h[3] += d;
    h[4] += e;
}

static void sha1(const char *text, unsigned char digest[20])
{
    unsigned char blocks[128] = {0};
    uint32_t h[5] = {0x67452301U, 0xEFCDAB89U, 0x98BADCFEU, 0x10325476U, 0xC3D2E1F0U};
    const size_t length = strnlen(text, 119);
    const size_t end = length < 56 ? 64 : 128;

    memcpy(blocks, text, length);
    blocks[length] = 0x80;
    blocks[end - 2] = (unsigned char)(length * 8 >> 8);
    blocks[end - 1] = (unsigned char)(length * 8);
    for (size_t at = 0; at < end; at += 64) {
        mix(h, &blocks[at]);
    }
    for (int i = 0; i < 20; i++) {
        digest[i] = (unsigned char)(h[i / 4] >> (24 - 8 * (i % 4)));
    }
}

void websocket_accept(const char *key, char answer[WEBSOCKET_ACCEPT])
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char digest[21] = {0};
    char text[128];

    snprintf(text, sizeof text, "%.60s258EAFA5-E914-47DA-95CA-C5AB0DC85B11", key);
    sha1(text, digest);
    for (int i = 0; i < 28; i++) {
        const int bit = i * 6;
        const unsigned pair = (unsigned)digest[bit / 8] << 8 | digest[bit / 8 + (bit / 8 < 20)];

        answer[i] = letters[pair >> (10 - bit % 8) & 63U];
    }
    answer[27] = '=';
    answer[28] = '\0';
}

/* The server: a process of its own, so that no client delays the flight
 * ----------------------------------------- */

static struct {
    int listener, pair, client; /* -1: none */
    bool open;                  /* the handshake is done */
    char key[KEY + 1];          /* of the address: who knows it was told it by this program's operator */
    unsigned char room[ROOM];   /* of the client, not yet understood */
    size_t count;
} server;

static void send_all(int fd, const void *octets, size_t count)
{
    const char *at = octets;

    while (count > 0) {
        const ssize_t put = send(fd, at, count, MSG_NOSIGNAL);

        if (put <= 0) {
            return;
        }
        at += put;
        count -= (size_t)put;
    }
}

static void drop_client(void)
{
    close(server.client);
    server.client = -1;
    server.open = false;
    server.count = 0;
}

static void send_frame(unsigned opcode, const unsigned char *payload, size_t count)
{
    unsigned char frame[4 + PAYLOAD_MAX] = {(unsigned char)(0x80U | opcode), (unsigned char)count};
    size_t head = 2;

    if (count > 125) {
        frame[1] = 126;
        frame[2] = (unsigned char)(count >> 8);
        frame[3] = (unsigned char)count;
        head = 4;
    }
    memcpy(&frame[head], payload, count);
    send_all(server.client, frame, head + count);
}

static void take_frame(unsigned opcode, const unsigned char *payload, size_t count)
{
    if (opcode == OPCODE_CLOSE) {
        send_frame(OPCODE_CLOSE, payload, count);
        drop_client();
    } else if (opcode == OPCODE_PING) {
        send_frame(OPCODE_PONG, payload, count);
    } else if (opcode <= OPCODE_BINARY) {
        send_all(server.pair, payload, count);
    }
}

/* Takes one frame from the room; false: it is not whole yet. A frame that is longer than the room, or not
 * masked as a client's must be, ends the connection. */
static bool one_frame(void)
{
    unsigned char *at = server.room;
    const size_t head = server.count >= 2 && (at[1] & 127U) == 126U ? 8 : 6;
    size_t count;

    if (server.count < head) {
        return false;
    }
    count = head == 8 ? (size_t)at[2] << 8 | at[3] : at[1] & 127U;
    if (count > PAYLOAD_MAX || (at[1] & 127U) == 127U || (at[1] & 128U) == 0) {
        drop_client();
        return false;
    }
    if (server.count < head + count) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        at[head + i] ^= at[head - 4 + i % 4];
    }
    take_frame(at[0] & 15U, &at[head], count);
    if (server.client < 0) {
        return false;
    }
    server.count -= head + count;
    memmove(server.room, &server.room[head + count], server.count);
    return true;
}

/* The value of a header, up to the first blank; name begins with the line feed before it. */
static bool header(const char *name, char value[64])
{
    const char *found = strcasestr((char *)server.room, name);

    value[0] = '\0';
    return found != NULL && sscanf(found + strlen(name), " %63[^ \r\n]", value) == 1;
}

bool websocket_is_local(const char *origin)
{
    static const char *const hosts[] = {"localhost", "127.0.0.1", "[::1]"};
    const char *host = strstr(origin, "://");

    for (size_t i = 0; host != NULL && i < sizeof hosts / sizeof hosts[0]; i++) {
        const size_t length = strlen(hosts[i]);
        const char *rest = host + 3 + length;

        if (strncmp(host + 3, hosts[i], length) == 0 &&
            (*rest == '\0' || (*rest == ':' && rest[1 + strspn(rest + 1, "0123456789")] == '\0'))) {
            return true;
        }
    }
    return false;
}

/* Every browser tells from where a page came, and every page that it shows can reach this machine's ports. So
 * a page of this machine may enter, and a program that is no browser; any other page must know the address
 * as it was printed. A page that was opened from a disk is such another: its origin, `null`, is anybody's. */
static bool may_enter(void)
{
    char origin[64], path[KEY + 2] = "";

    if (sscanf((char *)server.room, "GET /%17[^ \r\n]", path) == 1 && strcmp(path, server.key) == 0) {
        return true;
    }
    return !header("\nOrigin:", origin) || websocket_is_local(origin);
}

static bool handshake(void)
{
    static const char stranger[] = "HTTP/1.1 403 Forbidden\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
    char key[64], accept_key[WEBSOCKET_ACCEPT], answer[256];

    server.room[server.count] = '\0';
    if (strstr((char *)server.room, "\r\n\r\n") == NULL) {
        return false;
    }
    if (!header("\nSec-WebSocket-Key:", key)) {
        drop_client();
        return false;
    }
    if (!may_enter()) {
        send_all(server.client, stranger, sizeof stranger - 1);
        drop_client();
        return false;
    }
    websocket_accept(key, accept_key);
    snprintf(answer, sizeof answer,
             "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
             "Upgrade\r\nSec-WebSocket-Accept: %s\r\n\r\n",
             accept_key);
    send_all(server.client, answer, strlen(answer));
    server.open = true;
    server.count = 0;
    return false;
}

static void from_client(void)
{
    const ssize_t got = recv(server.client, &server.room[server.count], ROOM - 1 - server.count, 0);

    if (got <= 0) {
        drop_client();
        return;
    }
    server.count += (size_t)got;
    while (server.client >= 0 && (server.open ? one_frame() : handshake())) {
    }
}

static void from_board(void)
{
    unsigned char octets[1024];
    const ssize_t got = recv(server.pair, octets, sizeof octets, 0);

    if (got <= 0) {
        _exit(0); /* the flight is over */
    }
    if (server.open) {
        send_frame(OPCODE_BINARY, octets, (size_t)got);
    }
}

static void welcome(void)
{
    static const char busy[] = "HTTP/1.1 503 Busy\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
    const int fd = accept4(server.listener, NULL, NULL, SOCK_CLOEXEC);

    if (fd < 0) {
        return;
    }
    if (server.client >= 0) {
        send_all(fd, busy, strlen(busy));
        close(fd);
        return;
    }
    server.client = fd;
}

static void serve(void)
{
    signal(SIGINT, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    for (;;) {
        struct pollfd polled[] = {
            {server.pair, POLLIN, 0}, {server.listener, POLLIN, 0}, {server.client, POLLIN, 0}};

        if (poll(polled, 3, -1) < 0) {
            continue;
        }
        if (polled[0].revents != 0) {
            from_board();
        }
        if (polled[2].revents != 0 && server.client >= 0) {
            from_client();
        }
        if (polled[1].revents != 0) {
            welcome();
        }
    }
}

static const char *listen_at(unsigned tcp_port)
{
    const struct sockaddr_in address = {.sin_family = AF_INET,
                                        .sin_port = htons((uint16_t)tcp_port),
                                        .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int yes = 1;

    server.listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (server.listener < 0 || setsockopt(server.listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
        bind(server.listener, (const struct sockaddr *)&address, sizeof address) != 0 ||
        listen(server.listener, 4) != 0) {
        return strerror(errno);
    }
    return NULL;
}

static const char *give_up(int pair[2], const char *error)
{
    for (int i = 0; i < 2; i++) {
        if (pair[i] >= 0) {
            close(pair[i]);
        }
    }
    if (server.listener >= 0) {
        close(server.listener);
    }
    return error;
}

static const char *draw_key(void)
{
    unsigned char random[KEY / 2];

    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) {
        return strerror(errno);
    }
    for (size_t i = 0; i < sizeof random; i++) {
        snprintf(&server.key[2 * i], 3, "%02x", random[i]);
    }
    return NULL;
}

const char *websocket_open(port_t *port, unsigned tcp_port)
{
    int pair[2] = {-1, -1};
    const char *error = listen_at(tcp_port);
    pid_t child;

    if (error == NULL) {
        error = draw_key();
    }
    if (error != NULL) {
        return give_up(pair, error);
    }
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0 ||
        fcntl(pair[0], F_SETFL, O_NONBLOCK) != 0) {
        return give_up(pair, strerror(errno));
    }
    fflush(NULL);
    child = fork();
    if (child < 0) {
        return give_up(pair, strerror(errno));
    }
    if (child == 0) {
        close(pair[0]);
        server.pair = pair[1];
        server.client = -1;
        serve();
    }
    close(pair[1]);
    close(server.listener);
    *port = (port_t){.fd = pair[0], .slave = -1};
    snprintf(port->name, sizeof port->name, "ws://localhost:%u/%s", tcp_port, server.key);
    return NULL;
}
