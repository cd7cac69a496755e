/* The XDC types that the firmware uses, with the sizes of the machine it is compiled for (on a C28x Int and
 * UInt have 16 bits, and code must not assume more). */
#ifndef xdc_std__include
#define xdc_std__include

#include <stddef.h>
#include <stdint.h>

typedef void Void;
typedef char Char;
typedef unsigned short Bool;
typedef int Int;
typedef unsigned int UInt;
typedef int_least16_t Int16;
typedef uint_least16_t UInt16;
typedef int_least32_t Int32;
typedef uint_least32_t UInt32;
typedef uint_least16_t Bits16;
typedef size_t SizeT;
typedef void *Ptr;
typedef const char *CString;
typedef intptr_t IArg;
typedef uintptr_t UArg;

#define TRUE 1U
#define FALSE 0U

/* What the Params of every kernel object have in common. The name is kept by reference. */
typedef struct {
    CString name;
} xdc_runtime_IInstance_Params;

#endif
