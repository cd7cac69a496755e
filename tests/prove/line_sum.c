/* Any text of 64 characters at most. */
#include "drivers/line_sum.h"

#include "prove.h"

void any_text_has_a_sum(void)
{
    char text[64];
    char digits[LINE_SUM_DIGITS];
    uint16_t length = nondet_cell();

    ASSUME(length <= sizeof text);
    line_sum_write(digits, line_sum(text, length));
    for (uint16_t i = 0U; i < LINE_SUM_DIGITS; i++) {
        PROVE((digits[i] >= '0' && digits[i] <= '9') || (digits[i] >= 'A' && digits[i] <= 'F'), "a digit");
    }
}
