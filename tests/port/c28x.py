"""What a C28x and SYS/BIOS refuse, or do otherwise than a PC, and a text can show. docs/portability.md has the reasons."""
import functools
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "rules"))
import house  # noqa: E402

NAME = r"[A-Za-z_]\w*"
COUNT_OF = re.compile(r"sizeof\s+(\w+)\s*/\s*sizeof\s+\1\[0\]")
SHIFT = re.compile(r"<<(?!=)\s*(\w+)?")
POINTER_CAST = re.compile(r"\(\s*(?:const\s+|volatile\s+)*(\w+)(?:\s+const)?\s*\*+\s*(?:const\s*)?\)\s*[&\w(]")
UNION = re.compile(r"\bunion\b[^{;]*\{([^}]*)\}")
CALL = re.compile(r"\b(Semaphore_pend|Event_pend|Task_sleep|Clock_create)\s*\(")
DEFINE = re.compile(r"^#define\s+(\w+)\s+\(?(\d+|0x[\dA-Fa-f]+)[UL]*\)?\s*?(?:/\*.*)?$", re.MULTILINE)
FUNCTION = re.compile(rf"^(?:static\s+)?(?:inline\s+)?[\w *]+?\b({NAME})\(([^;{{)]*(?:\([^)]*\)[^;{{)]*)*)\)\s*\{{", re.MULTILINE)
FOREIGN = re.compile(r"\b(Interrupt_\w+|__interrupt|interrupt|cregister|__cregister|near|far|PIEACK|IER|IFR|EINT|DINT)\b")
FOREVER = 65535


def code(the_house, path):
    return house.code_only(the_house.text(path))


def each(the_house, rooms, *suffixes):
    for room in rooms:
        for path in the_house.sources(room, *(suffixes or (".c", ".h"))):
            yield path, code(the_house, path)


def at(path, text, offset, what):
    return f"{path}:{house.line_of(text, offset)}: {what}"


def sizes(the_house):
    """sizeof counts cells of 16 bits: of wire data it says nothing, so only elements are counted with it; what the firmware
    copies whole may be measured for the copy, and memcmp() and memset() count in cells too."""
    for path, text in each(the_house, house.PRODUCT):
        bare = COUNT_OF.sub(house.blank, text)
        for match in re.finditer(r"\bsizeof\b", bare):
            statement = bare[bare.rfind(";", 0, match.start()) + 1:match.start()]
            measured = r"\bmem(?:cpy|set|move|cmp)\(" if path.startswith("firmware/") else r"\bmem(?:cmp|set)\("
            if not re.search(measured, statement):
                yield at(path, text, match.start(), "sizeof counts cells, not octets")


@functools.cache
def headers(the_house, room):
    return "".join(code(the_house, header) for header in the_house.sources(room, ".h"))


# Of a room's headers, which each of its files sees.
@functools.cache
def found_in_headers(the_house, room, pattern):
    return tuple(re.findall(pattern, headers(the_house, room)))


def visible(the_house, path, text, pattern):
    """What a pattern finds in the file and in the headers of its room."""
    return *re.findall(pattern, text), *found_in_headers(the_house, path.split("/")[0], pattern)


def widths(the_house, path, text):
    """{name: bits} of the unsigned variables and members that the file can see."""
    found = {}
    for bits, names in visible(the_house, path, text, r"\buint(16|32|64)_t\s+([^;(){}]*)[;,)=]"):
        for name in re.findall(rf"(?:^|,)\s*\**\s*(?:const\s+)?({NAME})", names):
            found[name] = max(int(bits), found.get(name, 0))
    return found


def operand_before(text, end):
    """What stands directly left of an operator: a parenthesis with its cast, or a chain of names, or a number."""
    begin = len(text[:end].rstrip())
    if text[begin - 1] == ")":
        depth = 0
        while True:
            begin -= 1
            depth += {")": 1, "(": -1}.get(text[begin], 0)
            if depth == 0:
                break
        before = re.search(r"\(uint\d+_t\)\s*$", text[:begin])
        return text[before.start() if before else begin:end].strip()
    line = text[max(text.rfind(mark, 0, begin) for mark in "\n;{") + 1:begin]
    found = re.search(rf"(?:\(uint\d+_t\)\s*)?(?:{NAME}(?:(?:->|\.){NAME}|\[[^\[\]]*\])*|\b(?:0x)?\d\w*)$", line)
    return found.group() if found else ""


def shifts(the_house):
    """int has 16 bits: what is shifted left is unsigned, and has 32 bits when 16 places or more are meant."""
    for path, text in each(the_house, house.PRODUCT):
        known = widths(the_house, path, text)
        for match in SHIFT.finditer(text):
            left = operand_before(text, match.start())
            places = int(match.group(1).rstrip("UL")) if re.fullmatch(r"\d+U?L?", match.group(1) or "") else 0
            cast = re.match(r"\(uint(\d+)_t\)", left)
            inner = re.match(r"\(\(uint(\d+)_t\)", left)
            if cast or inner:
                bits = int((cast or inner).group(1))
            elif re.fullmatch(r"(?:0x)?[\dA-Fa-f]+UL?", left):
                bits = 32 if left.endswith("L") else 16
            else:
                bits = known.get(re.split(r"->|\.", left.split("[")[0])[-1], 0)
            if bits <= places:
                yield at(path, text, match.start(), f"{left or '?'} << {match.group(1)}: is that unsigned and wide enough?")


def overlays(the_house):
    """No view of octets as something else: no pointer is cast, and a union holds 32-bit members only."""
    for path, text in each(the_house, ("control", "drivers", "firmware")):
        for match in POINTER_CAST.finditer(text):
            if match.group(1) not in ("void", "Void"):
                yield at(path, text, match.start(), "a pointer made to point to something else")
        for match in UNION.finditer(text):
            for kind in re.findall(r"(\w+)\s+\w+(?:\[[^\]]*\])?;", match.group(1)):
                if kind not in ("float", "uint32_t", "int32_t"):
                    yield at(path, text, match.start(), f"a union with {kind}: members of 32 bits only")


def formats(the_house):
    """No conversion in a string of the product: what %d takes is 16 bits wide there."""
    for room in house.PRODUCT:
        for path in the_house.sources(room, ".c", ".h"):
            text = house.without_comments(the_house.text(path))
            for match in re.finditer(r"\"[^\"\n]*%[-+ #0-9.*]*[hl]*[diouxXfegcsp][^\"\n]*\"", text):
                yield at(path, text, match.start(), "a printf conversion")


def characters(the_house):
    """char has 16 bits and wraps nowhere near 256: it is neither counted with nor used as an index."""
    for path, text in each(the_house, house.PRODUCT):
        for name in set(re.findall(rf"\bchar\s+({NAME})\s*[;,=)]", text)):
            for match in re.finditer(rf"(?:\+\+|--)\s*{name}\b|(?<![.>\w]){name}\s*(?:\+\+|--|[-+*/%&|^]=|<<=|>>=)|\[\s*{name}\s*\]",
                                     text):
                yield at(path, text, match.start(), f"arithmetic on the plain char {name}")
        for name in set(visible(the_house, path, text, rf"\bchar\s+({NAME})\s*\[")):
            for match in re.finditer(rf"\b{name}\[[^\]]*\]\s*(?:\+\+|--|[-+*/%&|^]=|<<=|>>=)", text):
                yield at(path, text, match.start(), f"arithmetic on the plain char {name}[]")


def octets(the_house):
    """A word of the receive FIFO has flags above bit 7: it becomes an octet by octet_of()."""
    for path, text in each(the_house, ("firmware",), ".c"):
        for match in re.finditer(r"\boctets\s*\[", text):
            if not re.search(rf"octet_of\(\s*[\w.>-]*$", text[:match.start()]):
                yield at(path, text, match.start(), "an octet not taken through octet_of()")


def arguments(text, start):
    depth, begin, found = 0, start, []
    for place in range(start, len(text)):
        if text[place] == "," and depth == 0:
            found.append(text[begin:place].strip())
            begin = place + 1
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth < 0:
            return found + [text[begin:place].strip()]
    return found


def timeouts(the_house):
    """A kernel time of 65535 ticks means for ever on a C28x, and a longer one something else: each is a constant below."""
    values = {name: int(value, 0) for path, _ in each(the_house, ("firmware",)) for name, value in DEFINE.findall(the_house.text(path))}
    which = {"Semaphore_pend": 1, "Event_pend": 3, "Task_sleep": 0, "Clock_create": 1}
    for path, text in each(the_house, ("firmware",), ".c"):
        for match in CALL.finditer(text):
            given = arguments(text, match.end())[which[match.group(1)]]
            if given not in ("BIOS_WAIT_FOREVER", "BIOS_NO_WAIT") and values.get(given, FOREVER) >= FOREVER:
                yield at(path, text, match.start(), f"{match.group(1)} for {given}: not a constant below {FOREVER} ticks")


def interrupts(the_house):
    """SYS/BIOS owns the PIE: it acknowledges, enables and dispatches; the handlers are plain functions."""
    for path, text in each(the_house, house.PRODUCT):
        for match in FOREIGN.finditer(text):
            yield at(path, text, match.start(), f"{match.group()}: SYS/BIOS's business, or a keyword of TI's compiler")


def bodies(text):
    """{function: body} of a C file."""
    found = {}
    for match in FUNCTION.finditer(text):
        end = text.find("\n}\n", match.end())
        found[match.group(1)] = text[match.end():end]
    return found


def flags(the_house):
    """The SCI's flag is cleared last: cleared before the FIFO is read, it rises at once and is served for nothing; a full
    FIFO that is not cleared of its overflow raises no flag any more."""
    path = "bsp/uart.c"
    functions = bodies(code(the_house, path)) if path in the_house.sources("bsp", ".c") else {}
    for name in ("bsp_uart_receive", "bsp_uart_transmit_acknowledge"):
        calls = re.findall(rf"\b({NAME})\s*\(", functions.get(name, ""))
        if not calls or calls[-1] != "SCI_clearInterruptStatus":
            yield f"{path}: {name}: its last call is not SCI_clearInterruptStatus()"
    text = "".join(functions.values())
    for needed in ("SCI_performSoftwareReset", "SCI_clearOverflowStatus"):
        if needed not in text:
            yield f"{path}: {needed}() is never called: reception stops after the first error"


RULES = (sizes, shifts, overlays, formats, characters, octets, timeouts, interrupts, flags)


def check(the_house):
    return [complaint for rule in RULES for complaint in rule(the_house)]


if __name__ == "__main__":
    house.main(check)
