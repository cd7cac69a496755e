#!/usr/bin/env python3
"""vehicle_js.py WASM JS: plomada.wasm as a script, because a page that was opened from a disk may fetch nothing else."""
import base64
import sys
from pathlib import Path

text = base64.b64encode(Path(sys.argv[1]).read_bytes()).decode("ascii")
Path(sys.argv[2]).write_text(f"window.plomadaVehicle='{text}';\n", encoding="ascii")
