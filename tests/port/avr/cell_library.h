/* The functions of the C library that take characters or sizes, for cells of 16 bits. A character is an int;
 * sizes count cells. As the functions whose names they carry, unless said otherwise. */
#ifndef PORT_AVR_CELL_LIBRARY_H
#define PORT_AVR_CELL_LIBRARY_H

#include <stddef.h>
#include <stdio.h>

void *cell_memcpy(void *to, const void *from, size_t cells);
void *cell_memmove(void *to, const void *from, size_t cells);
void *cell_memset(void *to, int value, size_t cells);
int cell_memcmp(const void *one, const void *other, size_t cells);
void *cell_memchr(const void *in, int wanted, size_t cells);

size_t cell_strlen(const int *text);
int *cell_strcpy(int *to, const int *from);
int cell_strcmp(const int *one, const int *other);
int cell_strncmp(const int *one, const int *other, size_t most);
int *cell_strchr(const int *text, int wanted);
int *cell_strstr(const int *text, const int *wanted);

/* Numbers of up to 40 characters. */
unsigned long cell_strtoul(const int *text, int **end, int base);
long cell_atol(const int *text);
int cell_atoi(const int *text);

/* Conversions of the library below, of up to 60 characters each, and %s of cells. */
int cell_snprintf(int *text, size_t capacity, const int *format, ...);
int cell_printf(const int *format, ...);

FILE *cell_fopen(const int *path, const int *mode);
int *cell_fgets(int *text, int capacity, FILE *stream);

void cell_qsort(void *items, size_t count, size_t cells, int (*compare)(const void *one, const void *other));

#endif
