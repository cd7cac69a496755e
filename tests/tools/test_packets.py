"""tools/xctu/packets.py and the list it writes."""
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

    def test_names_are_unique_and_say_what_is_sent(self):
        found = list(ElementTree.fromstring(packets.document()).iter("packet"))
        names = [packet.get("name") for packet in found]
        self.assertEqual(len(names), len(set(names)))
        for packet in found:
            self.assertEqual(bytes.fromhex(packet.find("payload").text), packet.get("name").encode("ascii") + b"\n")
            self.assertLessEqual(len(packet.get("name")), 32)


if __name__ == "__main__":
    unittest.main()
