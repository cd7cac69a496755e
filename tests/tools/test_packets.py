"""tools/xctu/packets.py and the list it writes."""
import contextlib
import io
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/xctu"))
import packets  # noqa: E402


class Packets(unittest.TestCase):
    def test_the_file_is_up_to_date(self):
        self.assertEqual(packets.FILE.read_text(encoding="utf-8"), packets.document(), "run tools/xctu/packets.py")

    def test_a_packet_as_xctu_writes_it(self):
        self.assertEqual(packets.document(["#GET KP"]), """<?xml version="1.0" encoding="UTF-8"?>

<data>
  <loop>false</loop>
  <repeat_times>1</repeat_times>
  <repeat_period>500</repeat_period>
  <packets_list>
    <packet name="#GET KP">
      <payload>23474554204B500A</payload>
    </packet>
  </packets_list>
</data>
""")

    def test_what_cannot_be_is_one_line_and_status_2(self):
        for arguments, reason in ((["--sum", "#KP\xf1"], "not ASCII"), (["--with-sums", "/nonexist/x.xml"], "/nonexist/x.xml: No such file")):
            told = io.StringIO()
            with contextlib.redirect_stderr(told):
                self.assertEqual(packets.main(arguments), 2)
            self.assertIn(reason, told.getvalue())
            self.assertEqual(told.getvalue().count("\n"), 1)

    def test_a_line_that_the_firmware_would_refuse_gets_no_sum(self):
        self.assertIn(f"#define TELECOMMAND_LINE_MAX \\\n    {packets.LINE_MAX}U ", (ROOT / "drivers/telecommand.h").read_text(encoding="utf-8"))
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(io.StringIO()) as told:
            self.assertEqual([packets.main(["--sum", "#STOP " + "x" * length]) for length in (21, 22)], [0, 2])
        self.assertEqual(len(said.getvalue().splitlines()), 1)
        self.assertEqual(len(said.getvalue()), packets.LINE_MAX + 1)
        self.assertIn("33 characters with its sum; the firmware takes no line of more than 32", told.getvalue())
        self.assertTrue(all(len(packets.with_sum(command)) <= packets.LINE_MAX for command in packets.COMMANDS))

    def test_names_are_unique_and_say_what_is_sent(self):
        found = list(ElementTree.fromstring(packets.document()).iter("packet"))
        names = [packet.get("name") for packet in found]
        self.assertEqual(len(names), len(set(names)))
        for packet in found:
            self.assertEqual(bytes.fromhex(packet.find("payload").text), packet.get("name").encode("ascii") + b"\n")
            self.assertLessEqual(len(packet.get("name")), 32)


if __name__ == "__main__":
    unittest.main()
