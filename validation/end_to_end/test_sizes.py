"""Folders, files and functions stay small enough to be read at one sitting."""
import ast
import re
import unittest
from collections import Counter

from sources import ROOT, Sources, folder_of, project_files, read_sources, unit_of

MOST_UNITS = 16         # in a folder, not counting its subfolders
MOST_LINES = 500        # of a file
MOST_FUNCTION = 60      # lines of a function's body, braces included


def units_per_folder(sources):
    return Counter(folder_of(unit) for unit in {unit_of(name) for name in sources.texts})


def cpp_functions(text):
    """Yields (line, lines) of every function body that takes more than a line.

    Under this project's clang-format nothing but the body of a function, or a bare block or row in one, opens with a
    brace that has its line to itself, and the brace that closes it starts the next line of the same indent.
    """
    opened = {}
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r"( *)(\{ *\\?$|\})", line)
        if match and match[2] != "}":
            opened[match[1]] = number
        elif match and match[1] in opened:
            start = opened.pop(match[1])
            yield start, number - start + 1


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            yield node.lineno, node.end_lineno - node.lineno + 1


def long_functions(texts):
    return [f"{name}:{line} starts a function of {lines} lines"
            for name, text in texts.items()
            for line, lines in (python_functions if name.endswith(".py") else cpp_functions)(text)
            if lines > MOST_FUNCTION]


class Sizes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sources = read_sources()
        scripts = [path.as_posix() for path in project_files() if path.suffix == ".py"]
        cls.texts = cls.sources.texts | {name: (ROOT / name).read_text() for name in scripts}

    def assert_none(self, violations):
        if violations:
            self.fail("\n" + "\n".join(violations))

    def test_no_folder_has_more_units_than_one_can_survey(self):
        self.assert_none([f"{folder} has {count} units, more than {MOST_UNITS}"
                          for folder, count in units_per_folder(self.sources).items() if count > MOST_UNITS])

    def test_no_file_is_longer_than_500_lines(self):
        self.assert_none([f"{name} has {len(text.splitlines())} lines, more than {MOST_LINES}"
                          for name, text in self.texts.items() if len(text.splitlines()) > MOST_LINES])

    def test_no_function_is_longer_than_60_lines(self):
        found = sum(len(list(cpp_functions(text))) for text in self.sources.texts.values())
        self.assertGreater(found, 4 * len(self.sources.texts), "functions are no longer recognised")
        self.assert_none(long_functions(self.texts))


class Guards(unittest.TestCase):
    """The measures above against what is known."""

    def test_a_header_and_its_source_are_one_unit_of_their_folder(self):
        sources = Sources({"io/a.hpp": "", "io/a.cpp": "", "io/b.hpp": "", "io/run/a.hpp": ""})
        self.assertEqual(units_per_folder(sources), {"io": 2, "io/run": 1})

    def test_functions_and_members_are_measured_from_brace_to_brace(self):
        text = ("int f(int a)\n{\n    if (a) {\n        return 1;\n    }\n    return 2;\n}\n"
                "struct S {\n    int g()\n    {\n        return f(1);\n    }\n    int h = 1;\n};\n")
        self.assertEqual(list(cpp_functions(text)), [(2, 6), (10, 3)])

    def test_a_long_function_is_reported_in_either_language(self):
        texts = {"a.cpp": "void f()\n{\n" + "    g();\n" * 59 + "}\n",
                 "b.cpp": "void f()\n{\n" + "    g();\n" * 58 + "}\n",
                 "a.py": "def f():\n" + "    g()\n" * 60, "b.py": "def f():\n" + "    g()\n" * 59}
        self.assertEqual(long_functions(texts), ["a.cpp:2 starts a function of 61 lines",
                                                 "a.py:1 starts a function of 61 lines"])


if __name__ == "__main__":
    unittest.main()
