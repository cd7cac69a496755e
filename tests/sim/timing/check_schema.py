"""A schedule trace against the schema of the trace event format, by somebody else's validator (jsonschema).

Usage: check_schema.py FILE. Exit status 0 valid, 1 not.

No package offers Perfetto's own trace processor: PyPI's perfetto fetches a program from elsewhere. So by hand, now and then:
open the file in https://ui.perfetto.dev; the tracks have names, and Info and stats shows no import error.
"""
import copy
import json
import sys
from pathlib import Path

import jsonschema

SCHEMA = json.loads(Path(__file__).with_name("trace_event.schema.json").read_text(encoding="utf-8"))
# What must not pass: one event each.
WRONG = ({"ph": "X", "pid": 1, "tid": 1, "name": "a", "ts": 1}, {"ph": "X", "pid": 1, "tid": 1, "name": "a", "ts": 1, "dur": -1},
         {"ph": "i", "pid": 1, "tid": 1, "name": "a", "ts": 1, "s": "x"}, {"ph": "M", "pid": 1, "name": "thread_name", "args": {}},
         {"ph": "Q", "pid": 1, "tid": 1, "name": "a", "ts": 1}, {"ph": "X", "pid": 1, "tid": 1, "name": "a", "ts": "1", "dur": 2})


def main():
    validator = jsonschema.Draft7Validator(SCHEMA)
    trace = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    trace = trace if isinstance(trace, dict) else {"traceEvents": trace}
    events = trace["traceEvents"]
    # Every fiftieth, and all that name something: the validator takes a millisecond for each.
    trace["traceEvents"] = [event for i, event in enumerate(events) if i % 50 == 0 or event.get("ph") == "M"]
    complaints = [f"{list(error.path)}: {error.message}" for error in list(validator.iter_errors(trace))[:10]]
    for event in WRONG:
        broken = copy.copy(trace)
        broken["traceEvents"] = [event]
        if validator.is_valid(broken):
            complaints.append(f"the schema lets pass: {event}")
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
