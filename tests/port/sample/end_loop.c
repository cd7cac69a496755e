/* A program that never ends. */
int suite_main(void);

int suite_main(void)
{
    for (;;) {
        __asm__ volatile("");
    }
}
