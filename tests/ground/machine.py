"""plomada.wasm in wasmtime: what tests ask of it."""
import ctypes
import tempfile
from pathlib import Path

import wasmtime

TRUTH = ("time_s", "height_m", "altitude_m", "terrain_m", "speed_mps", "thrust_n", "roll_rad", "pitch_rad", "pulse_us",
         "contacts")
GROUND = 161    # VIEW_POINTS of sim/devices/view.h


class Machine:
    """One instance: memory and all, as after loading the page."""

    def __init__(self, module_path, directory):
        engine = wasmtime.Engine()
        self.store = wasmtime.Store(engine)
        self.directory = Path(directory)
        self.stdout = self.directory / "stdout.txt"
        wasi = wasmtime.WasiConfig()
        wasi.preopen_dir(str(directory), "/")
        wasi.stdout_file = str(self.stdout)
        wasi.inherit_stderr()
        self.store.set_wasi(wasi)
        linker = wasmtime.Linker(engine)
        linker.define_wasi()
        self.exports = linker.instantiate(self.store, wasmtime.Module.from_file(engine, str(module_path))).exports(self.store)
        self.call("_initialize")
        self.room = self.call("vehicle_room")

    def call(self, name, *arguments):
        return self.exports[name](self.store, *arguments)

    def put(self, octets):
        self.exports["memory"].write(self.store, octets, self.room)
        return len(octets)

    def fly(self, *arguments):
        """(exit status, what was printed)"""
        before = self.stdout.stat().st_size if self.stdout.exists() else 0
        status = self.call("vehicle_fly", self.put(b"".join(text.encode() + b"\0" for text in arguments)))
        return status, self.stdout.read_text()[before:]

    def power_on(self, seed=1):
        self.call("vehicle_power_on", seed)

    def type(self, text):
        self.call("vehicle_type", self.put(text.encode()))

    def figures(self):
        """The list of vehicle_plant(): name -> (unit, least, most, value, counts at once)"""
        size = self.call("vehicle_plant")
        text = bytes(self.exports["memory"].read(self.store, self.room, self.room + size)).decode()
        rows = [line.split("\t") for line in text.splitlines()]
        return {row[0]: (row[1], float(row[2]), float(row[3]), float(row[4]), row[5] == "1") for row in rows}

    def set(self, **figures):
        return [self.call("vehicle_set", self.put(f"{name}={value}".encode())) for name, value in figures.items()]

    def lay(self, text):
        """A place for the next power-on; what is wrong with it."""
        size = self.call("vehicle_lay", self.put(text.encode()))
        return bytes(self.exports["memory"].read(self.store, self.room, self.room + size)).decode()

    def map(self):
        """[(kind, [numbers])]"""
        size = self.call("vehicle_map")
        lines = bytes(self.exports["memory"].read(self.store, self.room, self.room + size)).decode().splitlines()
        return [(line.split()[0], [float(word) for word in line.split()[1:]]) for line in lines]

    def view(self):
        """x, y, heading; the ground along the nose; the beams as (from x, y, z, to x, y, z, meets)."""
        at, count = self.call("vehicle_view"), 3 + GROUND + 3 * 7
        octets = bytes(self.exports["memory"].read(self.store, at, at + 8 * count))
        values = list((ctypes.c_double * count).from_buffer_copy(octets))
        beams = [values[3 + GROUND + 7 * i:10 + GROUND + 7 * i] for i in range(3)]
        return values[:3], values[3:3 + GROUND], beams

    def run(self, seconds):
        """What the operator's terminal receives meanwhile."""
        heard = ""
        for _ in range(round(seconds * 20)):
            assert self.call("vehicle_step", 50) == 1, "the firmware has stopped"
            count = self.call("vehicle_heard")
            heard += bytes(self.exports["memory"].read(self.store, self.room, self.room + count)).decode("ascii")
        return heard

    def truth(self):
        at = self.call("vehicle_truth")
        octets = bytes(self.exports["memory"].read(self.store, at, at + 8 * len(TRUTH)))
        return dict(zip(TRUTH, (ctypes.c_double * len(TRUTH)).from_buffer_copy(octets)))


def scratch():
    return tempfile.TemporaryDirectory(prefix="plomada-wasm-")
