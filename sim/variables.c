#include "sim/variables.h"

#include <stddef.h>
#include <stdlib.h>

/* The linker's, for sections whose name is an identifier. Weak: a section may be empty, or the build have none. */
extern char __start_product_data[] __attribute__((weak));
extern char __stop_product_data[] __attribute__((weak));
extern char __start_product_bss[] __attribute__((weak));
extern char __stop_product_bss[] __attribute__((weak));

static char *initial;   /* of product_data */

/* Between the variables lie the sanitizer's red zones. */
__attribute__((no_sanitize("address"))) static void copy(volatile char *to, const volatile char *from, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        to[i] = from[i];
    }
}

__attribute__((no_sanitize("address"))) static void clear(volatile char *at, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        at[i] = 0;
    }
}

void variables_reset(void)
{
    const size_t data_size = (size_t)(__stop_product_data - __start_product_data);

    if (initial == NULL) {
        initial = malloc(data_size + 1);
        if (initial == NULL) {
            abort();
        }
        copy(initial, __start_product_data, data_size);
    }
    copy(__start_product_data, initial, data_size);
    clear(__start_product_bss, (size_t)(__stop_product_bss - __start_product_bss));
}
