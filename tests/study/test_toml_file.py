"""Whatever a path leads to, the answer is one sentence and exit code 2, at once; never a traceback, never a wait."""

import os
import socket
from pathlib import Path

import pytest

from study.errors import StudyError
from study.read import STUDIES, read_study
from study.toml_file import LARGEST_FILE
from study.usable import check_study
from tests.command_line import airgap

RIGHT = (STUDIES / "motorcycle.toml").read_text(encoding="utf-8")

posix = pytest.mark.skipif(os.name != "posix", reason="named pipes and devices are things of Unix")


def pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe.toml")
    return folder / "pipe.toml"


def loop(folder: Path) -> Path:
    (folder / "a.toml").symlink_to("b.toml")
    (folder / "b.toml").symlink_to("a.toml")
    return folder / "a.toml"


def dangling(folder: Path) -> Path:
    (folder / "link.toml").symlink_to("nothing.toml")
    return folder / "link.toml"


def pipe_behind_a_link(folder: Path) -> Path:
    (folder / "link.toml").symlink_to(pipe(folder))
    return folder / "link.toml"


def bound_socket(folder: Path) -> Path:
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(folder / "s.toml"))
    return folder / "s.toml"


def written(name: str, content: bytes):
    def write(folder: Path) -> Path:
        (folder / name).write_bytes(content)
        return folder / name

    return write


def nested(opening: str, closing: str, times: int) -> bytes:
    return f"[machine]\nairgap_mm = {opening * times}1{closing * times}\n".encode()


FILES = {
    "named pipe": (pipe, ["pipe.toml", "named pipe"]),
    "named pipe behind a link": (pipe_behind_a_link, ["named pipe"]),
    "endless device": (lambda _: Path("/dev/zero"), ["/dev/zero", "a device"]),
    "terminal or nothing": (lambda _: Path("/dev/null"), ["/dev/null", "a device"]),
    "folder": (lambda folder: folder, ["a folder"]),
    "socket": (bound_socket, ["s.toml cannot be read"]),
    "symlink loop": (loop, ["a.toml", "symbolic link that leads to no file"]),
    "dangling symlink": (dangling, ["link.toml", "symbolic link that leads to no file"]),
    "path through a file": (lambda _: STUDIES / "motorcycle.toml" / "x.toml", ["x.toml does not exist"]),
    "very long name": (lambda folder: folder / ("x" * 5000 + ".toml"), ["cannot be read", "name too long"]),
    "zero byte in the name": (lambda folder: folder / "a\0b.toml", ["does not exist"]),
    "not UTF-8": (written("latin.toml", b'title = "Gr\xf6\xdfe"'), ["not a text file in UTF-8", "byte 11"]),
    "lists 3000 deep": (written("deep.toml", nested("[", "]", 3000)), ["deep.toml", "nested too deeply"]),
    "tables 3000 deep": (written("deep.toml", nested("{a=", "}", 3000)), ["deep.toml", "nested too deeply"]),
    "sections 3000 deep": (written("deep.toml", b"[a" + b".a" * 2999 + b"]\nx = 1\n"), ["nested more than 8"]),
    "key 3000 deep": (written("deep.toml", b"machine" + b".a" * 3000 + b" = 1\n"), ["nested more than 8 deep"]),
    "lists 20 deep": (written("deep.toml", nested("[", "]", 20)), ["nested more than 8 deep"]),
    "integer of 5000 digits": (written("long.toml", b"[machine]\nslots = " + b"1" * 5000), ["not valid TOML"]),
    "zero bytes": (written("zero.toml", b"\0" * 100), ["zero.toml", "not valid TOML"]),
    "very large": (written("large.toml", b"#" * (LARGEST_FILE + 1)), ["large.toml", "more than any study"]),
}  # fmt: skip


def refusal(path, overrides=()) -> str:
    with pytest.raises(StudyError) as caught:
        read_study(path, overrides)
    text = str(caught.value)
    assert text.count("\n") == 0 and text.endswith("."), text
    return text


@posix
@pytest.mark.parametrize("make, named", FILES.values(), ids=FILES.keys())
def test_one_sentence_about_anything_that_is_no_study(tmp_path, make, named):
    text = refusal(make(tmp_path))
    assert all(part in text for part in named), text


@posix
@pytest.mark.parametrize("kind", ["named pipe", "symlink loop", "lists 3000 deep", "folder"])
def test_the_command_exits_with_2_and_one_line(tmp_path, kind):
    done = airgap("check", FILES[kind][0](tmp_path))
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1 and done.stdout == ""


@posix
@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may read everything")
def test_a_folder_that_may_not_be_looked_into(tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir()
    (folder / "study.toml").write_text(RIGHT)
    folder.chmod(0)
    try:
        assert "cannot be read (Permission denied)" in refusal(folder / "study.toml")
    finally:
        folder.chmod(0o700)


@posix
def test_a_study_behind_a_link_is_read(tmp_path):
    (tmp_path / "link.toml").symlink_to(STUDIES / "motorcycle.toml")
    assert read_study(tmp_path / "link.toml").study.id == "motorcycle"


@pytest.mark.parametrize(
    "value, named",
    [
        ("[" * 3000 + "]" * 3000, "nested too deeply"),
        ("[" * 20 + "]" * 20, "nested more than 8 deep"),
        ("1" * 5000, "give a number"),
        ("1" * 400, "give a number"),
        ("nan", "not a finite number"),
        ("-inf", "not a finite number"),
    ],
    ids=["3000 deep", "20 deep", "5000 digits", "400 digits", "nan", "inf"],
)
def test_an_override_that_is_no_number_of_this_world(value, named):
    text = refusal("motorcycle", [f"machine.airgap_mm={value}"])
    assert named in text and len(text) < 1000


def test_an_integer_of_400_digits_where_an_integer_is_expected():
    assert "not a finite number" in refusal("motorcycle", ["machine.slots=" + "1" * 400])


@posix
@pytest.mark.parametrize("key", ["materials.steel", "dampers.maximum", "obstacles.shape"])
def test_a_table_of_the_study_that_is_a_named_pipe(tmp_path, key):
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(StudyError, match=r"pipe\.csv"):
        check_study(read_study("motorcycle", [f"{key}='{tmp_path / 'pipe.csv'}'"]))
