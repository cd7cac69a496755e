"""C sources for cells of 16 bits.

Together with cells.h this makes of avr-gcc a compiler with CHAR_BIT 16, as TI's for the C28x: every character and string
constant becomes wide (a cell per character), and sizeof counts cells.
"""
import re

KEPT = r"//[^\n]*|/\*.*?\*/|^[ \t]*\#[ \t]*(?:include|error|pragma|line|warning)[^\n]*|\bsection\s*\([^)]*\)"
CONSTANT = r"\b(?:L|u8|u|U)?(?:\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*')|(?:\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*')"
TOKEN = re.compile(rf"(?P<kept>{KEPT})|(?P<constant>{CONSTANT})|(?P<sizeof>\bsizeof\b)|(?P<file>\b__FILE__\b)", re.DOTALL | re.MULTILINE)
OPERAND = re.compile(r"\s*[*&]*\s*\w+(?:\s*(?:\.|->)\s*\w+|\[[^\]]*\])*")
POSTFIX = re.compile(r"(?:\s*(?:\.|->)\s*\w+|\[[^\]]*\])*")


def parenthesis_end(text, start):
    depth = 0
    for at in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        if depth == 0:
            return at + 1
    raise ValueError("a parenthesis that is not closed")


def operand_end(text, start):
    """End of the operand of sizeof: (type), (expression) and what follows it, or a name with what follows it."""
    blank = len(text[start:]) - len(text[start:].lstrip())
    if text[start + blank] == "(":
        end = parenthesis_end(text, start + blank)
        return POSTFIX.match(text, end).end()
    found = OPERAND.match(text, start)
    if not found:
        raise ValueError(f"sizeof what? {text[start:start + 40]!r}")
    return found.end()


def convert(text, path):
    """The text of the C source file `path`, converted; its lines keep their numbers."""
    out, at = [], 0
    while True:
        found = TOKEN.search(text, at)
        if not found:
            return f'#line 1 "{path}"\n' + "".join(out) + text[at:]
        out.append(text[at:found.start()])
        at = found.end()
        token = found.group()
        if found.group("sizeof"):
            at = operand_end(text, at)
            token = f"CELLS_OF(sizeof{text[found.end():at]})"
        elif found.group("file"):
            token = f'L"{path}"'
        elif found.group("constant") and token[0] in "\"'":
            token = "L" + token
        out.append(token)
