"""Each rule of c28x.py is fed a good house, where it must be silent, and bad ones, where it must name the fault alone."""
import shutil
import tempfile
import unittest
from pathlib import Path

import c28x
from c28x import house

GOOD = {
    "drivers/wire.h": "typedef struct {\n    uint32_t stamp;\n    uint16_t cells[4];\n    char text[9];\n} frame_t;\n",
    "drivers/wire.c": """#include "wire.h"
static const uint16_t rows[] = {1U, 2U};
#define ROWS (sizeof rows / sizeof rows[0])

uint32_t stamp_of(const frame_t *frame, uint16_t low, char c)
{
    uint32_t stamp = (uint32_t)frame->cells[0] | ((uint32_t)frame->cells[1] << 16);

    stamp = (stamp << 6) | (low << 2) | (frame->cells[2] << 8) | (1U << 3) | (1UL << 20);
    stamp |= (frame->stamp << 8) + (uint32_t)((uint32_t)(low + 1U) << 16); /* octet << 16, sizeof, %d */
    return stamp + (uint16_t)(c - '0');
}
""",
    "drivers/bits.c": "typedef union {\n    float value;\n    uint32_t bits;\n} word_t;\n",
    "control/law.c": "float law(float x)\n{\n    return (x < 0.0F) ? -x : x;\n}\n",
    "bsp/uart.c": """void bsp_uart_open(uint32_t base)
{
    SCI_performSoftwareReset(base);
    SCI_clearOverflowStatus(base);
}

void bsp_uart_receive(bsp_uart_t uart, bsp_uart_burst_t *burst)
{
    burst->octets[0] = SCI_readCharNonBlocking(uart);
    recover(uart);
    SCI_clearInterruptStatus(uart, SCI_INT_RXFF);
}

void bsp_uart_transmit_acknowledge(bsp_uart_t uart)
{
    SCI_clearInterruptStatus(PORTS[uart].base, SCI_INT_TXFF);
}
""",
    "firmware/task.c": """#define POLL_MS 20U /* ticks */
static Void run(UArg unused0, UArg unused1)
{
    (void)memcpy(cells, points, count * sizeof points[0]);
    (void)memcpy(&word, &value, sizeof word);
    same = memcmp(echo, text, fixed * sizeof echo[0]) == 0;
    (void)feed(&parser, octet_of(burst->octets[i]));
    (void)Semaphore_pend(ready, BIOS_WAIT_FOREVER);
    (void)Event_pend(event, Event_Id_NONE, events[f(1, 2)], POLL_MS);
    Task_sleep(POLL_MS);
    (void)Clock_create(tick, POLL_MS, &clock, NULL);
    put("no conversion: 100 %");
}
""",
}

BAD = (
    (c28x.sizes, "drivers/wire.c", "n = sizeof(frame_t);"),
    (c28x.sizes, "drivers/wire.c", "memcpy(&frame, octets, sizeof frame);"),
    (c28x.sizes, "drivers/wire.c", "n = sizeof rows / 2U;"),
    (c28x.sizes, "drivers/wire.c", "if (n > sizeof echo && memcmp(a, b, 3U) == 0) {"),
    (c28x.sizes, "firmware/task.c", "send(frame, sizeof *frame);"),
    (c28x.shifts, "drivers/wire.c", "v = octets[0] << 8;"),
    (c28x.shifts, "drivers/wire.c", "v = p[0] << 24;"),
    (c28x.shifts, "drivers/wire.c", "v = cells[1] << 16;"),
    (c28x.shifts, "drivers/wire.c", "v = (uint16_t)high << 16;"),
    (c28x.shifts, "drivers/wire.c", "v = (text[0] - '0') << 8;"),
    (c28x.shifts, "drivers/wire.c", "v = 1 << 3;"),
    (c28x.shifts, "drivers/wire.c", "v = 1U << 20;"),
    (c28x.shifts, "control/law.c", "v = number << n;"),
    (c28x.overlays, "drivers/wire.c", "frame_t *f = (frame_t *)octets;"),
    (c28x.overlays, "drivers/wire.c", "v = *(const uint32_t *)&octets[2];"),
    (c28x.overlays, "drivers/wire.c", "union {\n    octet_t octets[4];\n    uint32_t value;\n} u;"),
    (c28x.formats, "firmware/task.c", 'System_printf("%d ticks", n);'),
    (c28x.formats, "drivers/wire.c", 'put(line, "%08lx");'),
    (c28x.characters, "drivers/wire.c", "void f(void)\n{\n    char sum = 0;\n    sum += next();\n}"),
    (c28x.characters, "drivers/wire.c", "void f(char c)\n{\n    c++;\n}"),
    (c28x.characters, "drivers/wire.c", "void f(char c)\n{\n    x = table[c];\n}"),
    (c28x.characters, "drivers/wire.c", "text[i] ^= key;"),
    (c28x.octets, "firmware/task.c", "feed(&parser, burst->octets[i]);"),
    (c28x.octets, "firmware/task.c", "feed(&parser, (octet_t)burst->octets[i]);"),
    (c28x.timeouts, "firmware/task.c", "Semaphore_pend(ready, 65535U);"),
    (c28x.timeouts, "firmware/task.c", "#define LONG_MS 70000U\nTask_sleep(LONG_MS);"),
    (c28x.timeouts, "firmware/task.c", "Event_pend(event, Event_Id_NONE, POLL_MS, wait_ms);"),
    (c28x.timeouts, "firmware/task.c", "Clock_create(tick, first_ms, &clock, NULL);"),
    (c28x.interrupts, "bsp/uart.c", "Interrupt_initModule();"),
    (c28x.interrupts, "bsp/uart.c", "Interrupt_clearACKGroup(INTERRUPT_ACK_GROUP9);"),
    (c28x.interrupts, "firmware/task.c", "static __interrupt void handler(void);"),
    (c28x.interrupts, "firmware/task.c", "void create(int16_t interrupt);"),
)


class Rules(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in GOOD.items():
            self.write(path, text)

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def complaints(self):
        return c28x.check(house.House(self.root))

    def test_nobody_complains_of_a_good_house(self):
        self.assertEqual(self.complaints(), [])

    def test_each_fault_is_named_by_its_rule_alone(self):
        for rule, path, line in BAD:
            with self.subTest(rule=rule.__name__, line=line):
                self.write(path, GOOD[path] + line + "\n")
                found, every = list(rule(house.House(self.root))), self.complaints()
                self.write(path, GOOD[path])
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith(f"{path}:"), found)
                self.assertEqual(every, found)

    def test_a_flag_cleared_before_the_fifo_is_read(self):
        cleared = "    SCI_clearInterruptStatus(uart, SCI_INT_RXFF);\n"
        body = GOOD["bsp/uart.c"].replace(cleared, "").replace("    burst->", cleared + "    burst->")
        self.write("bsp/uart.c", body)
        self.assertEqual(len(self.complaints()), 1)

    def test_errors_that_are_never_cleared(self):
        for call in ("SCI_performSoftwareReset", "SCI_clearOverflowStatus"):
            self.write("bsp/uart.c", GOOD["bsp/uart.c"].replace(f"    {call}(base);\n", ""))
            self.assertEqual(len(self.complaints()), 1, call)


if __name__ == "__main__":
    unittest.main()
