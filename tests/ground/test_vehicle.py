"""The WebAssembly build of the PC board against the native one: test_vehicle.py PLOMADA SOURCE. Builds plomada.wasm first;
status 77 (skipped) says what is missing."""
import importlib.util
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WASM = ROOT / "build-wasm" / "plomada.wasm"
PLOMADA = None


def what_is_missing():
    if not any(shutil.which(f"clang{version}") for version in ("", *(f"-{number}" for number in range(14, 31)))):
        return "clang"
    if not shutil.which("wasm-opt"):
        return "wasm-opt"
    if not Path("/usr/include/wasm32-wasi/stdio.h").exists():
        return "wasi-libc"
    return None if importlib.util.find_spec("wasmtime") else "wasmtime of PyPI"


class Vehicle(unittest.TestCase):
    def setUp(self):
        scratch = machine.scratch()
        self.addCleanup(scratch.cleanup)
        self.directory = Path(scratch.name)

    def native(self, scenario, seed):
        run = subprocess.run([PLOMADA, "fly", scenario, "--seed", str(seed), "--csv", self.directory / "native.csv",
                              "--json", self.directory / "native.json"], capture_output=True, text=True, check=False)
        return self.results("native", run.returncode, run.stdout)

    def results(self, name, status, text):
        return status, text, (self.directory / f"{name}.csv").read_text(), (self.directory / f"{name}.json").read_text()

    def wasm(self, vehicle, scenario, seed):
        status, text = vehicle.fly(scenario, "--seed", str(seed), "--csv", "/wasm.csv", "--json", "/wasm.json")
        return self.results("wasm", status, text)

    def test_flights_of_pinned_seeds_are_those_of_the_native_build_octet_by_octet(self):
        for scenario, seed in (("est-60cm-ramp", 1), ("est-60cm-ramp", 2), ("pid-60cm-ramp", 1)):
            with self.subTest(scenario=scenario, seed=seed):
                vehicle = machine.Machine(WASM, self.directory)
                self.assertEqual(self.wasm(vehicle, scenario, seed), self.native(scenario, seed))

    def test_a_second_flight_in_the_same_instance_is_the_first_one_again(self):
        vehicle = machine.Machine(WASM, self.directory)
        first = self.wasm(vehicle, "est-60cm-ramp", 1)
        self.wasm(vehicle, "pid-60cm-ramp", 3)
        self.assertEqual(self.wasm(vehicle, "est-60cm-ramp", 1), first)

    def test_a_vehicle_that_is_kept_alive_answers_takes_off_and_hovers_and_so_it_does_after_a_second_power_on(self):
        vehicle = machine.Machine(WASM, self.directory)
        heard = []
        for _ in range(2):
            vehicle.power_on(7)
            log = vehicle.run(20)
            vehicle.type("#SETR 0.6\n")
            log += vehicle.run(8)
            self.assertIn("\nOK SETR 0.6\r\n", log)
            self.assertAlmostEqual(vehicle.truth()["height_m"], 0.6, delta=0.05)
            heard.append(log)
        self.assertEqual(heard[0], heard[1])

    def test_a_fault_of_the_firmware_stops_it_and_the_watchdog_starts_it_anew(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.power_on(1)
        vehicle.run(14)
        vehicle.call("vehicle_power_laser", 0)
        self.assertIn("laser:LOST", vehicle.run(3))
        vehicle.call("vehicle_power_laser", 1)
        self.assertIn("laser:OK", vehicle.run(15))

    def airborne(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.power_on(7)
        vehicle.run(20)
        vehicle.type("#SETR 0.6\n")
        vehicle.run(6)
        self.assertAlmostEqual(vehicle.truth()["height_m"], 0.6, delta=0.05)
        return vehicle

    def test_every_plant_figure_of_the_program_can_be_set_within_its_limits_and_not_beyond(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.power_on(1)
        told = subprocess.run([PLOMADA, "list", "--plant"], capture_output=True, text=True, check=True).stdout
        names = [line.split()[0].removeprefix("plant.") for line in told.splitlines() if line.startswith("  plant.")]
        figures = vehicle.figures()
        self.assertEqual(list(figures), names)
        for name, (_, least, most, value, _) in figures.items():
            with self.subTest(name=name):
                self.assertEqual(vehicle.set(**{name: most * 2 + 1}), [0])
                self.assertEqual(vehicle.set(**{name: least}), [1])
                self.assertAlmostEqual(vehicle.figures()[name][3], least, delta=1e-6 * abs(least))
                self.assertEqual(vehicle.set(**{name: value}), [1])
        self.assertEqual(vehicle.set(nonsense=1), [0])

    def test_figures_count_in_the_middle_of_a_flight(self):
        for seen, figures in (("flags:2", {"imu_mute": 1e9, "imu_mute_start": 0}), ("flags:1\r", {"rays_lost": 1}),
                              ("doubt:SIGHT", {"block_mm": 500, "sight_blocked": 1}), ("flags:512", {"acc_bias": 8}),
                              ("laser:LOST", {"outage_start": 0, "outage": 3}), ("laser:LOST", {"scanner_restart_start": 0})):
            with self.subTest(seen=seen):
                vehicle = self.airborne()
                self.assertNotIn(seen, vehicle.run(2))
                self.assertNotIn(0, vehicle.set(**figures))
                self.assertIn(seen, vehicle.run(4))

    def test_a_gust_lifts_and_a_heavier_vehicle_sinks_and_both_come_back(self):
        vehicle = self.airborne()
        now = vehicle.truth()["time_s"]
        vehicle.set(gust_start=now, gust_length=0.5, gust=4)
        vehicle.run(0.6)
        self.assertGreater(vehicle.truth()["height_m"], 0.65)
        vehicle.run(5)
        self.assertAlmostEqual(vehicle.truth()["height_m"], 0.6, delta=0.05)
        vehicle.set(hover_thrust=8.6)
        vehicle.run(0.4)
        self.assertLess(vehicle.truth()["height_m"], 0.57)
        vehicle.run(8)
        self.assertAlmostEqual(vehicle.truth()["height_m"], 0.6, delta=0.06)

    def test_a_figure_stays_through_the_next_power_on_and_then_takes_effect_if_it_could_not_at_once(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.power_on(3)
        self.assertFalse(vehicle.figures()["imu_stock"][4])
        vehicle.set(imu_stock=1)
        vehicle.run(3)
        vehicle.type("#IMU\n")
        self.assertIn("seen:accelerations+angles", vehicle.run(2))
        vehicle.power_on(3)
        self.assertEqual(vehicle.figures()["imu_stock"][3], 1)
        vehicle.run(3)
        vehicle.type("#IMU\n")
        self.assertIn("seen:angles ", vehicle.run(2))

    def test_the_seeds_ramp_comes_by_and_the_beams_end_on_it(self):
        vehicle = self.airborne()
        where, ground, beams = vehicle.view()
        self.assertEqual((max(ground), vehicle.map()), (0.0, []))
        for beam in beams:
            self.assertAlmostEqual(beam[5], 0.0, delta=1e-9)
            self.assertAlmostEqual(beam[2], vehicle.truth()["altitude_m"] + 0.1, delta=0.03)
        vehicle.call("vehicle_go")
        self.assertEqual([kind for kind, _ in vehicle.map()], ["block", "block", "leg"])
        vehicle.run(3)
        after, ground, beams = vehicle.view()
        self.assertAlmostEqual(after[0] - where[0], 1.1, delta=0.2)     # 0.4 m/s, taken up
        self.assertAlmostEqual(max(ground), 0.25, delta=1e-6)
        for beam in beams:
            self.assertAlmostEqual(beam[5], 0.25, delta=1e-6)
        self.assertAlmostEqual(vehicle.truth()["terrain_m"], 0.25, delta=1e-6)

    # The hall's way begins with the order, however long the vehicle stood before.
    def test_a_place_that_is_laid_is_flown_in_after_the_next_power_on(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.power_on(7)
        text = (ROOT / "docs/examples/hall.place").read_text()
        self.assertEqual(vehicle.lay(text), "")
        self.assertEqual(vehicle.map(), [])
        vehicle.power_on(7)
        kinds = [kind for kind, _ in vehicle.map()]
        self.assertEqual((kinds.count("block"), kinds.count("leg")), (2 + 5 + 3 + 1, 2))
        vehicle.run(25)
        vehicle.type("#SETR 0.6\n")
        vehicle.run(6)
        for coordinate in vehicle.view()[0][:2]:
            self.assertAlmostEqual(coordinate, 0.0, delta=0.6)      # its pilot holds it there, in its sway
        vehicle.call("vehicle_go")
        highest = 0.0
        for _ in range(70):
            vehicle.run(0.2)
            _, ground, beams = vehicle.view()
            highest = max(highest, *(beam[5] for beam in beams))
        self.assertGreater(vehicle.view()[0][0], 3.0)
        self.assertGreater(highest, 0.39)       # the table
        self.assertEqual(vehicle.truth()["contacts"], 0)

    def test_a_place_that_cannot_be_read_is_refused_and_the_one_before_stays(self):
        vehicle = machine.Machine(WASM, self.directory)
        vehicle.lay("block 1 0 1 1 0.3")
        self.assertRegex(vehicle.lay("block 2 0 1 1 0.3\nblok 1 2 3"), "^line 2: ")
        self.assertRegex(vehicle.lay("#" * 20000), "longer than")
        vehicle.power_on(1)
        self.assertEqual([numbers[0] for kind, numbers in vehicle.map() if kind == "block"], [1.0])
        self.assertEqual(vehicle.lay(""), "")
        vehicle.power_on(1)
        self.assertEqual(vehicle.map(), [])


if __name__ == "__main__":
    missing = what_is_missing()
    if missing:
        print(f"skipped: no {missing} here; tools/setup/setup.sh ground installs it")
        sys.exit(77)
    PLOMADA = sys.argv.pop(1)
    environment = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS")}
    subprocess.run([ROOT / "tools" / "ground" / "vehicle.sh"], check=True, env=environment, stdout=subprocess.DEVNULL)
    sys.path.insert(0, str(HERE))
    import machine

    unittest.main()
