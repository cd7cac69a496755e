"""What a flight of a survey is: one situation of healthy.toml, lies.toml or battery.toml, each of its figures drawn in its range.

A situation is data. docs/campaign.md tells how one is written; the tables are read by load(). What its words mean:

  draw     {NAME: RANGE}: numbers that the other lines use, beside hover, the vehicle's hover thrust. A range is [LEAST, MOST], or {wide = [..]}: each factor as likely as the
           other; {either = [..]}: of either sign; {whole = [..]}: an integer; {one_of = [..]}: a number or a word
  set      {NAME: VALUE}: a figure of the plant, or a parameter in capitals
  place    lines of a place file; {times, draw, line, then} writes its line so often, draws anew for each, and `then` changes numbers
  at       lines "SECONDS COMMAND" of a scenario file
  fault    of the scanner's line, as `plomada fly --fault` takes them
  reference, land    of the flight; else those of its table
  may      verdicts that are right here
  alone    true: it is no part of a mix
  of, laws, any_of    of musts.toml, which tells them
  course   true: over the seed's course, its platform as high as the figure `platform` says

A text between braces in them is arithmetic: {x + length / 2}, with min, max, and i, the turn of a line that is written so often.

Two tenths of each range, HELD_OUT, are kept out: nothing may be tuned on them. They are flown for the table of a release alone.
"""
import ast
import math
import operator
import random
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import plan

HERE = Path(__file__).resolve().parent
HEALTHY, LIES, BATTERY = "healthy", "lies", "battery"
TABLES = (HEALTHY, LIES, BATTERY)
HELD_OUT = ((0.3, 0.4), (0.8, 0.9))     # of each range, as parts of its length; chosen: inside, so that a tuning sees both sides
DOWN_WITHIN_S = 60
SOURCES = ("sight", "IMU", "thrust")
BRACES = re.compile(r"\{([^{}]*)\}")
WORDS = {"says", "row", "draw", "set", "place", "at", "fault", "reference", "land", "laws", "lies", "mix", "alone", "runs", "may", "course", "of", "any_of"}


class Wrong(ValueError):
    """A table says something that has no meaning; the text says where."""


# Arithmetic

OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
FUNCTIONS = {"min": min, "max": max}


def value_of(node, known):
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return node.value
    if isinstance(node, ast.Name) and node.id in known:
        return known[node.id]
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](value_of(node.left, known), value_of(node.right, known))
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -value_of(node.operand, known)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS and not node.keywords:
        return FUNCTIONS[node.func.id](*(value_of(argument, known) for argument in node.args))
    raise Wrong(f"{ast.unparse(node)}: no number, no name that is drawn, no + - * / min max")


def calculate(text, known):
    try:
        return value_of(ast.parse(str(text).strip(), mode="eval").body, known)
    except SyntaxError:
        raise Wrong(f"{text}: no arithmetic") from None


def shown(value):
    return value if isinstance(value, str) else f"{value:.6g}"


def filled(text, known):
    """The text with each {..} calculated. A value that is a number already stays it."""
    return BRACES.sub(lambda found: shown(calculate(found[1], known)), text) if isinstance(text, str) else shown(text)


# Draws

def part(rng, held_out):
    """Where in a range, 0 to 1: in the parts that are held out, or in the others."""
    edges = sorted(edge for span in HELD_OUT for edge in span)
    spans = HELD_OUT if held_out else list(zip([0.0, *edges[1::2]], [*edges[::2], 1.0], strict=True))
    low, high = rng.choices(spans, [high - low for low, high in spans])[0]
    return rng.uniform(low, high)


def drawn(range_, rng, held_out, where):
    kind, of = next(iter(range_.items())) if isinstance(range_, dict) else ("even", range_)
    if not isinstance(of, list) or (isinstance(range_, dict) and len(range_) != 1):
        raise Wrong(f"{where}: no range: {range_}")
    if kind == "one_of":
        return rng.choice(of)
    if len(of) != 2 or not of[0] <= of[1]:
        raise Wrong(f"{where}: no range: {range_}")
    if kind == "whole":
        return rng.randint(*of)
    at = part(rng, held_out)
    if kind == "wide":
        return math.exp(math.log(of[0]) + at * (math.log(of[1]) - math.log(of[0])))
    if kind in ("even", "either"):
        return (of[0] + at * (of[1] - of[0])) * (rng.choice((-1, 1)) if kind == "either" else 1)
    raise Wrong(f"{where}: no kind of range: {kind}")


def draw_all(ranges, rng, held_out, where):
    return {name: drawn(range_, rng, held_out, f"{where}.{name}") for name, range_ in ranges.items()}


# Situations

@dataclass(frozen=True)
class Situation:
    name: str
    row: str                # of the page's table
    says: str
    words: dict             # as the table has them
    sources: tuple = ()     # those that lie
    mix: int = 0            # so many of its table's others at once, instead of its own
    runs: float = 1.0       # flights, of those that others get

    @property
    def slug(self):
        """Its name as one word of a command line."""
        return re.sub(r"\W+", "-", self.name)

    def __getattr__(self, name):
        return self.words.get(name, {"draw": {}, "set": {}, "place": [], "at": [], "fault": [], "may": [], "alone": False, "course": False, "laws": [], "any_of": []}.get(name))


@dataclass(frozen=True)
class Table:
    name: str
    base: Situation         # what each of its flights begins with
    situations: dict = field(default_factory=dict)

    def rows(self):
        """{row: [situations]}, in the order of the file."""
        found = {}
        for situation in self.situations.values():
            found.setdefault(situation.row, []).append(situation)
        return found


def situation_of(name, words, where):
    unknown = set(words) - WORDS
    if unknown:
        raise Wrong(f"{where}: no such word: {', '.join(sorted(unknown))}")
    sources = tuple(words.get("lies", ()))
    if set(sources) - set(SOURCES):
        raise Wrong(f"{where}: lies: {', '.join(sources)}: none of {', '.join(SOURCES)}")
    return Situation(name, words.get("row", name), words.get("says", ""), words, sources, words.get("mix", 0), words.get("runs", 1.0))


def read(name, text):
    """A Table. Raises Wrong."""
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong(f"{name}.toml: {error}") from None
    base = situation_of("base", found.pop("base", {}), f"{name}.toml: base")
    return Table(name, base, {key: situation_of(key, words, f"{name}.toml: {key}") for key, words in found.items()})


def load(name):
    return read(name, (HERE / f"{name}.toml").read_text(encoding="utf-8"))


# Flights

@dataclass
class Flight:
    """What `plomada fly` is given: a scenario's text, and words behind it."""
    text: str
    words: list
    sources: tuple


def written(lines, known, rng, held_out, where):
    """The lines of a place."""
    for line in lines:
        if isinstance(line, str):
            yield from filled(line, known).splitlines()
            continue
        for i in range(int(float(filled(line["times"], known)))):
            known |= {"i": i} | draw_all(line.get("draw", {}), rng, held_out, where)
            yield from filled(line["line"], known).splitlines()
            known |= {name: calculate(text, known) for name, text in line.get("then", {}).items()}


class Draft:
    """A flight while its situation, and each of a mix, adds to it."""

    def __init__(self, stream, seed, number, held_out):
        self.known, self.held_out = {}, held_out
        self.figures, typed = plan.vehicle(f"{stream} {seed}", number)
        self.figures["platform"], self.typed = 0.0, {"GRAV": typed["GRAV"]}
        self.known["hover"] = self.figures["hover_thrust"]
        self.place, self.at, self.faults, self.sources = [], [], [], []
        self.reference = self.land = None
        self.course = "no"

    def add(self, situation, rng, where):
        self.known |= draw_all(situation.draw, rng, self.held_out, where)
        self.reference = situation.reference or self.reference
        self.land = situation.land or self.land
        self.course = "yes" if situation.course else self.course
        for name, value in situation.set.items():
            (self.typed if name.isupper() else self.figures)[name] = filled(value, self.known)
        self.place += written(situation.place, self.known, rng, self.held_out, where)
        self.at += [filled(line, self.known) for line in situation.at]
        self.faults += [filled(spec, self.known) for spec in situation.fault]
        self.sources += situation.sources

    def text(self, name, law):
        lines = [f"like {law.scenario}", f"name {name}", f"platform {self.course}"]
        lines += [f"set {key} {value}" for key, value in {**law.settings, **self.typed}.items()]
        lines += [f"set plant.{key} {shown(value)}" for key, value in self.figures.items()]
        lines += [f"place {line}" for line in self.place]
        lines += [f"at {line}" for line in sorted(self.at, key=lambda line: float(line.split()[0]))]
        land_s = round(calculate(BRACES.sub(r"(\1)", str(self.land)), self.known), 2)
        reference_m = round(calculate(BRACES.sub(r"(\1)", str(self.reference)), self.known), 3)
        return "\n".join([*lines, f"reference {reference_m:g}", f"land {land_s:g}", f"end {land_s + 10:g}", ""])


def mixed(table, count, rng):
    """So many situations that lie, each of another row: two of one row would be one, since the later sets what the earlier has set."""
    rows = [lying for of_row in table.rows().values() if (lying := [one for one in of_row if one.sources and not one.alone])]
    return [rng.choice(of_row) for of_row in rng.sample(rows, count)]


def flight(table, situation, law, seed, number, held_out=False):
    """The flight of this number; the same for every law but for what the law types. Numbers count from 1."""
    where = f"{table.name}.toml: {situation.name}"
    rng = random.Random(f"{table.name} {situation.name} {seed}/{number}{' held out' * held_out}")
    draft = Draft(f"{table.name} {situation.name}", seed, number, held_out)
    draft.add(table.base, rng, where)
    for one in mixed(table, situation.mix, rng) if situation.mix else [situation]:
        draft.add(one, rng, where)
    words = ["--seed", str((seed - 1) * plan.RUNS_PER_SEED + number), "--until-down", str(DOWN_WITHIN_S)]
    words += [word for spec in draft.faults for word in ("--fault", spec)]
    return Flight(draft.text(f"{situation.slug}-{number}", law), words, tuple(dict.fromkeys(draft.sources)))
