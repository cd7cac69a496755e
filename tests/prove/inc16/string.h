#ifndef PROVE_STRING_H
#define PROVE_STRING_H
#include <stddef.h>
void *memcpy(void *to, const void *from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *to, int value, size_t size);
void *memchr(const void *text, int character, size_t size);
int memcmp(const void *one, const void *other, size_t size);
int strncmp(const char *one, const char *other, size_t size);
size_t strlen(const char *text);
#endif
