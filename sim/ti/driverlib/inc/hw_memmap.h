/* Base addresses, as in TI's header of this name. In the stand-in they only name a module. */
#ifndef HW_MEMMAP_H
#define HW_MEMMAP_H

#define CPUTIMER0_BASE 0x00000C00U
#define CPUTIMER1_BASE 0x00000C08U
#define CPUTIMER2_BASE 0x00000C10U
#define EPWM2_BASE 0x00004100U
#define ECAP1_BASE 0x00005000U
#define SCIA_BASE 0x00007200U
#define SCIB_BASE 0x00007210U
#define SCIC_BASE 0x00007220U
#define FLASHPUMPSEMAPHORE_BASE 0x00050024U
#define FLASH0ECC_BASE 0x0005FB00U

#endif
