"""numba is asked about every file with compiled code, so that no stale code is taken."""

from pathlib import Path

from compiling import SOURCES


def test_every_file_with_compiled_code_is_asked_whether_it_changed():
    project = Path(__file__).resolve().parent.parent
    found = {
        path.relative_to(project).as_posix()
        for path in project.glob("[a-z]*/*.py")
        if "\nfrom compiling import " in path.read_text(encoding="utf-8") and path.parent.name != "tests"
    }
    assert found == set(SOURCES)
