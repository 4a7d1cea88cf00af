"""All C++ is as clang-format 14 writes it. Other versions of clang-format write some of it differently."""
import re
import shutil
import subprocess
import sys
import unittest

from sources import ROOT, project_files

PROGRAM = "clang-format"
VERSION = "14"
SKIPPED = 77   # the exit code by which ctest knows a skipped test


def version_found():
    """Returns clang-format's major version, or None if there is no clang-format."""
    if not shutil.which(PROGRAM):
        return None
    said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"version (\d+)", said)[1]


def faults(*arguments, text=None):
    """Returns clang-format's exit code and report on files, or on a text in place of a file."""
    result = subprocess.run([PROGRAM, "--dry-run", "--Werror", "--style=file", *arguments], input=text,
                            capture_output=True, text=True, cwd=ROOT)
    return result.returncode, result.stderr


class ClangFormat(unittest.TestCase):
    def test_every_file_is_formatted(self):
        files = [path.as_posix() for path in project_files() if path.suffix in (".h", ".hpp", ".cpp")]
        self.assertGreater(len(files), 100)
        code, said = faults(*files)
        if code:
            self.fail("\n" + said)

    def test_a_misplaced_brace_is_reported(self):
        code, said = faults("--assume-filename=host/main.cpp", text="int main() {\n    return 0;\n}\n")
        self.assertNotEqual(code, 0)
        self.assertIn("host/main.cpp:1:13: error: code should be clang-formatted", said)


if __name__ == "__main__":
    version = version_found()
    if not version:
        sys.exit(f"There is no {PROGRAM}; .ci/packages lists it.")
    if version != VERSION:
        print(f"Skipped: this is {PROGRAM} {version}, and the format is that of {PROGRAM} {VERSION}.")
        sys.exit(SKIPPED)
    unittest.main()
