/* A program that runs out of its code. */
int suite_main(void);

int suite_main(void)
{
    void (*const nowhere)(void) = (void (*)(void))0xFFF0;

    nowhere();
    return 0;
}
