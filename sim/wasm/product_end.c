/* Linked after the product's objects: its variables of either kind end before these (sim/variables.c). */
extern char product_data_end[16], product_bss_end[16];
char product_data_end[16] = {1};
char product_bss_end[16];
