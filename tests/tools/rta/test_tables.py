"""The tables of the seed and of this firmware: what they must be, and what the analysis says of them. Argument: an answer to `#PERF COSTS` of
the simulated board.
"""
import csv
import re
import sys
import unittest
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/rta"))
import analysis  # noqa: E402
import limits  # noqa: E402
import measured  # noqa: E402
import table as tables  # noqa: E402
from analysis import HWI, PS_PER_MS, SWI, TASK  # noqa: E402
from rta import ACCESS_MS, SWITCHES_MS  # noqa: E402

ANSWER = sys.argv.pop(1)


def ms(ps):
    return ps / PS_PER_MS


def constant(header, name):
    """Of a #define with a plain number."""
    return int(re.search(rf"#define {name} (\d+)", (ROOT / header).read_text(encoding="utf-8"))[1])


class Tables(unittest.TestCase):
    def setUp(self):
        self.options = analysis.Options(tables.time(SWITCHES_MS), tables.time(ACCESS_MS))
        self.load("seed")

    def load(self, name):
        self.table = tables.load(name)
        self.tasks = analysis.tasks(self.table)

    def row(self, name):
        return tables.find(self.table, name)

    def holds(self):
        return analysis.late_task(self.table, self.options) is None

    def each(self, figure, **more):
        return [ms(figure(self.table, self.options, task, **more)) for task in self.tasks]

    def test_the_seed_table_is_figure_a4_1(self):
        self.assertEqual(
            [(row.name, row.kind, row.priority, ms(row.period), ms(row.deadline), ms(row.cost), ms(row.blocking), row.blockings, row.accesses)
             for row in self.table],
            [("Clock", HWI, 0, 1, 0, 0.015, 0, 0, 0), ("SCIA_RX", HWI, 0, 0.04, 0, 0.0024, 0, 0, 0), ("SCIA_TX", HWI, 0, 0.04, 0, 0.002, 0, 0, 0),
             ("SCIB_RX", HWI, 0, 0.173, 0, 0.0024, 0, 0, 0), ("SCIB_TX", HWI, 0, 0.173, 0, 0.002, 0, 0, 0),
             ("SCIC_RX", HWI, 0, 0.938, 0, 0.0024, 0, 0, 0), ("SCIC_TX", HWI, 0, 0.938, 0, 0.002, 0, 0, 0),
             ("IMU_SWI", SWI, 0, 25, 0, 0.081, 0, 0, 0), ("Laser_SWI", SWI, 0, 100, 0, 0.302, 0, 0, 0), ("XBee_SWI", SWI, 0, 300, 0, 0.124, 0, 0, 0),
             ("TaskIMU", TASK, 6, 25, 25, 0.16, 0.0093, 1, 0), ("TaskReceiveLaser", TASK, 5, 100, 100, 1.02, 0.0186, 2, 0),
             ("TaskControl", TASK, 4, 108, 108, 0.4, 0.0279, 3, 0), ("TaskSendLaser", TASK, 3, 150, 150, 0.0068, 0.0186, 2, 0),
             ("TaskSendComm", TASK, 2, 200, 200, 1, 0.0093, 1, 0), ("TaskReceiveComm", TASK, 1, 300, 300, 0.83, 0, 0, 0)])

    def test_the_seed_demand_is_figure_a4_2_to_the_digit(self):
        self.assertEqual(self.each(analysis.demand_seed), [4.6151, 18.061, 20.7323, 22.5766, 24.8147, 29.7308])

    def test_the_corrected_demand(self):
        """Computed once by an independent script in rational arithmetic, as are all figures below."""
        self.assertEqual(self.each(analysis.demand, switching=False), [4.6151, 18.061, 21.3323, 28.4266, 37.6083, 57.5676])
        self.assertEqual(self.each(analysis.demand), [4.6721, 18.346, 21.7883, 29.0536, 38.4633, 58.8786])

    def test_the_true_responses_of_the_seed_table(self):
        self.assertEqual(self.each(analysis.response), [0.9461, 2.3086, 2.9155, 2.913, 4.1009, 5.073])
        self.assertTrue(self.holds())

    def test_the_seed_table_grows_5_19_times_before_it_is_late(self):
        factor, late = analysis.growth(self.table, self.options, False)
        self.assertAlmostEqual(factor, 5.188649, delta=2e-5)
        self.assertEqual(late, "TaskReceiveComm")
        self.assertAlmostEqual(analysis.growth(self.table, self.options, True)[0], 5.095312, delta=2e-5)

    def test_the_load_of_the_seed_table(self):
        load = analysis.load(self.table, self.options)
        for kind, share in ((HWI, 0.155), (SWI, 0.007), (TASK, 0.028), ("switches", 0.004), ("total", 0.194)):
            self.assertAlmostEqual(load[kind], share, delta=5e-4)

    def control(self):
        return ms(analysis.response(self.table, self.options, self.row("TaskControl")))

    def test_variants_of_the_control_task(self):
        self.options.jitter = 3 * PS_PER_MS
        self.assertEqual(self.control(), 3.0 + 3.4727)
        self.options.jitter, self.options.bursts = 0, True
        self.assertEqual(self.control(), 2.7531)
        self.options.bursts = False
        self.row("TaskControl").blocking -= 3 * self.options.switches
        self.assertEqual(self.control(), 2.7137)
        self.load("seed")
        for row in self.table:
            row.cost += self.options.switches if row.kind == SWI else 0
        self.assertEqual(self.control(), 3.1367)

    def chain(self, *names):
        return ms(analysis.chain(self.table, self.options, [self.row(name) for name in names]))

    def test_from_a_scan_to_the_pulse(self):
        self.assertEqual(self.chain("Laser_SWI", "TaskReceiveLaser", "TaskControl"), 3.0895)
        self.options.bursts = True
        self.assertEqual(self.chain("Laser_SWI", "TaskReceiveLaser", "TaskControl"), 2.9021)

    def test_from_a_scan_to_the_pulse_of_this_firmware(self):
        """By hand, in microseconds, for the frame's last octet: own 302 + 1020 + 400, 7 accesses, 2 jobs' switches, 3 blockings; from above
        226.3 + 81 + 124, in 2.7495 ms 3 ticks of 15 + 7.2, octets of 2.4: 8, 23, 3, and of 2: 17, 18."""
        self.load("plomada")
        self.options.bursts = True
        by_hand_us = 1722 + 7 * 9.3 + 2 * 57 + 3 * 66.3 + 226.3 + 81 + 124 + 3 * 22.2 + 34 * 2.4 + 35 * 2
        self.assertAlmostEqual(1000 * self.chain("SCIA_RX", "Laser_SWI", "TaskReceiveLaser", "TaskControl"), by_hand_us, delta=0.05)

    def expect_tasks(self, expected):
        for task, (priority, period_ms) in expected.items():
            self.assertEqual((self.row(task).priority, ms(self.row(task).period)), (priority, period_ms), task)

    def test_the_firmware_table_has_the_firmware_s_priorities_and_periods(self):
        self.load("plomada")
        schedule = "firmware/schedule.h"
        periods = {"TaskIMU": 25, "TaskReceiveLaser": 100, "TaskControl": constant(schedule, "CONTROL_PERIOD_MS"),
                   "TaskSendLaser": constant(schedule, "SEND_LASER_SEARCH_MS"), "TaskSendComm": constant(schedule, "SEND_COMM_PERIOD_MS"),
                   "TaskReceiveComm": 300}
        priorities = ("IMU", "RECEIVE_LASER", "CONTROL", "SEND_LASER", "SEND_COMM", "RECEIVE_COMM")
        self.expect_tasks({task: (constant(schedule, f"TASK_{name}_PRIORITY"), period)
                           for (task, period), name in zip(periods.items(), priorities)})
        self.assertEqual([task.name for task in self.tasks], list(periods))

    def test_the_table_of_law_est_differs_in_the_control_task_alone(self):
        """Law EST: a cycle for each IMU frame and one for each height, each done before the next frame."""
        self.load("plomada")
        before, control = self.table, self.row("TaskControl")
        self.load("plomada-est")
        cycles = [replace(control, name=name, period=period * PS_PER_MS, deadline=25 * PS_PER_MS, cost=cost)
                  for name, period, cost in (("TaskControl", 25, control.cost), ("TaskControl_height", 100, self.row("TaskControl_height").cost))]
        at = before.index(control)
        self.assertEqual(self.table, before[:at] + cycles + before[at + 1:])
        self.assertTrue(self.holds())

    def test_a_cycle_with_three_mirrors_costs_so_many_times_the_seeds_as_it_has_instructions(self):
        """tools/bench/baseline.csv; of the seed's law the same bench counts TaskControl."""
        with (ROOT / "tools/bench/baseline.csv").open(encoding="utf-8") as file:
            counted = {row["step"]: int(row["instructions"]) for row in csv.DictReader(file)}
        self.load("plomada-est")
        ratio = self.row("TaskControl_height").cost / self.row("TaskControl").cost
        self.assertAlmostEqual(ratio, counted["TaskControl_THREE"] / counted["TaskControl"], delta=0.05)
        page = (ROOT / "docs/realtime.md").read_text(encoding="utf-8")
        ignoring = float(re.search(r"--set TaskControl_height\.cost_ms=([\d.]+)", page).group(1))
        self.assertAlmostEqual(ignoring / (self.row("TaskControl").cost / PS_PER_MS), counted["TaskControl_IGNORE"] / counted["TaskControl"],
                               delta=0.05)

    def test_octets_wait_as_the_fifo_levels_let_them(self):
        """bsp/uart.h and firmware/uart_port.h: so many octets may wait for an interrupt, and come at once."""
        self.load("plomada")
        depth = constant("bsp/uart.h", "BSP_UART_FIFO_DEPTH")
        self.assertIn("#define UART_PORT_BURST (BSP_UART_FIFO_DEPTH / 2U)", (ROOT / "firmware/uart_port.h").read_text(encoding="utf-8"))
        for name, waiting in (("SCIA_RX", depth // 2 - 1), ("SCIB_RX", depth // 2 - 1), ("SCIC_RX", 0), ("SCIA_TX", depth - 1),
                              ("SCIC_TX", depth - 1)):
            self.assertEqual(self.row(name).jitter, waiting * self.row(name).period, name)

    def test_the_firmware_table_counts_the_accesses_of_a_get_of_everything(self):
        """One per parameter, one for the reference, and two to note that the link is alive."""
        self.load("plomada")
        names = re.search(r"typedef enum \{(.*?)PARAMETER_COUNT", (ROOT / "control/parameters.h").read_text(encoding="utf-8"), re.S)[1]
        self.assertEqual(self.row("TaskReceiveComm").accesses, len(re.findall(r"^ +PARAMETER_\w+,", names, re.M)) + 3)

    def test_the_firmware_s_costs_and_interrupts_are_the_seed_s(self):
        seed = self.table
        self.load("plomada")
        self.assertEqual({row.name: row.cost for row in self.table if row.name != "Clock_swi"}, {row.name: row.cost for row in seed})

    def test_the_seed_had_no_tick_that_fetches_octets(self):
        """The tick looks at all three UARTs."""
        interrupt = self.row("SCIA_RX").cost
        self.assertIsNone(self.row("Clock_swi"))
        self.load("plomada")
        self.assertEqual(self.row("Clock_swi").cost, 3 * interrupt)

    def test_every_blocking_of_the_firmware_is_one_access(self):
        self.load("plomada")
        for row in self.tasks:
            self.assertEqual(row.blocking, row.blockings * self.options.access, row.name)

    def test_the_firmware_is_in_time_with_each_release_of_the_control_task(self):
        self.load("plomada")
        for period in (108, 100, 25):
            tables.assign(self.table, [f"TaskControl.period_ms={period}", f"TaskControl.deadline_ms={period}"])
            self.assertTrue(self.holds(), period)

    def test_the_simulation_has_the_costs_of_the_tables(self):
        """sim/costs.c, in microseconds."""
        text = (ROOT / "sim/costs.c").read_text(encoding="utf-8")
        costs = dict(re.findall(r'\{"(\w+)", -?\d+, US\(([\d.]+)\)\}', text))
        self.load("plomada")
        self.assertEqual({name: float(us) for name, us in costs.items()}, {row.name: row.cost / 10 ** 6 for row in self.table})
        for name, told in (("switches", SWITCHES_MS), ("gate_access", ACCESS_MS)):
            self.assertAlmostEqual(float(re.search(rf"\.{name} = US\(([\d.]+)\)", text)[1]), 1000 * float(told), msg=name)

    def test_the_analysis_of_the_simulated_board_is_that_of_its_table(self):
        """Less: few accesses of the table's. More: a wait at a gate is in the cost and in the blocking. There each cycle costs the same."""
        self.load("plomada-est")
        tables.assign(self.table, [f"TaskControl_height.cost_ms={ms(self.row('TaskControl').cost)}"])
        board = measured.apply(self.table, *measured.read(ANSWER))
        for row, other in zip(self.table, board):
            if row.kind != TASK and other.whole:
                self.assertAlmostEqual(row.cost, other.cost, delta=5 * limits.PS_PER_NS, msg=row.name)
        self.assertGreater(sum(row.whole for row in board), 12)
        for row, other in zip(self.tasks, analysis.tasks(board)):
            ratio = analysis.response(board, self.options, other) / analysis.response(self.table, self.options, row)
            self.assertTrue(0.9 < ratio < 1.15, (row.name, ratio))


if __name__ == "__main__":
    unittest.main()
