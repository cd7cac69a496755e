/* Interrupt numbers, as in TI's header of this name: vector number << 16 | PIE group << 8 | place in the
 * group. */
#ifndef HW_INTS_H
#define HW_INTS_H

#define INT_TIMER0 0x00260107U
#define INT_TIMER1 0x000D0000U
#define INT_TIMER2 0x000E0000U
#define INT_SCIC_RX 0x005C0805U
#define INT_SCIC_TX 0x005D0806U
#define INT_SCIA_RX 0x00600901U
#define INT_SCIA_TX 0x00610902U
#define INT_SCIB_RX 0x00620903U
#define INT_SCIB_TX 0x00630904U

#endif
