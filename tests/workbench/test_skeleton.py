"""The skeleton of an effect holds nothing of a campaign but quoted words, whatever a campaign is called inside."""

import ast

import pytest

from effects.library import effects_of_file
from workbench.errors import WorkbenchError
from workbench.ledger.skeleton import skeleton, write_new

EVIL = (
    "x'] + __import__('os').system('touch TRAP') #",
    'x"] + __import__("pathlib").Path("TRAP").touch() #',
    '"""\nopen("TRAP", "w")\n"""',
    "a\\",
    "a\nimport os\n",
    "{x.__class__}",
    "\u2028\x85\r",
)


def signature(name):
    return {
        "channel": f"{name}.{name}", "regime": {name: (0.0, 1.0)}, "exponents": {name: (1.0, 2.0, 3.0)}, "orders": (),
        "size_in_u": 3.0,
    }  # fmt: skip


@pytest.mark.parametrize("name", EVIL)
def test_names_of_a_campaign_are_never_code(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    for found in (signature(name), {**signature(name), "exponents": {}}, {}):
        path = tmp_path / "my_effect.py"
        write_new(path, skeleton(path, found, name, name, [name, "angle_mech"], 0.1))
        tree = ast.parse(path.read_text(encoding="utf-8"))
        called = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
        assert {ast.unparse(func) for func in called} <= {
            "dataclass", "parameter", "Normal", "np.sign", "np.abs", "np.ones_like", "np.cos"
        }  # fmt: skip
        (effect,) = effects_of_file(path).values()
        (shape,) = effect(size=0.0).on_response({name: 1.0}, {}, name, None).values()
        assert shape == 1.0 and not (tmp_path / "TRAP").exists()
        path.unlink()


@pytest.mark.parametrize("name", ["class.py", "_.py", "a b.py", "x.txt", "größe.py"])
def test_an_effect_file_has_a_name_that_python_can_import(tmp_path, name):
    with pytest.raises(WorkbenchError, match="snake case"):
        write_new(tmp_path / name, "")


def test_a_size_that_is_no_number_gives_a_range_all_the_same(tmp_path):
    text = skeleton(tmp_path / "e.py", {}, "force", "generic", ["x"], float("nan"))
    assert "low=-20, high=20" in text
