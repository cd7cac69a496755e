/* A program whose stack grows into its variables. */
static volatile int variables[1000];

int suite_main(void);

static int deeper(int depth)
{
    volatile int frame[100];

    frame[depth % 100] = depth;
    return depth == 0 ? frame[0] : deeper(depth - 1) + frame[depth % 100];
}

int suite_main(void)
{
    variables[0] = deeper(1000);
    return 0;
}
