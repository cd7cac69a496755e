/* How a failing create is told. An Error_Block * of NULL means: a failure stops the system. */
#ifndef xdc_runtime_Error__include
#define xdc_runtime_Error__include

#include <xdc/std.h>

typedef struct {
    CString msg; /* NULL while there is no error */
} Error_Block;

Void Error_init(Error_Block *eb);
Bool Error_check(Error_Block *eb);

#endif
