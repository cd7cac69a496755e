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
