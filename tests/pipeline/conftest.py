"""Modules beside the tests can be imported by name, as worker processes need it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
