"""A URG-04LX from Hokuyo's pages alone (C-42-03320B "SCIP2.0", the data sheet) and from the latencies of recorded sensors.

It shares nothing with sim/ and tests/faults/: whoever compares them compares two readings of the specification. All times are
microseconds of a clock that the caller keeps; nothing here waits.

As a program: hokuyo.py --link PATH [--rate N] [--first-reply-ms N] [--boot-ms N] [--burst] serves it on a pseudo-terminal, by the wall
clock. SIGUSR1 takes its power away, SIGUSR2 gives it back. At its end it says how long the machine withheld its time.
"""
import argparse
import bisect
import fcntl
import os
import random
import select
import signal
import struct
import sys
import termios
import time
import tty

RATES = (19200, 57600, 115200, 250000, 500000, 750000)
REVOLUTION_US = 100_000     # data sheet: 600 rpm
STEPS = 1024                # PP: ARES
LAST_STEP = 768
LINE_MAX = 80               # chosen: the longest command is MD with a string, 32 characters
STRING_MAX = 16             # SCIP2.0, "String Characters"
FARTHEST_BY_2 = 4095        # two characters of six bits
FAST_US = (300, 900)        # TM1 was recorded after 0.95 ms: it is not answered at a revolution

IDENTITY = {
    "VV": ("VEND:Hokuyo Automatic Co.,Ltd.", "PROD:SOKUIKI Sensor URG-04LX", "FIRM:3.2.00(28/Aug./2007)", "PROT:SCIP 2.0", "SERI:H0508486"),
    "PP": ("MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)", "DMIN:20", "DMAX:5600", "ARES:1024", "AMIN:44", "AMAX:725", "AFRT:384", "SCAN:600"),
}


def with_sum(text):
    """SCIP2.0, "Sum": the lower six bits of the sum of what the line holds, plus 30H."""
    return text + chr((sum(map(ord, text)) & 0x3F) + 0x30)


def encoded(value, characters):
    return "".join(chr(((value >> 6 * place) & 0x3F) + 0x30) for place in reversed(range(characters)))


def distance_mm(step):
    """Its room: each step another distance, so that a shifted scan is seen."""
    return 1000 + step


class Line:
    """One direction of an RS232 line, as levels in time: who listens at another rate than it is driven hears what a UART would."""

    def __init__(self, rate):
        self.rate = rate        # of the receiver
        self.edges = []         # where the level changes; it is high before the first, low behind it, and so on
        self.driven_to = 0.0
        self.heard_to = 0.0

    def drive(self, octet, at_us, rate):
        """One octet at `rate`, not before at_us. The end of its stop bit."""
        begin, bit_us = max(at_us, self.driven_to), 1e6 / rate
        levels = [0] + [(octet >> place) & 1 for place in range(8)] + [1]
        level = 1
        for place, new in enumerate(levels):
            if new != level:
                self.edges.append(begin + place * bit_us)
                level = new
        self.driven_to = begin + 10 * bit_us
        return self.driven_to

    def cut(self, at_us):
        """The sender has lost its power: the line is high from now on."""
        del self.edges[bisect.bisect_right(self.edges, at_us):]
        if len(self.edges) % 2 == 1:
            self.edges.append(at_us)
        self.driven_to = at_us

    def high(self, at_us):
        return bisect.bisect_right(self.edges, at_us) % 2 == 0

    def next_us(self):
        """When hear() gives something again, if nobody drives the line meanwhile; None."""
        at = bisect.bisect_left(self.edges, self.heard_to)
        at += at % 2
        return self.edges[at] + 9.5e6 / self.rate if at < len(self.edges) else None

    def hear(self, now_us):
        """(time, octet, framing error) of each octet whose stop bit has been sampled by now."""
        while True:
            at = bisect.bisect_left(self.edges, self.heard_to)
            while at < len(self.edges) and at % 2 == 1:     # only a fall begins an octet
                at += 1
            bit_us = 1e6 / self.rate
            if at == len(self.edges) or self.edges[at] + 9.5 * bit_us > now_us:
                break
            fall = self.edges[at]
            self.heard_to = fall + 9.5 * bit_us
            if self.high(fall + bit_us / 2):
                self.heard_to = fall + bit_us / 2           # too short for a start bit
                continue
            octet = sum(self.high(fall + (1.5 + place) * bit_us) << place for place in range(8))
            broken = not self.high(self.heard_to)
            if broken:
                rise = bisect.bisect_right(self.edges, self.heard_to)
                self.heard_to = self.edges[rise] if rise < len(self.edges) else now_us
            yield self.heard_to, octet, broken
        past = bisect.bisect_left(self.edges, min(self.heard_to, now_us) - 20_000) // 2 * 2
        del self.edges[:past]


class Stream:
    def __init__(self, order, characters, first, last, cluster, interval, count):
        self.order, self.characters, self.steps = order, characters, range(first, last + 1, cluster)
        self.last, self.interval, self.count = last, interval, count
        self.left = count

    def data(self):
        """A cluster has its nearest distance."""
        text = "".join(encoded(min(distance_mm(step), FARTHEST_BY_2 if self.characters == 2 else 1 << 18), self.characters)
                       for step in self.steps)
        return [with_sum(text[at:at + 64]) for at in range(0, len(text), 64)]


class Urg:
    """One sensor, its power off at first. reply_us: least and most time to an answer; first_reply_us: to the first one after
    power-up; at_revolutions: an answer comes with the next revolution in place of that; hears_us: it hears what comes so long before
    the end of its boot, and answers it then."""

    def __init__(self, power_up_rate=19200, boot_us=2_000_000, reply_us=(90_000, 115_000), first_reply_us=381_000, at_revolutions=False,
                 hears_us=0, turn_us=REVOLUTION_US, seed=1):
        self.power_up_rate, self.boot_us, self.turn_us = power_up_rate, boot_us, turn_us
        self.reply_us, self.first_reply_us, self.at_revolutions = reply_us, first_reply_us, at_revolutions
        self.hears_us = hears_us
        self.dice = random.Random(seed)
        self.to_sensor, self.to_host = Line(power_up_rate), Line(power_up_rate)
        self.ready_us = None        # end of its boot; None: no power
        self.commands = 0
        self.clear(0)

    def clear(self, now_us):
        self.rate = self.to_sensor.rate = self.power_up_rate
        self.line, self.queue, self.answered, self.next_us = "", [], None, None
        self.next_rate = None
        self.scip2 = self.time_mode = False
        self.laser = True           # SCIP1.1 measures from the start
        self.stream, self.frame_us = None, 0
        self.turned_us = now_us
        self.replies = 0
        self.sends_to = now_us

    # ---- power ----

    def power(self, on, now_us):
        self.clear(now_us)
        self.to_host.cut(now_us)
        self.ready_us = now_us + self.boot_us if on else None
        self.turned_us = now_us + self.dice.randrange(self.turn_us)

    def wake_in_scip2(self, now_us, rate):
        """As another program has left it."""
        self.power(True, now_us)
        self.ready_us, self.scip2, self.laser, self.replies = now_us, True, False, 1
        self.rate = self.to_sensor.rate = rate

    def is_ready(self, now_us):
        return self.ready_us is not None and now_us >= self.ready_us

    def hears(self, at_us):
        return self.ready_us is not None and at_us >= self.ready_us - self.hears_us

    # ---- what it hears ----

    def run(self, now_us):
        """Up to this time. Call it each millisecond or more often."""
        for at_us, octet, _ in list(self.to_sensor.hear(now_us)):
            if self.hears(at_us):
                self.hear(octet, at_us)
        if self.next_rate is not None and now_us >= self.sends_to:
            self.rate = self.to_sensor.rate = self.next_rate
            self.next_rate = None
        if self.is_ready(now_us):
            self.answer(now_us)
            self.measure(now_us)

    def quiet_until_us(self):
        """When run() does something again, if nothing comes meanwhile; None."""
        due = [self.to_sensor.next_us()]
        if self.next_rate is not None:
            due.append(self.sends_to)
        if self.queue:
            due.append(max(self.next_us or 0, self.sends_to, self.ready_us))
        if self.stream is not None:
            due.append(max(self.frame_us + self.measured_us(), self.ready_us))
        return min((at_us for at_us in due if at_us is not None), default=None)

    def hear(self, octet, at_us):
        if octet in (0x0A, 0x0D):
            if self.line:
                again = bool(self.queue) and self.queue[-1][0] == self.line
                self.queue.append((self.line, at_us, again))
            self.line = ""
        elif len(self.line) < LINE_MAX:
            self.line += chr(octet)

    # ---- what it says ----

    def say(self, lines, at_us):
        """The end of it on the line."""
        for octet in ("\n".join(lines) + "\n\n").encode("latin-1"):
            self.sends_to = self.to_host.drive(octet, max(at_us, self.sends_to), self.rate)
        return self.sends_to

    def due_us(self, command, at_us):
        """When the answer to this command begins: one after the other, and the slow first one."""
        asked_us = max(at_us, self.answered or 0)
        if command == "TM1":
            return asked_us + self.dice.randint(*FAST_US)
        if self.replies == 0:
            return max(asked_us + self.first_reply_us, self.ready_us)
        if self.at_revolutions:
            turns = (asked_us - self.turned_us) // self.turn_us + 1
            return self.turned_us + turns * self.turn_us
        return asked_us + self.dice.randint(*self.reply_us)

    def answer(self, now_us):
        while self.queue:
            command, at_us, again = self.queue[0]
            if self.next_us is None:
                self.next_us = self.due_us(command, at_us)
            if self.next_us > now_us or self.sends_to > now_us:
                return
            self.queue.pop(0)
            self.next_us = None
            self.commands += 1
            self.replies += 1
            self.answered = now_us
            if self.scip2 and again:
                self.refuse(command, now_us, "0B")      # "command repeated"
            else:
                (self.answer_scip2 if self.scip2 else self.answer_scip1)(command, now_us)

    def answer_scip1(self, command, now_us):
        if command == "SCIP2.0":
            self.say([command, "0"], now_us)
            self.scip2, self.laser = True, False
        elif command in ("L0", "L1"):
            self.say([command, "2" if command == "L1" and self.laser else "0"], now_us)
            self.laser = command == "L1"
        elif command == "V":
            self.say([command, "0", *IDENTITY["VV"]], now_us)
        elif command[:1] == "S" and command[1:7].isdigit() and len(command) == 14:
            self.say([command, "0" if int(command[1:7]) in RATES else "E"], now_us)
            self.follow(int(command[1:7]))
        else:
            self.say([command, "E"], now_us)

    def follow(self, rate):
        """The answer leaves at the old rate (SCIP2.0, "SS")."""
        if rate in RATES:
            self.next_rate = rate

    def refuse(self, command, now_us, status):
        self.say([command, with_sum(status)], now_us)

    def answer_scip2(self, command, now_us):
        symbol, _, string = command.partition(";")
        name, parameters = symbol[:2], symbol[2:]
        widths = {"BM": 0, "QT": 0, "RS": 0, "VV": 0, "PP": 0, "II": 0, "TM": 1, "SS": 6, "CR": 2, "HS": 1, "DB": 2, "GD": 10, "GS": 10, "MD": 13,
                  "MS": 13}
        if name not in widths or (self.time_mode and name != "TM"):
            self.refuse(command, now_us, "0E")
        elif len(parameters) != widths[name]:
            self.refuse(command, now_us, "0C" if len(parameters) < widths[name] else "0D")
        elif len(string) > STRING_MAX:
            self.refuse(command, now_us, "0G")
        else:
            getattr(self, "on_" + name)(command, parameters, now_us)

    def on_BM(self, command, _, now_us):
        self.refuse(command, now_us, "02" if self.laser else "00")
        self.laser = True

    def on_QT(self, command, _, now_us):
        self.refuse(command, now_us, "00")
        self.stream, self.laser = None, False

    def on_RS(self, command, _, now_us):
        self.refuse(command, now_us, "00")
        self.stream, self.laser, self.time_mode = None, False, False
        self.ready_us = now_us - 1      # its clock begins again
        self.follow(self.power_up_rate)

    def on_TM(self, command, parameter, now_us):
        clock = [with_sum(encoded(self.clock_ms(now_us), 4))] if parameter == "1" else []
        good = {"0": not self.time_mode, "1": self.time_mode, "2": self.time_mode}
        refused = {"0": "02", "1": "04", "2": "03"}
        if parameter not in good:
            self.refuse(command, now_us, "01")
        elif not good[parameter]:
            self.refuse(command, now_us, refused[parameter])
        else:
            self.say([command, with_sum("00"), *clock], now_us)
            self.time_mode = parameter != "2"
            self.stream, self.laser = None, False

    def on_SS(self, command, parameter, now_us):
        rate = int(parameter) if parameter.isdigit() else 0
        status = "01" if not parameter.isdigit() else "02" if rate not in RATES else "03" if rate == self.rate else "00"
        self.refuse(command, now_us, status)
        if status == "00":
            self.follow(rate)

    def on_CR(self, command, parameter, now_us):
        self.refuse(command, now_us, "01" if not parameter.isdigit() else "03" if parameter == "00" else "00" if int(parameter) <= 10 else "02")

    def on_HS(self, command, parameter, now_us):
        self.refuse(command, now_us, {"0": "02", "1": "00"}.get(parameter, "01"))

    def on_DB(self, command, _, now_us):
        self.refuse(command, now_us, "0E")      # firmware 3.3 and later

    def told(self, command, lines, now_us):
        self.say([command, with_sum("00"), *(f"{line};{with_sum(line)[-1]}" for line in lines)], now_us)

    def on_VV(self, command, _, now_us):
        self.told(command, IDENTITY["VV"], now_us)

    def on_PP(self, command, _, now_us):
        self.told(command, IDENTITY["PP"], now_us)

    def on_II(self, command, _, now_us):
        self.told(command, ("MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)", f"LASR:{'ON' if self.laser else 'OFF'}",
                            "SCSP:Initial(600[rpm])<-Default setting by user", "MESM:IDLE" if self.stream is None else "MESM:CLASSIC",
                            f"SBPS:{self.rate}[bps]<-Default setting by user", f"TIME:{self.clock_ms(now_us):06X}", "STAT:Sensor works well."),
                  now_us)

    @staticmethod
    def range_of(parameters):
        """(status, first, last, cluster)"""
        fields = parameters[:4], parameters[4:8], parameters[8:10]
        for place, field in enumerate(fields):
            if not field.isdigit():
                return f"0{place + 1}", 0, 0, 1
        first, last, cluster = map(int, fields)
        status = "04" if last > LAST_STEP else "05" if last < first else "00"
        return status, first, last, max(cluster, 1)

    def get(self, command, parameters, now_us, characters):
        status, first, last, cluster = self.range_of(parameters)
        if status != "00" or not self.laser:
            self.refuse(command, now_us, status if status != "00" else "10")
            return
        scan = Stream(command, characters, first, last, cluster, 0, 1)
        self.say([command, with_sum("00"), with_sum(encoded(self.clock_ms(now_us), 4)), *scan.data()], now_us)

    def on_GD(self, command, parameters, now_us):
        self.get(command, parameters, now_us, 3)

    def on_GS(self, command, parameters, now_us):
        self.get(command, parameters, now_us, 2)

    def order(self, command, parameters, now_us, characters):
        status, first, last, cluster = self.range_of(parameters)
        interval, count = parameters[10:11], parameters[11:13]
        if status == "00":
            status = "06" if not interval.isdigit() else "07" if not count.isdigit() else "00"
        self.refuse(command, now_us, status)
        if status != "00":
            return
        self.stream, self.laser = Stream(command, characters, first, last, cluster, int(interval), int(count)), True
        turns = (self.sends_to - self.turned_us) // self.turn_us + 1
        self.frame_us = self.turned_us + turns * self.turn_us     # the first revolution that begins behind the answer

    def on_MD(self, command, parameters, now_us):
        self.order(command, parameters, now_us, 3)

    def on_MS(self, command, parameters, now_us):
        self.order(command, parameters, now_us, 2)

    # ---- scans ----

    def clock_ms(self, now_us):
        return int(now_us - self.ready_us) // 1000 % (1 << 24)

    def measure(self, now_us):
        """A scan leaves when its last step was measured and the line is free; else its revolution is left out."""
        while self.stream is not None and self.frame_us + self.measured_us() <= now_us:
            begun_us, stream = self.frame_us, self.stream
            self.frame_us += self.turn_us
            if self.sends_to > now_us:
                continue
            self.frame_us += stream.interval * self.turn_us
            stream.left -= stream.count > 0
            echo = f"{stream.order[:13]}{stream.left:02}{stream.order[15:]}"
            self.say([echo, with_sum("99"), with_sum(encoded(self.clock_ms(begun_us), 4)), *stream.data()], now_us)
            if stream.count > 0 and stream.left == 0:
                self.stream, self.laser = None, False

    def measured_us(self):
        return self.stream.last * self.turn_us // STEPS


# ---- on a pseudo-terminal ----

TCGETS2 = 0x802C542A    # <asm/ioctls.h>; termios.tcgetattr knows rates with a name alone
BEHIND_MAX_US = 20_000
PACKET, PAUSE_US = 64, 2000     # of a full-speed USB device; chosen: longer than between two octets


class Terminal:
    """burst: octets leave in packets, as from the sensor's own USB plug."""

    def __init__(self, urg, burst=False):
        self.urg, self.burst, self.packet = urg, burst, b""
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.begun, self.now_us, self.lost_us = time.monotonic(), 0, 0

    def name(self):
        return os.ttyname(self.slave)

    def host_rate(self):
        return struct.unpack("4I20B2I", fcntl.ioctl(self.master, TCGETS2, bytes(44)))[-1]

    def step(self):
        """Up to the present. What the machine withheld from this process is counted in lost_us."""
        select.select([self.master], [], [], 0.001)
        now_us = int((time.monotonic() - self.begun) * 1e6)
        self.lost_us += max(0, now_us - self.now_us - BEHIND_MAX_US)
        rate = self.host_rate()
        self.urg.to_host.rate = rate
        try:
            for octet in os.read(self.master, 256):
                self.urg.to_sensor.drive(octet, self.now_us, rate)
        except BlockingIOError:
            pass
        while self.now_us < now_us:
            self.now_us = min(self.now_us + 1000, now_us)
            self.urg.run(self.now_us)
            self.packet += bytes(octet for _, octet, _ in self.urg.to_host.hear(self.now_us))
            self.hand_over()

    def hand_over(self):
        pauses = not self.burst or self.now_us - self.urg.sends_to >= PAUSE_US
        ready = len(self.packet) if pauses else len(self.packet) // PACKET * PACKET
        if ready:
            os.write(self.master, self.packet[:ready])
            self.packet = self.packet[ready:]


def main():
    parser = argparse.ArgumentParser(description="A URG-04LX on a pseudo-terminal.")
    parser.add_argument("--link", required=True)
    parser.add_argument("--rate", type=int, choices=RATES, default=19200)
    parser.add_argument("--boot-ms", type=int, default=2000)
    parser.add_argument("--first-reply-ms", type=int, default=381)
    parser.add_argument("--burst", action="store_true", help="octets leave in packets, as from the sensor's own USB plug")
    words = parser.parse_args()
    terminal = Terminal(Urg(words.rate, 1000 * words.boot_ms, first_reply_us=1000 * words.first_reply_ms), words.burst)
    signal.signal(signal.SIGUSR1, lambda *_: terminal.urg.power(False, terminal.now_us))
    signal.signal(signal.SIGUSR2, lambda *_: terminal.urg.power(True, terminal.now_us))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    terminal.urg.power(True, 0)
    os.symlink(terminal.name(), words.link)
    print(terminal.name(), flush=True)
    try:
        while True:
            terminal.step()
    finally:
        os.unlink(words.link)
        print(f"behind {terminal.lost_us // 1000} ms", flush=True)


if __name__ == "__main__":
    main()
