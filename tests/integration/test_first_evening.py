"""docs/first_evening.md, typed as it stands at a person's pace, with each "You see" looked for.

Usage: test_first_evening.py ROOT OPERATOR_BOARD PLOMADA [Slow]    Slow: by somebody who takes twice the time

From the page come the lines to type, what is to be seen, and their order. What hands and the pilot do meanwhile is told by the page's
own words (DONE): a phrase that the page has lost, or a sentence that this test does not understand, fails.
"""
import re
import sys
import unittest
from pathlib import Path

from operator_board import PAUSE_S, OperatorBoard

HOVER_N = 7.4       # of the simulated vehicle: there its ropes go tight

# The page's words, and what they mean to the simulated world. The first that matches at a place counts.
DONE = {
    r"`build/plomada fly hover-60s": ["on running", "wait 25"],
    r"5 V to the LD33V": ["on", "laser off", "imu off", "wait 5"],
    r"MAX3222 to J5\.47 and J6\.54": ["laser on", "wait 40"],
    r"[Ll]ift it onto a stand of 0\.5 m": ["hold 0.5 0 0", "wait 15"],
    r"[Cc]over the mirror": ["mirror covered", "wait 15"],
    r"Uncover the mirror": ["mirror free", "wait 15"],
    r"pull the scanner's plug": ["laser off", "wait 15"],
    r"Put the plug\s+back": ["laser on", "wait 30"],
    r"then power on": ["on", "wait 30"],
    r"Raise\s+the right side by 20°": ["hold 0.1 20 0", "wait 15"],
    r"Raise the nose by 20°": ["hold 0.1 0 20", "wait 15"],
    r"Put it down": ["hold 0 0 0", "wait 15"],
    r"start the motors": ["wait 10", "corners on", "wait 1", "corners off", "stick 0.2", "wait 2"],
    r"[Ss]witch to \*LaunchPad\*": ["switch launchpad", "wait 10"],
    r"[Ss]witch to \*pilot\*": ["switch pilot", "wait 10"],
    r"stick to a little over\s+half": ["stick 0.55", "wait 2"],
    r"Stick down": ["stick 0", "wait 5"],
    r"Propellers on\. The pilot hovers": ["hold 0.8 0 0", "wait 20", "hold 0 0 0", "wait 15"],
    r"Ropes with 20 cm of slack again": ["stick 0", "free"],
    r"Longer ropes": ["stick 0"],
    r"Half a minute later": ["wait 15"],
    r"Ten seconds later": [],
}
# (step, what it says, what is not so)
LIES = ((9, "`OK PING 1`", "`OK PING 2`"), (13, "from 0.48 to 0.52", "from 0.53 to 0.57"),
        (17, "`#IMU NOSE`", "`#IMU TAIL`"), (21, "`state:TAKEOFF`", "`state:FLYING`"),
        (22, "**Type** `#ARM`. **You see** `thr:1.76`. Pilot", "Pilot"),
        (28, "`#LINK 60`. **You see** `OK LINK 60`", "`#LINK 2`. **You see** `OK LINK 2`"),
        (30, "**Type** `#ARM`. **You see** `OK ARM idle:15%`. Pilot: start the motors, switch to *LaunchPad*. "
             "**Type** `#SETR 0.3`", "**Type** `#SETR 0.3`"),
        (33, "**type** `#PING 1`", "**type** `#STOP`. **You see** `state:FLYING`"))
SENTENCE = re.compile(r"\*\*(Type|You see)\*\*((?:`[^`]*`|[^`])*?(?:\.(?=\s|$)|(?=\n\n)|$))", re.IGNORECASE)
SPAN = re.compile(r"`([^`]+)`")
RANGE = re.compile(r"`(\w+)` from\s+(-?[\d.]+) to (-?[\d.]*\d)")
SEEN = re.compile(r"(OK|ERR) |\w+:\S")


def steps(page):
    """(number, text) of each numbered step, its line breaks kept."""
    for found in re.finditer(r"^(\d+)\. ((?:.*\n)(?:(?: .*)?\n)*)", page.split("\n## When it goes otherwise")[0], re.MULTILINE):
        yield int(found.group(1)), found.group(2)


def parts(text):
    """What is done, typed and seen in a step, in its order: (kind, text)."""
    at = 0
    while at < len(text):
        sentence = SENTENCE.match(text, at)
        if sentence:
            yield sentence.group(1).lower(), sentence.group(2)
            at = sentence.end()
            continue
        for phrase in DONE:
            done = re.compile(phrase).match(text, at)
            if done:
                yield "do", phrase
                at = done.end()
                break
        else:
            at += 1


def pattern(seen):
    """`…` is any text, a line break a blank."""
    return ".*".join(re.escape(piece) for piece in re.split("…", re.sub(r"\s+", " ", seen)))


class Typist(unittest.TestCase):
    maxDiff = None

    def fail_at(self, what):
        self.fail(f"step {self.step}: {what}\n" + "\n".join(self.board.heard[-10:]))

    def look_for(self, seen):
        want = pattern(seen)
        if seen.startswith("alt:"):
            found = any(re.match(want, line) for line in self.board.telemetry())
        elif re.match(r"(OK|ERR) ", seen):
            found = any(re.fullmatch(want + r"( \(.*\))?", line) for line in self.board.answers())
        else:       # a field: of the latest telemetry, or of an answer
            lines = self.board.telemetry()[-1:] + self.board.answers()
            found = any(re.search(rf"(^| ){want}( |$)", line) for line in lines)
        if not found:
            self.fail_at(f"not seen: {seen}")

    def look(self, text):
        for name, least, most in RANGE.findall(text):
            for line in self.board.telemetry()[-25:]:       # five seconds
                value = re.search(rf"{name}:(\S+)", line).group(1)
                if value == "-" or not float(least) <= float(value) <= float(most):
                    self.fail_at(f"not within {least} to {most}: {line}")
        for seen in SPAN.findall(text):
            if SEEN.match(seen):
                self.look_for(seen)
        if re.search(r"motors (go on|stop)", text):
            if self.board.truth()[2] != ("motors stop" not in text):
                self.fail_at("the motors do not: " + text.strip())

    def advise(self, line):
        """The number that the firmware has just told, in place of the page's."""
        told = re.search(r" grav:([\d.]+)", "\n".join(self.board.all[::-1]))
        return f"#GRAV {told.group(1)}" if line.startswith("#GRAV") else line

    def type(self, text):
        lines = [line for line in SPAN.findall(text) if line.startswith("#")]
        self.assertTrue(lines, f"step {self.step}: nothing to type: {text}")
        self.typed += lines
        self.board.clear()
        if "until the ropes go tight" in text:
            self.type_until_tight(lines[0])
            return
        for line in lines:
            self.board.type(self.advise(line))
            if re.match(r"#(LOG|GET|HELP)", line):
                self.await_end(line)
        if not re.search(r"`ERR", self.text):
            errors = [answer for answer in self.board.answers() if answer.startswith("ERR")]
            if errors:
                self.fail_at(f"refused: {errors[0]}")

    def await_end(self, line):
        """Three minutes at most."""
        for _ in range(int(180 / PAUSE_S) - 1):
            if any(re.match(rf"OK {line[1:4]}\w* END", answer) for answer in self.board.answers()):
                return
            self.board.wait(PAUSE_S)

    def type_until_tight(self, line):
        """Somebody who watches the ropes."""
        for second in range(300):
            if second % 30 == 0:
                self.board.order(f"type {line}")
            self.board.wait(1)
            if self.board.truth()[1] >= HOVER_N:
                self.board.wait(2)
                return
        self.fail_at("the ropes never went tight")

    def act(self, phrase):
        self.board.clear()
        self.done.add(phrase)
        for order in DONE[phrase]:
            self.board.order(order)

    def walk(self, text):
        self.text = text
        for kind, part in parts(text):
            {"do": self.act, "type": self.type, "you see": self.look}[kind](part)

    def found_out(self, text, says, instead):
        """The step, where its page lies: it must not get through."""
        line = re.sub(r"\n {3,}", " ", text)
        self.assertIn(says, line)
        typed, done = [*self.typed], {*self.done}
        with self.subTest(step=self.step), self.board.tried(), self.assertRaisesRegex(AssertionError, rf"^step {self.step}: "):
            self.walk(line.replace(says, instead))
        self.typed, self.done = typed, done

    def spend(self, pause_s=PAUSE_S, seed=1, lies=()):
        self.typed, self.done = [], set()
        with OperatorBoard(BOARD, pause_s, seed) as self.board:
            for self.step, text in steps(PAGE.read_text(encoding="utf-8")):
                for _, says, instead in (lie for lie in lies if lie[0] == self.step):
                    self.found_out(text, says, instead)
                self.walk(text)


class Slow(Typist):
    def test_who_takes_twice_the_time_gets_through_it_too(self):
        self.spend(2 * PAUSE_S)


class Evening(Typist):
    def test_every_line_of_the_page_does_what_the_page_says_and_a_page_that_lies_is_found_out(self):
        self.spend(lies=LIES)
        self.assertEqual(self.step, 33, "steps are lost")
        self.assertEqual(set(DONE) - self.done, set(), "the page does not say this any more")
        self.assertGreaterEqual(len(self.typed), 37)

    def test_nothing_to_type_stands_outside_of_a_sentence_that_says_type(self):
        for number, text in steps(PAGE.read_text(encoding="utf-8")):
            rest = SENTENCE.sub("", text)
            stray = [span for span in SPAN.findall(rest) if re.match(r"#[A-Z]", span)]
            mentioned = {"#ARM", "#PING 1", "#STOP"}    # told of
            self.assertEqual(set(stray) - mentioned, set(), f"step {number}")


if __name__ == "__main__":
    ROOT, BOARD = Path(sys.argv[1]), sys.argv[2]
    PAGE = ROOT / "docs/first_evening.md"
    unittest.main(argv=sys.argv[:1], defaultTest=sys.argv[4:] or "Evening")
