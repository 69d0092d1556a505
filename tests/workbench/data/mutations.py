"""Campaigns broken at random: what a laboratory, a careless editor or somebody with bad intentions may hand in.

python -m tests.workbench.data.mutations 2600        # also builds model and bench, and counts what is no sentence
"""

from __future__ import annotations

import datetime
import json
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path

import numpy as np

from effects.library import library
from workbench.data.campaign import read_campaign
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.likelihood.bench import bench_of
from workbench.models.bases import nominal_model

Content = dict[str, object]
Rows = list[list[str]]

LONGEST = 30  # seconds for one campaign, when run by hand
ODD_VALUES = (
    True, False, 0, -1, 1, 2, -0.0, 1e308, -1e308, 1e-308, float("nan"), float("inf"), -float("inf"), 10**400, "", " ",
    "?", "text", "0", "1e308", "y", "9**9**9", "1e308**2", "max(y, y, y)", "abs(", "(" * 150, "x" * 5000, "\x00",
    "../a", "/dev/zero", "Ω", "'''\"\"\"\\", "V", "mm", "condition", "response", "repeat", "scan", "generic",
    "machine", "dq",
    [], [1], ["a"], [[1]], {}, {"a": 1}, {"rule": 3}, {"sigma": "x"}, {"role": []}, datetime.date(2026, 1, 2),
    datetime.time(1, 2), datetime.datetime(2026, 1, 2, 3, 4),
)  # fmt: skip
ODD_CELLS = (
    "", " ", "---", "n/a", "nan", "inf", "-inf", "1e308", "-1e308", "1e400", "9.9e37", "text", "1,5", "1.234,5", '"',
    '"a', "1;2", "0", "-0", "1e-320", "Ω", "\x00", "1_0", "0x10", "1" * 6000, "2026-01-02 12:00:00", "True", "#", "1 2",
    "=1+1",
)  # fmt: skip

DAMPER = {
    "campaign": {"id": "fuzz", "repeats": 2, "holdout": {"rule": "last repeat of every table"}},
    "device": {
        "force_constant_N_per_A": 60.0, "internal_resistance_ohm": 1.2, "moving_mass_kg": 2.0,
        "viscous_damping_Ns_per_m": 20.0,
    },
    "tolerance": {"force_constant_N_per_A": {"sigma_rel": 0.01, "source": "drawing"}},
    "systematic": {"force_gain": {"sigma": 0.003, "kind": "gain"}},
    "table": [
        {"file": "a.csv", "kind": "damping_velocity", "u_random": {"force_N": "0.3 + 0.008*abs(y)"}},
        {
            "file": "b.csv", "kind": "back_emf",
            "columns": {
                "velocity_m_per_s": {"role": "condition", "u": 0.001},
                "voltage": {"role": "response", "unit": "V", "u_random": 0.05},
                "repeat": {"role": "repeat"},
            },
        },
    ],
}  # fmt: skip
DQ = {
    "campaign": {"id": "fuzz", "repeats": 1, "holdout": "column:holdout"},
    "device": {
        "pole_pairs": 4, "psi_m_Vs": 0.175, "inductance_d_mH": 2.5, "inductance_q_mH": 5.0, "resistance_mohm": 69,
        "reference_T_degC": 21, "copper_coefficient_per_K": 0.0039,
    },
    "tolerance": {"psi_m_Vs": {"sigma_rel": 0.02}, "resistance": {"sigma": 1, "unit": "mohm"}},
    "systematic": {"gain_of_the_box": {"sigma": 0.005, "kind": "gain"}},
    "table": [
        {
            "file": "a.csv", "kind": "dq_operation",
            "columns": {
                "i_d_A": {"role": "condition", "u": 0.1},
                "i_q_A": {"role": "condition"},
                "speed_rpm": {"role": "condition"},
                "winding_T_degC": {"role": "condition", "optional": True},
                "v_d_V": {"role": "response", "u_random": "0.1 + 0.01*abs(y)", "u_sys": ["gain_of_the_box"]},
                "v_q_V": {"role": "response", "u_random": 0.2, "u_sys": "gain_of_the_box"},
                "torque_Nm": {"role": "response", "u_random": 0.1},
                "holdout": {"role": "holdout"},
            },
        },
        {"file": "b.csv", "kind": "phase_resistance", "u_random": {"resistance_mohm": 0.5}},
    ],
}  # fmt: skip


def _damper_rows(random: np.random.Generator) -> dict[str, Rows]:
    a = [["repeat", "shunt_ohm", "velocity_m_per_s", "force_N"]]
    b = [["repeat", "velocity_m_per_s", "voltage"]]
    for repeat in range(2):
        for v in (0.05, 0.1, 0.2, 0.3, -0.1, -0.3):
            for shunt in (0.5, 5.0):
                force = 3600 * v / (1.2 + shunt) + 20 * v + 0.3 * random.standard_normal()
                a.append([str(repeat), f"{shunt}", f"{v}", f"{force:.3f}"])
            b.append([str(repeat), f"{v}", f"{60 * v + 0.05 * random.standard_normal():.3f}"])
    return {"a.csv": a, "b.csv": b}


def _dq_rows(random: np.random.Generator) -> dict[str, Rows]:
    a = [["i_d_A", "i_q_A", "speed_rpm", "winding_T_degC", "v_d_V", "v_q_V", "torque_Nm", "holdout"]]
    b = [["winding_T_degC", "resistance_mohm", "holdout"]]
    for number, (i_d, i_q, rpm) in enumerate((d, q, n) for d in (-20, 0) for q in (10, 30, 60) for n in (500, 1500)):
        w = 4 * rpm * np.pi / 30
        v_d, v_q = 0.069 * i_d - w * 5e-3 * i_q, 0.069 * i_q + w * (0.175 + 2.5e-3 * i_d)
        torque = 6 * (0.175 * i_q - 2.5e-3 * i_d * i_q)
        values = np.array([v_d, v_q, torque]) + 0.1 * random.standard_normal(3)
        a.append([f"{i_d}", f"{i_q}", f"{rpm}", "30", *(f"{v:.3f}" for v in values), str(number % 3 // 2)])
    b += [
        [f"{t}", f"{69 * (1 + 0.0039 * (t - 21)) + 0.3 * random.standard_normal():.2f}", "0"] for t in range(20, 100, 6)
    ]
    return {"a.csv": a, "b.csv": b}


BASES = ((DAMPER, _damper_rows), (DQ, _dq_rows))


# ---- what is done to them ------------------------------------------------------------------------------------------


def places(value: object, path: tuple = ()) -> list[tuple]:
    """The path of every entry below a value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [p for key, v in inner for p in ((*path, key), *places(v, (*path, key)))]


def _at(content: object, path: tuple) -> object:
    for key in path:
        content = content[key]
    return content


def _pick(random: np.random.Generator, options) -> object:
    return options[int(random.integers(len(options)))]


def odd_value(content: Content, random: np.random.Generator) -> None:
    path = _pick(random, places(content))
    _at(content, path[:-1])[path[-1]] = deepcopy(_pick(random, ODD_VALUES))


def lost_key(content: Content, random: np.random.Generator) -> None:
    path = _pick(random, places(content))
    del _at(content, path[:-1])[path[-1]]


def renamed_key(content: Content, random: np.random.Generator) -> None:
    paths = [p for p in places(content) if isinstance(p[-1], str)]
    path = _pick(random, paths)
    section = _at(content, path[:-1])
    name = path[-1]
    cut = int(random.integers(len(name))) if name else 0
    other = _pick(random, [name[:cut] + name[cut + 1 :], name + "s", name.upper(), "x", "", name[::-1], "a.b", "'\"\\"])
    section[other] = section.pop(name)


def swapped_values(content: Content, random: np.random.Generator) -> None:
    a, b = (_pick(random, [p for p in places(content) if _is_a_leaf(content, p)]) for _ in "ab")
    section_a, section_b = _at(content, a[:-1]), _at(content, b[:-1])
    section_a[a[-1]], section_b[b[-1]] = section_b[b[-1]], section_a[a[-1]]


def _is_a_leaf(content: Content, path: tuple) -> bool:
    return isinstance(path[-1], str) and not isinstance(_at(content, path), (dict, list))


def repeated_table(content: Content, random: np.random.Generator) -> None:
    tables = content.get("table")
    if isinstance(tables, list) and tables:
        tables.append(deepcopy(_pick(random, tables)))


def odd_cell(rows: Rows, random: np.random.Generator) -> None:
    row = _pick(random, rows)
    row[int(random.integers(len(row)))] = _pick(random, ODD_CELLS)


def odd_column(rows: Rows, random: np.random.Generator) -> None:
    k, cell = int(random.integers(len(rows[0]))), _pick(random, ODD_CELLS)
    for row in rows[1:]:
        row[k : k + 1] = [cell]


def lost_column(rows: Rows, random: np.random.Generator) -> None:
    k = int(random.integers(len(rows[0])))
    for row in rows:
        del row[k : k + 1]


def one_cell_more(rows: Rows, random: np.random.Generator) -> None:
    for row in rows if random.random() < 0.3 else [_pick(random, rows)]:
        row.append(_pick(random, ["", "1"]))


def one_cell_less(rows: Rows, random: np.random.Generator) -> None:
    _pick(random, rows).pop()


def renamed_column(rows: Rows, random: np.random.Generator) -> None:
    k = int(random.integers(len(rows[0])))
    rows[0][k] = _pick(
        random, [rows[0][0], rows[0][k].upper(), "", "x", rows[0][k] + " [V]", "a'b\"]", rows[0][k] + "s"]
    )


def few_rows(rows: Rows, random: np.random.Generator) -> None:
    del rows[int(random.integers(0, 4)) :]


def repeated_rows(rows: Rows, random: np.random.Generator) -> None:
    rows += [list(row) for row in rows[int(random.integers(len(rows))) :]]


def scaled_column(rows: Rows, random: np.random.Generator) -> None:
    k, factor = int(random.integers(len(rows[0]))), _pick(random, ["e30", "e300", "e-300", "e9", "e-9"])
    for row in rows[1:]:
        row[k : k + 1] = [cell + factor for cell in row[k : k + 1]]


def flipped_bytes(data: bytes, random: np.random.Generator) -> bytes:
    found = bytearray(data)
    for _ in range(int(random.integers(1, 6))):
        if found:
            found[int(random.integers(len(found)))] = int(random.integers(256))
    return bytes(found)


def cut_bytes(data: bytes, random: np.random.Generator) -> bytes:
    return data[: int(random.integers(len(data) + 1))]


def junk(data: bytes, random: np.random.Generator) -> bytes:
    return random.bytes(int(random.integers(0, 400)))


def other_encoding(data: bytes, random: np.random.Generator) -> bytes:
    return data.decode("utf-8", "replace").encode(_pick(random, ["utf-16", "utf-16-le", "utf-8-sig", "utf-32"]))


def other_delimiter(data: bytes, random: np.random.Generator) -> bytes:
    return data.replace(b",", _pick(random, [b";", b"\t", b"|", b" ", b":"]))


OF_CONTENT = (odd_value, odd_value, odd_value, odd_value, lost_key, renamed_key, swapped_values, repeated_table)
OF_ROWS = (odd_cell, odd_cell, odd_column, lost_column, one_cell_more, one_cell_less, renamed_column, few_rows,
           repeated_rows, scaled_column)  # fmt: skip
OF_BYTES = (flipped_bytes, cut_bytes, junk, other_encoding, other_delimiter)


def mutated(folder: Path, seed: int) -> str:
    """Writes a broken campaign to a folder; returns what was done to it."""
    random = np.random.default_rng(seed)
    base, rows_of = BASES[int(random.integers(len(BASES)))]
    content, tables, done = deepcopy(base), rows_of(random), []
    for _ in range(1 + int(random.random() < 0.3)):
        kind = random.random()
        if kind < 0.5:
            change = _pick(random, OF_CONTENT)
            change(content, random)
        else:
            change, name = _pick(random, OF_ROWS), _pick(random, sorted(tables))
            change(tables[name], random) if len(tables[name]) > 1 and all(tables[name]) else None
        done.append(change.__name__)
    files = {name: "\n".join(",".join(row) for row in rows).encode() + b"\n" for name, rows in tables.items()}
    files["campaign.toml"] = toml_of(content).encode("utf-8", "replace")
    if random.random() < 0.15:
        name, change = _pick(random, sorted(files)), _pick(random, OF_BYTES)
        files[name] = change(files[name], random)
        done.append(change.__name__)
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return ", ".join(done)


def toml_of(content: Content) -> str:
    """A dictionary as TOML, every section in one line of inline tables."""
    return "".join(f"{_key(name)} = {_value(value)}\n" for name, value in content.items())


def _key(name: str) -> str:
    return json.dumps(str(name)).replace("\x7f", "\\u007f")


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return _key(value) if isinstance(value, str) else str(value) if not isinstance(value, int) else f"{value:d}"


def in_a_folder(seed: int, use: Callable[[Campaign], object]) -> tuple[str, str]:
    """(outcome, what was done): "read", "sentence", or the traceback."""
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        done = mutated(Path(name), seed)
        try:
            use(read_campaign(name))
        except WorkbenchError as error:
            return ("sentence" if "\n" not in str(error) else f"two lines: {error}"), done
        except Exception:  # what this looks for
            return traceback.format_exc(), done
        return "read", done


def _too_long(number: int, frame: object) -> None:
    raise TimeoutError(f"not done after {LONGEST} s")


def main(count: int) -> None:
    """Counts what reading, the model of the device and the bench make of so many broken campaigns."""
    known, outcomes, where = library(), Counter(), Counter()

    def use(campaign: Campaign) -> None:
        bench_of(nominal_model(campaign), campaign, known)

    signal.signal(signal.SIGALRM, _too_long)
    for seed in range(count):
        signal.alarm(LONGEST)
        outcome, done = in_a_folder(seed, use)
        signal.alarm(0)
        short = outcome if outcome in ("read", "sentence") else "traceback"
        outcomes[short] += 1
        if short == "traceback":
            lines = outcome.strip().splitlines()
            place = [line.strip() for line in lines if line.strip().startswith("File") and "/workbench/" in line][-1:]
            where[f"{place[0].split('/workbench/')[-1] if place else '?'}: {lines[-1][:120]}"] += 1
            print(seed, done, lines[-1][:150], flush=True)
    for text, number in where.most_common():
        print(number, text)
    print(dict(outcomes))


if __name__ == "__main__":
    main(int(sys.argv[1]))
