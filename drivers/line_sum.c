#include "drivers/line_sum.h"

#define POLYNOMIAL 0x1021U /* CRC-16/CCITT-FALSE */
#define START 0xFFFFU      /* of the same */
#define TOP_BIT 0x8000U

static uint16_t shifted(uint16_t sum)
{
    const uint32_t doubled = (uint32_t)sum << 1;

    return (uint16_t)(((sum & TOP_BIT) != 0U ? doubled ^ POLYNOMIAL : doubled) & 0xFFFFU);
}

uint16_t line_sum(const char *text, uint16_t length)
{
    uint16_t sum = START;

    for (uint16_t i = 0U; i < length; ++i) {
        sum = (uint16_t)(sum ^ (((uint32_t)text[i] & 0xFFU) << 8));
        for (uint16_t bit = 0U; bit < 8U; ++bit) {
            sum = shifted(sum);
        }
    }
    return sum;
}

void line_sum_write(char digits[LINE_SUM_DIGITS], uint16_t sum)
{
    static const char hex[] = "0123456789ABCDEF";

    for (uint16_t i = 0U; i < LINE_SUM_DIGITS; ++i) {
        digits[i] = hex[((uint32_t)sum >> (12U - 4U * i)) & 0xFU];
    }
}
