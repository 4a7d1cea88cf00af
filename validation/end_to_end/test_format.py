"""No line of a program, script or build list is longer than 120 columns."""
import unittest

from sources import ROOT, project_files

COLUMNS = 120
# Not kernels/fields.def and its like: a table has one row to a line.
SUFFIXES = (".h", ".hpp", ".cpp", ".py", ".cmake", ".sh")


def is_program(path):
    if path.suffix in SUFFIXES or path.name == "CMakeLists.txt":
        return True
    with (ROOT / path).open("rb") as file:
        return not path.suffix and file.read(2) == b"#!"


def long_lines(name, text):
    return [f"{name}:{number} has {len(line)} columns"
            for number, line in enumerate(text.splitlines(), 1) if len(line) > COLUMNS]


class Columns(unittest.TestCase):
    def test_no_line_is_longer_than_120_columns(self):
        programs = [path for path in project_files() if is_program(path)]
        for kind in ("check", ".ci/prepare", "CMakeLists.txt", "kernels/portable.h", "host/main.cpp"):
            self.assertIn(kind, [path.as_posix() for path in programs])
        found = [message for path in programs for message in long_lines(path.as_posix(), (ROOT / path).read_text())]
        if found:
            self.fail("\n" + "\n".join(found))

    def test_columns_are_characters(self):
        self.assertEqual(long_lines("a", "x" * 120 + "\n" + "y" * 121 + "\n" + "é" * 120), ["a:2 has 121 columns"])


if __name__ == "__main__":
    unittest.main()
