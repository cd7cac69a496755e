"""The response-time analysis against answers that are known, by books and by hand, and against a schedule that is played."""
import math
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools/rta"))
import analysis  # noqa: E402
from analysis import HWI, SWI, TASK, Row  # noqa: E402


def ms(number):
    return round(number * analysis.PS_PER_MS)


class Case(unittest.TestCase):
    def setUp(self):
        self.table, self.options = [], analysis.Options()

    def add(self, kind, priority, period_ms, deadline_ms, cost_ms, **more):
        self.table.append(Row(f"row{len(self.table) + 1}", kind, priority, ms(period_ms), ms(deadline_ms), ms(cost_ms), **more))
        return self.table[-1]

    def task(self, priority, period_ms, cost_ms, deadline_ms=None, **more):
        return self.add(TASK, priority, period_ms, deadline_ms or period_ms, cost_ms, **more)

    def hwi(self, period_ms, cost_ms, **more):
        return self.add(HWI, 0, period_ms, 0, cost_ms, **more)

    def responses(self):
        return [analysis.response(self.table, self.options, row) for row in self.table if row.kind == TASK]

    def expect(self, *responses_ms):
        self.assertEqual(self.responses(), [response if math.isinf(response) else ms(response) for response in responses_ms])

    def holds(self):
        return analysis.late_task(self.table, self.options) is None

    def growth(self, switches_too=False):
        return analysis.growth(self.table, self.options, switches_too)


class KnownAnswers(Case):
    def test_textbook_responses_of_three_tasks(self):
        """Burns and Wellings, Real-Time Systems and Programming Languages: periods 7, 12, 20, costs 3, 3, 5."""
        for priority, period, cost in ((3, 7, 3), (2, 12, 3), (1, 20, 5)):
            self.task(priority, period, cost)
        self.expect(3, 6, 20)
        self.assertTrue(self.holds())

    def test_a_full_processor_may_be_in_time(self):
        """The same book: harmonic periods 80, 40, 20, the processor fully used, and still in time."""
        for priority, period, cost in ((1, 80, 40), (2, 40, 10), (3, 20, 5)):
            self.task(priority, period, cost)
        self.expect(80, 15, 5)
        self.assertEqual(analysis.load(self.table, self.options)["total"], 1.0)
        self.assertAlmostEqual(self.growth()[0], 1.0, places=5)

    def test_the_worst_job_of_a_busy_window_need_not_be_its_first(self):
        """Lehoczky 1990, deadlines beyond the period: responses of the second task's jobs are 114, 102, 116, 104, 118, 106, 94."""
        self.task(2, 70, 26)
        late = self.task(1, 100, 62, deadline_ms=118)
        self.expect(26, 118)
        self.assertTrue(self.holds())
        late.deadline = ms(117.9)
        self.assertFalse(self.holds())

    def test_an_overloaded_level_has_no_bound(self):
        self.task(2, 2, 1.5)
        self.task(1, 4, 1.1, deadline_ms=1000)
        self.expect(1.5, math.inf)
        self.assertFalse(self.holds())
        factor, late = self.growth()
        self.assertLess(factor, 1.0)
        self.assertEqual(late, "row2")

    def test_a_busy_window_without_end_has_no_bound(self):
        self.task(1, 4, 4, deadline_ms=1000, blocking=ms(1))
        self.expect(math.inf)

    def test_jitter_brings_releases_closer_and_adds_to_the_response(self):
        """By hand: w = 3 + ceil(w/4) gives 4; one ms of jitter makes it 3 + ceil((w+1)/4) = 5, seen 6 after the due time."""
        self.task(2, 4, 1)
        self.task(1, 20, 3)
        self.expect(1, 4)
        self.options.jitter = ms(1)
        self.expect(2, 6)

    def test_a_frame_costs_no_more_than_its_octets(self):
        """By hand: 2 + 0.5 ceil(w) = 4 as a stream of one per ms; frames of 3 in 10 ms give 2 + 3 x 0.5 = 3.5."""
        stream = self.hwi(1, 0.5, burst_n=3, burst_period=ms(10))
        task = self.task(1, 100, 2)
        self.expect(4)
        self.options.bursts = True
        self.expect(3.5)
        for cost, response in ((8.5, 10), (9, 11)):
            task.cost = ms(cost)
            self.expect(response)
        self.assertEqual(analysis.load(self.table, self.options)["hwi"], 0.15)
        stream.burst_n = 0
        self.expect(9)

    def test_late_frames_do_not_speed_up_the_wire(self):
        """A frame may come late and the next in time, but octets of a wire come no closer: by hand, w = 9 + 0.5 (3 + 3), w = 2 + 0.5 x 3 and,
        with frames of 10, w = 2 + 0.5 ceil(w)."""
        stream = self.hwi(1, 0.5, burst_n=3, burst_period=ms(10))
        task = self.task(1, 100, 9)
        self.options.bursts, self.options.jitter = True, ms(5)
        self.expect(5 + 12)
        task.cost = ms(2)
        self.expect(5 + 3.5)
        stream.burst_n, stream.burst_period = 10, ms(20)
        self.expect(5 + 4)

    def test_switches_count_per_job_and_per_blocking_and_not_for_interrupts(self):
        """By hand: 1 + 0.1 own, 2 x 0.05 + 2 x 0.1 blocked, 2 + 0.1 from above; the Swi switches nothing."""
        self.add(SWI, 0, 50, 0, 0.5)
        self.task(2, 50, 2)
        self.task(1, 50, 1, blocking=ms(0.1), blockings=2)
        self.options.switches = ms(0.1)
        self.assertEqual(self.responses()[1], ms(1.1 + 0.3 + 2.1 + 0.5))
        self.assertAlmostEqual(analysis.load(self.table, self.options)["switches"], 0.004)

    def test_server_accesses_add_to_the_cost_of_their_task(self):
        self.task(2, 50, 1, accesses=3)
        low = self.task(1, 50, 1, accesses=2)
        self.options.access = ms(0.01)
        self.expect(1.03, 2.05)
        self.assertEqual(analysis.demand(self.table, self.options, low), ms(2.05))

    def test_equal_priorities_count_against_each_other(self):
        self.task(1, 50, 1)
        self.task(1, 50, 2)
        self.expect(3, 3)

    def chain(self, *members):
        return analysis.chain(self.table, self.options, [self.table[at] for at in members])

    def test_a_chain_bears_the_blocking_of_all_its_members(self):
        """By hand: the last of the chain waits for its own blocking (0.1) and for that of the one before (0.2)."""
        self.add(SWI, 0, 100, 0, 0.5)
        self.task(2, 100, 2, blocking=ms(0.2))
        self.task(1, 100, 1, blocking=ms(0.1))
        self.assertEqual(self.responses()[1], ms(3.6))
        self.assertEqual(self.chain(0, 1, 2), ms(3.8))
        self.assertEqual(self.chain(2), ms(3.6))

    def test_a_task_blocks_a_chain_once_at_most(self):
        """By hand: own 3 and the Swi's 0.5, then 0.1 and a switch of 0.01 for each blocking, 0.01 for each of the two jobs."""
        self.add(SWI, 0, 100, 0, 0.5)
        first, last = (self.task(5 - cost, 100, 3 - cost, blockings=2, blocking=ms(0.2)) for cost in (1, 2))
        self.options.switches = ms(0.01)
        self.assertEqual(self.chain(0, 1, 2), ms(3.96))
        first.blocked_by = ("low", "lower")
        self.assertEqual(self.chain(0, 1, 2), ms(3.96), "the last one's blockers are not told")
        for blocked_by, expected in ((("lower", "lowest"), 3.85), (("low", "lower"), 3.74)):
            last.blocked_by = blocked_by
            self.assertEqual(self.chain(0, 1, 2), ms(expected))
        first.blockings = last.blockings = first.blocking = last.blocking = 0
        self.assertEqual(self.chain(0, 1, 2), ms(3.52))

    def test_what_waits_comes_at_once(self):
        """By hand: up to 3 octets wait for the fourth, so a window of 2 ms sees 5: 2 + 0.05 x 5 = 2.25, which ends within the same octet's
        time; the wait of the task itself adds to its response."""
        stream = self.hwi(1, 0.05)
        task = self.task(1, 100, 1.7)
        self.expect(1.8)
        stream.jitter = ms(3)
        self.expect(1.95)
        task.jitter = ms(0.5)
        self.expect(2.45)
        stream.burst_n, stream.burst_period, self.options.bursts = 4, ms(50), True
        self.expect(0.5 + 1.7 + 0.2)

    def test_a_frame_that_has_ended_does_not_come_again_at_once(self):
        """By hand, frames of 10 octets, 1 ms each, in 50 ms: a chain that begins with a frame's last octet sees that one and no other before
        40 ms have gone; one that does not sees all 10."""
        stream = self.hwi(1, 0.5, burst_n=10, burst_period=ms(50))
        self.add(SWI, 0, 1000, 0, 2)
        task = self.task(1, 1000, 3)
        self.assertEqual(self.chain(0, 1, 2), ms(10), "an endless stream")
        self.options.bursts = True
        self.assertEqual((self.chain(0, 1, 2), self.chain(1, 2)), (ms(5.5), ms(10)))
        task.cost = ms(30)
        self.assertEqual((self.chain(0, 1, 2), self.chain(1, 2)), (ms(32.5), ms(37)))
        stream.jitter = ms(2)
        self.assertEqual(self.chain(0, 1, 2), ms(33.5), "two had waited for the last")
        task.cost = ms(37.6)
        self.assertGreater(self.chain(0, 1, 2), ms(41.1), "the next frame")

    def test_tasks_are_listed_by_priority_and_equals_in_their_order(self):
        self.task(1, 10, 1)
        self.hwi(10, 1)
        for priority in (7, 1, 3):
            self.task(priority, 10, 1)
        self.assertEqual([row.name for row in analysis.tasks(self.table)], ["row3", "row5", "row1", "row4"])

    def test_the_seed_freezes_the_horizon_of_each_interrupt(self):
        """By hand: interrupts of 0.1 per 1 ms; the first and second are counted up to the second deadline (20), the third up to the third
        (30), where the last task's true demand has 30 of each."""
        for _ in range(3):
            self.hwi(1, 0.1)
        three = [self.task(priority, period, 1) for priority, period in ((3, 10), (2, 20), (1, 30))]
        self.assertEqual([analysis.demand_seed(self.table, self.options, row) for row in three],
                         [ms(3 + 1), ms(6 + 2 + 1), ms(2 + 2 + 3 + 3 + 2 + 1)])
        self.assertEqual(analysis.demand(self.table, self.options, three[2], switching=False), ms(3 + 3 + 3 + 3 + 2 + 1))
        self.options.switches = ms(0.5)
        self.assertEqual(analysis.demand(self.table, self.options, three[2]), ms(3 + 3 + 3 + 3 + 2 + 1 + 6 * 0.5))

    def test_one_task_alone_has_one_horizon(self):
        self.hwi(1, 0.1)
        self.hwi(1, 0.1)
        self.assertEqual(analysis.demand_seed(self.table, self.options, self.task(1, 10, 1)), ms(3))

    def test_a_window_that_ends_with_a_release_does_not_count_it(self):
        self.hwi(0.04, 0.0024)
        task = self.task(1, 1000, 0.1 - 3 * 0.0024)
        self.expect(0.1)
        task.cost += ms(0.02)
        self.expect(0.12)
        task.cost += 1
        self.assertEqual(self.responses(), [ms(0.1224) + 1])

    def test_accesses_and_critical_sections_grow_as_well(self):
        """By hand: f (1 + 1 + 2) + 2 = 10 or, with the switches, f (1 + 1 + 2 + 2) = 10."""
        self.task(1, 10, 1, accesses=1, blocking=ms(2), blockings=1)
        self.options.access = self.options.switches = ms(1)
        self.assertAlmostEqual(self.growth()[0], 2.0, delta=1e-5)
        self.assertAlmostEqual(self.growth(True)[0], 10 / 6, delta=1e-5)

    def test_growth_is_zero_when_no_cost_is_to_blame(self):
        self.task(1, 10, 1)
        self.options.jitter = ms(11)
        self.assertEqual(self.growth()[0], 0.0)


class RandomTables(Case):
    def draw(self, seed):
        dice = random.Random(seed)
        self.setUp()
        for _ in range(dice.randint(0, 3)):
            frames = {"burst_n": dice.randint(0, 5), "burst_period": ms(dice.uniform(5, 50))} if dice.random() < 0.5 else {}
            self.hwi(dice.uniform(0.5, 5), dice.uniform(0.01, 0.1), jitter=ms(dice.uniform(0, 1) * dice.randint(0, 1)), **frames)
        for _ in range(dice.randint(0, 2)):
            self.add(SWI, 0, dice.uniform(10, 100), 0, dice.uniform(0.1, 1))
        for _ in range(dice.randint(1, 5)):
            period, blockings = dice.uniform(10, 200), dice.randint(0, 3)
            self.task(dice.randint(1, 6), period, dice.uniform(0.2, 8), deadline_ms=period * dice.uniform(0.3, 1.0), blockings=blockings,
                      blocking=ms(dice.uniform(0, 0.3) * blockings), accesses=dice.randint(0, 4))
        self.options = analysis.Options(ms(dice.uniform(0, 0.1)), ms(dice.uniform(0, 0.05)), 0, dice.random() < 0.5)
        return dice

    def none_shorter(self, before):
        after = self.responses()
        self.assertTrue(all(one <= other for one, other in zip(before, after)))
        return after

    def test_dearer_later_or_more_blocked_never_shortens_a_response(self):
        for seed in range(150):
            with self.subTest(seed):
                dice = self.draw(seed)
                before = self.responses()
                dice.choice(self.table).cost += ms(dice.uniform(0, 0.5))
                before = self.none_shorter(before)
                self.table[-1].blocking += ms(0.1)
                after = self.none_shorter(before)
                self.assertTrue(after[-1] > before[-1] or math.isinf(after[-1]))
                self.options.jitter = ms(dice.uniform(0.1, 3))
                before = self.none_shorter(after)
                self.options.bursts = False
                self.none_shorter(before)

    def test_a_response_is_at_least_the_job_and_at_most_the_demand_that_fits(self):
        fitting = 0
        for seed in range(300):
            self.draw(seed)
            self.options.bursts = False
            for row in analysis.tasks(self.table):
                response, demand = analysis.response(self.table, self.options, row), analysis.demand(self.table, self.options, row)
                plain = analysis.demand(self.table, self.options, row, switching=False)
                self.assertLessEqual(analysis.demand_seed(self.table, self.options, row), plain, seed)
                self.assertLessEqual(plain, demand, seed)
                self.assertGreaterEqual(response, row.cost + self.options.switches + row.blocking, seed)
                if demand <= row.deadline:
                    fitting += 1
                    self.assertLessEqual(response, demand, seed)
        self.assertGreater(fitting, 150)

    def test_all_holds_exactly_when_each_response_is_in_time(self):
        held = 0
        for seed in range(200):
            self.draw(seed)
            in_time = all(response <= row.deadline for response, row in
                          zip(self.responses(), (row for row in self.table if row.kind == TASK)))
            self.assertEqual(in_time, self.holds(), seed)
            held += in_time
        self.assertTrue(40 < held < 160, held)

    def test_growth_is_the_edge(self):
        for seed in range(40):
            self.draw(seed)
            for switches_too in (False, True):
                factor, late = self.growth(switches_too)

                def missed(scale):
                    return analysis.late_task_scaled(self.table, self.options, scale, switches_too)

                self.assertGreater(factor, 0.0, seed)
                self.assertIsNone(missed(factor), seed)
                self.assertIsNotNone(missed(factor * 1.000001), seed)
                self.assertEqual(self.holds(), missed(1.0) is None, seed)
                self.assertTrue(any(row.name == late and row.kind == TASK for row in self.table), seed)


class Played(Case):
    def play(self, ticks):
        """Longest response of each task when all are released together and the processor runs the first of those that wait, in ms."""
        periods = [row.period // analysis.PS_PER_MS for row in self.table]
        costs = [row.cost // analysis.PS_PER_MS for row in self.table]
        count = range(len(self.table))
        released, finished, left, worst = ([0] * len(self.table) for _ in range(4))
        for now in range(ticks):
            for at in count:
                released[at] += now % periods[at] == 0
            run = next((at for at in count if released[at] > finished[at]), None)
            if run is None:
                break
            left[run] = (left[run] or costs[run]) - 1
            if left[run] == 0:
                worst[run] = max(worst[run], now + 1 - finished[run] * periods[run])
                finished[run] += 1
        return worst

    def test_responses_equal_those_of_a_schedule_played_tick_by_tick(self):
        played = beyond_period = 0
        for seed in range(800):
            dice = random.Random(seed)
            self.setUp()
            for at in range(dice.randint(1, 4)):
                period = dice.randint(3, 40)
                self.task(10 - at, period, dice.randint(1, 1 + period // 3), deadline_ms=4 * period)
            if analysis.load(self.table, self.options)["total"] >= 1.0:
                continue
            worst = [ms(response) for response in self.play(20000)]
            self.assertEqual(self.responses(), worst, seed)
            played += 1
            beyond_period += any(response > row.period for response, row in zip(worst, self.table))
        self.assertGreater(played, 400)
        self.assertGreater(beyond_period, 5)


if __name__ == "__main__":
    unittest.main()
