#!/usr/bin/env python3
"""packets.py [--check | --with-sums FILE | --sum LINE]: writes docs/xctu_packets.xml, the list that XCTU's "Send packets" panel
loads.

With --check nothing is written; the status is 1 when the file differs from what would be. --with-sums writes the same list
with a sum behind each command, for #SUM ON. --sum prints one line with its sum.
"""
import binascii
import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

FILE = Path(__file__).resolve().parents[2] / "docs" / "xctu_packets.xml"
LINE_END = b"\n"
LINE_MAX = 32   # TELECOMMAND_LINE_MAX of drivers/telecommand.h: the firmware refuses a longer line
COMMANDS = (
    "#ARM", "#STOP", "#LAND",
    "#SETR 0.6", "#SETR 0.5", "#SETR 0",
    "#KP 0.015", "#KD 0.008", "#KI 0.01",
    "#USAT 1", "#DSAT 0", "#GRAV 7",
    "#LAW PD", "#LAW PID", "#LAW PIDT", "#LAW EST",
    "#RELEASE FREE", "#RELEASE SCAN",
    "#PKP 6", "#PKI 1.4", "#PKD 2.6",
    "#POSK 2.3", "#VELK 8", "#VUP 0.7", "#VDN 1.1",
    "#TERRAIN FOLLOW", "#TERRAIN IGNORE",
    "#PLANT THRUST", "#PLANT CLIMB", "#CRATE 1", "#GAIN 1", "#LAG 0.12", "#DELAY 0.0185", "#DAMP 2.5", "#CLAG 0.25",
    "#SEL NONE", "#SEL PIN", "#STICK NONE", "#STICK PIN", "#SMID 1500", "#SRATE 0.3", "#BAT NONE", "#BAT PIN", "#CELLS 4S", "#VDIV 10.1", "#VLOW 3.6", "#VLAND 3.5",
    "#WALLS ON", "#WALLS OFF", "#SUM ON", "#SUM OFF*3A0B", "#IDLE 15",
    "#IROLL -ROLL", "#IPITCH PITCH", "#IDOWN Z", "#IUNIT 256", "#IAXES ASSUMED", "#IMU", "#MIRRORS",
    "#DF 105", "#LF 100", "#L 220", "#D1 115", "#L1 98", "#D2 107", "#L2 105",
    "#LAYOUT FRONT", "#LAYOUT TWO", "#LAYOUT THREE", "#SF 389", "#S1 128", "#S2 640", "#SW 17",
    "#SAVE", "#LOAD", "#DEFAULTS", "#DEFAULTS SEED",
    "#LINK 60", "#CALIBRATE 30 5", "#LINK 0",
    "#PING 1", "#STREAM PULSE", "#STREAM OFF", "#HANG TASK",
    "#LOG 10", "#LOG", "#LOG STOP", "#LOG CLEAR",
    "#GET", "#GET KP", "#RC", "#VOLTS", "#LASER", "#PERF", "#PERF RESET", "#VERSION", "#HELP",
)


def with_sum(command):
    """Behind a command the sum of its characters, as the firmware checks it: CRC-16/CCITT-FALSE."""
    line = command.split("*", 1)[0]
    return f"{line}*{binascii.crc_hqx(line.encode('ascii'), 0xFFFF):04X}"


def document(commands=COMMANDS):
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "", "<data>", "  <loop>false</loop>",
             "  <repeat_times>1</repeat_times>", "  <repeat_period>500</repeat_period>", "  <packets_list>"]
    for command in commands:
        lines += [f"    <packet name={quoteattr(command)}>",
                  f"      <payload>{(command.encode('ascii') + LINE_END).hex().upper()}</payload>", "    </packet>"]
    return "\n".join(lines + ["  </packets_list>", "</data>", ""])


def main(arguments):
    try:
        return do(arguments)
    except UnicodeEncodeError:
        print(f"packets.py: {arguments[1]!r}: not ASCII, which alone goes by radio", file=sys.stderr)
    except OSError as error:
        print(f"packets.py: {error.filename}: {error.strerror}", file=sys.stderr)
    return 2


def do(arguments):
    if arguments == ["--check"]:
        if FILE.read_text(encoding="utf-8") == document():
            return 0
        print(f"{FILE}: run {Path(__file__).name}", file=sys.stderr)
        return 1
    if arguments[:1] == ["--with-sums"] and len(arguments) == 2:
        Path(arguments[1]).write_text(document([with_sum(command) for command in COMMANDS]), encoding="utf-8")
        return 0
    if arguments[:1] == ["--sum"] and len(arguments) == 2:
        line = with_sum(arguments[1])
        if len(line) > LINE_MAX:
            print(f"packets.py: {line!r}: {len(line)} characters with its sum; the firmware takes no line of more than {LINE_MAX}", file=sys.stderr)
            return 2
        print(line)
        return 0
    if arguments:
        print(__doc__, file=sys.stderr)
        return 2
    FILE.write_text(document(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
