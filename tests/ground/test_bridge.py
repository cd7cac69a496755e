"""The bridge between a flight and the page. Argument: the plomada program; then unittest's."""
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

PROGRAM = str(Path(sys.argv.pop(1)).resolve())
ROOT = Path(__file__).resolve().parents[2]
COMMAND = (PROGRAM, "fly", "hover-60s", "--realtime")
PATIENCE_S = 5.0


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def start(port, *command):
    return subprocess.Popen([sys.executable, "-B", str(ROOT / "tools/ground/bridge.py"), str(port), *command], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


class Bridge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.port = free_port()
        cls.bridge = start(cls.port, *COMMAND)
        cls.addClassCleanup(cls.stop, cls.bridge)
        cls.address = cls.bridge.stdout.readline().split()[1]

    @staticmethod
    def stop(bridge):
        bridge.terminate()
        bridge.communicate(timeout=10)

    def enter(self, path="/", **options):
        """Again while the bridge has not yet noticed that the client before has left."""
        until = time.monotonic() + PATIENCE_S
        while True:
            try:
                return connect(f"ws://localhost:{self.port}{path}", **options)
            except InvalidStatus as refusal:
                if refusal.response.status_code != 503 or time.monotonic() > until:
                    raise
                time.sleep(0.05)

    def refused(self, status, path="/", **options):
        with self.assertRaises(InvalidStatus) as caught:
            self.enter(path, **options).close()
        self.assertEqual(caught.exception.response.status_code, status, options)

    def test_lines_go_both_ways(self):
        with self.enter() as client:
            client.send(b"#PING 7\n")
            heard, until = b"", time.monotonic() + PATIENCE_S
            while b"OK PING 7" not in heard and time.monotonic() < until:
                heard += client.recv(PATIENCE_S)
            self.assertIn(b"OK PING 7", heard)

    def test_a_late_client_gets_nothing_that_was_said_before_it_came(self):
        self.enter().close()
        time.sleep(3.0)     # 15 lines of telemetry
        with self.enter() as client:
            heard, until = b"", time.monotonic() + 1.0
            while time.monotonic() < until:
                heard += client.recv(PATIENCE_S)
            self.assertLessEqual(heard.count(b"\n"), 8)

    def test_a_second_client_is_refused_and_one_that_left_makes_room(self):
        with self.enter(), self.assertRaises(InvalidStatus) as caught:
            connect(f"ws://localhost:{self.port}/").close()
        self.assertEqual(caught.exception.response.status_code, 503)
        self.enter().close()

    def test_a_page_of_this_machine_enters_and_any_other_only_with_the_printed_address(self):
        key = self.address.rpartition("/")[2]
        self.assertRegex(self.address, rf"^ws://localhost:{self.port}/[0-9a-f]{{16}}$")
        for origin in ("http://localhost:8123", "http://127.0.0.1", "https://[::1]:8443"):
            self.enter(origin=origin).close()
        for origin in ("https://strange.example", "http://localhost.strange.example", "http://localhost:80.strange.example",
                       "http://127.0.0.1.strange.example:80", "http://notlocalhost", "http://localhost@strange.example", "null", "file://"):
            for path in ("/", f"/{key}0", "/0123456789abcdef"):
                self.refused(403, path, origin=origin)
            self.enter(f"/{key}", origin=origin).close()

    def test_the_page_is_told_when_the_flight_ends_and_the_status_is_the_flights(self):
        port = free_port()
        bridge = start(port, *COMMAND, "--duration", "2")
        other = bridge.stdout.readline().split()[1]
        self.assertNotEqual(other.rpartition("/")[2], self.address.rpartition("/")[2], "every bridge has an address of its own")
        with connect(other) as client, self.assertRaises(ConnectionClosed):
            while True:
                client.recv(PATIENCE_S)
        out, error = bridge.communicate(timeout=10)
        self.assertEqual(error, "")
        self.assertIn(bridge.returncode, (0, 1), out)

    def test_what_cannot_be_is_told(self):
        for port, command, reason in ((self.port, COMMAND, "address already in use"), (free_port(), ("true",), "offers no radio"),
                                      (free_port(), ("/nowhere/plomada",), "No such file"), (0, COMMAND, "bridge.py PORT COMMAND"),
                                      ("x", COMMAND, "bridge.py PORT COMMAND")):
            bridge = start(port, *command)
            _, error = bridge.communicate(timeout=10)
            self.assertEqual(bridge.returncode, 2, error)
            self.assertIn(reason, error)


if __name__ == "__main__":
    unittest.main()
