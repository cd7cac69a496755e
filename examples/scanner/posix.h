/* The port of posix.c. What goes wrong with it ends the program with a word. */
#ifndef POSIX_H
#define POSIX_H

/* Before the first board_uart_open(). The path stays the caller's. */
void posix_use(const char *path);

#endif
