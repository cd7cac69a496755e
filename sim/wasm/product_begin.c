/* Linked before the product's objects: its variables of either kind begin behind these (sim/variables.c). */
extern char product_data_begin[16], product_bss_begin[16];
char product_data_begin[16] = {1};
char product_bss_begin[16];
