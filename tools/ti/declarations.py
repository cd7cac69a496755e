"""The declarations of sim/'s stand-ins, as checks that gcc makes against TI's headers.

A check is C text at file scope, compiled under a name of its own: gcc's messages then begin with the name of what differs.
"""
import re

# Not integers: only their presence is checked.
NOT_VALUES = {"EALLOW", "EDIS", "ESTOP0", "FLASH_DELAY_CONFIG", "F021_CPU0_W0_BASE_ADDRESS", "HWREGH"}
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
DEFINE = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)(\(\w+\))?[ \t]+(\S.*)$", re.MULTILINE)
FUNCTION = re.compile(r"(?:static inline\s+)?(.*?)\b(\w+)\s*\(([^()]*)\)$", re.DOTALL)
FUNCTION_TYPE = re.compile(r"typedef\s+(.*?)\(\*(\w+)\)\s*\((.*)\)$", re.DOTALL)


class Declarations:
    def __init__(self):
        self.values, self.macros, self.present = [], [], []     # names; names of one parameter; names
        self.functions = []         # (return type, name, parameters)
        self.aliases = []           # (type, name)
        self.function_types = []    # (return type, name, parameters)
        self.fields = []            # (struct, type, field)

    def read(self, text):
        text = COMMENT.sub(" ", text).replace("\\\n", " ")
        for name, parameter, body in DEFINE.findall(text):
            if name in NOT_VALUES:
                self.present.append(name)
            elif parameter:
                self.macros.append(name)
            else:
                self.values.append(name)
        for statement in statements(re.sub(r"^[ \t]*#.*$", "", text, flags=re.MULTILINE)):
            self.take(" ".join(statement.split()))
        return self

    def take(self, statement):
        enumeration = re.match(r"typedef enum \{(.*)\} \w+$", statement)
        structure = re.match(r"typedef struct \{(.*)\} (\w+)$", statement)
        function_type = FUNCTION_TYPE.match(statement)
        alias = re.match(r"typedef (.*?)(\w+)$", statement)
        function = FUNCTION.match(statement)
        if enumeration:
            self.values += re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", enumeration.group(1).strip())
        elif structure:
            self.take_fields(structure.group(2), structure.group(1))
        elif function_type:
            self.function_types.append(function_type.groups())
        elif alias and not re.match(r"struct \w+_Object \*", alias.group(1)):
            self.aliases.append((alias.group(1).strip(), alias.group(2)))
        elif not alias and function and not function.group(2).startswith("driverlib_"):
            result, name, parameters = function.groups()
            self.functions.append((result.strip(), name, parameters))

    def take_fields(self, structure, body):
        for line in filter(None, (part.strip() for part in body.split(";"))):
            kind, names = re.match(r"(.*?[\s*])(\w+(?:\s*,\s*\w+)*)$", line).groups()
            self.fields += [(structure, kind.strip(), name.strip()) for name in names.split(",") if "__" not in name]


def statements(text):
    """Each declaration at file scope without its `;`, a function's body left out."""
    depth, start, body = 0, 0, None
    for at, character in enumerate(text):
        if character == "{":
            if depth == 0:
                body = at
            depth += 1
        elif character == "}":
            depth -= 1
            if depth == 0 and "typedef" not in text[start:body]:
                yield text[start:body].strip()
                start = at + 1
        elif character == ";" and depth == 0:
            yield text[start:at].strip()
            start = at + 1


def type_checks(found):
    """{name: C text at file scope}"""
    checks = {}
    for result, name, parameters in found.functions:
        checks[name] = f"{result} (*const pointer)({parameters}) = {name};"
    for kind, name in found.aliases:
        checks[name] = f"{kind} *pointer = ({name} *)0;"
    for result, name, parameters in found.function_types:
        checks[name] = f"{result} (*pointer)({parameters}) = ({name})0;"
    for structure, kind, field in found.fields:
        checks[f"{structure}.{field}"] = f"{kind} *pointer(void);\n{kind} *pointer(void) {{ static {structure} s; return &s.{field}; }}"
    for name in found.present:
        checks[name] = f"#ifndef {name}\n#error missing\n#endif\nint nothing;"
    return checks


def expressions(found):
    """Integer constants: names, and calls of the one-parameter macros."""
    return list(dict.fromkeys(found.values)) + [f"{name}({value})" for name in found.macros for value in (2, 40)]


def value_checks(values):
    """{expression: C text at file scope}"""
    return {each: f'_Static_assert((unsigned long long)({each}) == {value}ULL, "is not {value}");' for each, value in values.items()}
