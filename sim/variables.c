#include "sim/variables.h"

#include <stddef.h>
#include <stdlib.h>

#ifdef __wasm__
/* sim/wasm/: objects linked before and after the product's, because no tool renames sections of a WebAssembly
 * object. */
extern char product_data_begin[], product_data_end[], product_bss_begin[], product_bss_end[];
#define __start_product_data product_data_begin
#define __stop_product_data product_data_end
#define __start_product_bss product_bss_begin
#define __stop_product_bss product_bss_end
#define MARKER 16 /* octets of each of them */
#else
/* The linker's, for sections whose name is an identifier. Weak: a section may be empty, or the build have
 * none. */
extern char __start_product_data[] __attribute__((weak));
extern char __stop_product_data[] __attribute__((weak));
extern char __start_product_bss[] __attribute__((weak));
extern char __stop_product_bss[] __attribute__((weak));
#endif

static char *initial; /* of product_data */

/* Between the variables lie the sanitizer's red zones. */
__attribute__((no_sanitize("address"))) static void copy(volatile char *to, const volatile char *from,
                                                         size_t size)
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

#ifdef __wasm__
    if (__stop_product_data - __start_product_data <= MARKER ||
        __stop_product_bss - __start_product_bss <= MARKER) {
        abort(); /* the linker has another order: nothing would be reset, and the next flight be wrong
                    silently */
    }
#endif
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
