/* Data addresses of the I/O registers between the tested image (board.c) and the PC (machine.c); the
 * ATmega1284P leaves them free. */
#ifndef PORT_AVR_REGISTERS_H
#define PORT_AVR_REGISTERS_H

#define REGISTER_SAY 0xD0U    /* write: one character to the console */
#define REGISTER_LEAVE 0xD1U  /* write: exit status, ends the run */
#define REGISTER_NAME 0xD2U   /* write: one character of a path, 0 ends it */
#define REGISTER_SELECT 0xD3U /* write: number of the file meant by the following */
#define REGISTER_OPEN 0xD4U   /* write: 1 open the path for reading, 0 close; read: is it open? */
#define REGISTER_READ 0xD5U   /* read: next octet */
#define REGISTER_END 0xD6U    /* read: that was behind the end of the file */

#define REGISTER_FLOOR_LOW 0xD7U /* write: lowest address that the stack may reach */
#define REGISTER_FLOOR_HIGH 0xD8U

#define FILES_MAX 4U

#endif
