/* GPIO pins: the used subset of TI's driverlib header of this name, plain functions. Pins are GPIO numbers.
 */
#ifndef GPIO_H
#define GPIO_H

#include <stdint.h>

#define GPIO_PIN_TYPE_STD 0x0000U
#define GPIO_PIN_TYPE_PULLUP 0x0001U
#define GPIO_PIN_TYPE_INVERT 0x0002U
#define GPIO_PIN_TYPE_OD 0x0004U

typedef enum { GPIO_DIR_MODE_IN, GPIO_DIR_MODE_OUT } GPIO_Direction;

typedef enum { GPIO_QUAL_SYNC, GPIO_QUAL_3SAMPLE, GPIO_QUAL_6SAMPLE, GPIO_QUAL_ASYNC } GPIO_QualificationMode;

void GPIO_setPinConfig(uint32_t pinConfig);
void GPIO_setDirectionMode(uint32_t pin, GPIO_Direction pinIO);
/* GPIO_PIN_TYPE_INVERT and _OD are not modelled: abort. */
void GPIO_setPadConfig(uint32_t pin, uint32_t pinType);
void GPIO_setQualificationMode(uint32_t pin, GPIO_QualificationMode qualification);
/* divider: 1, or even up to 510, of SYSCLK, for the eight pins of the group (0-7, 8-15, ...). */
void GPIO_setQualificationPeriod(uint32_t pin, uint32_t divider);
/* The level on the pin; the time that the qualification takes is not modelled. */
uint32_t GPIO_readPin(uint32_t pin);
void GPIO_writePin(uint32_t pin, uint32_t outVal);

#endif
