"""Files that the documents name exist."""
import re
import unittest

from sources import ROOT

DOCUMENTS = ["README.md", "CONTRIBUTING.md"]
PAGES = sorted((ROOT / "docs").glob("*.md"))
# A path in backticks, below one of the project's folders; NAME and AREA stand for what the reader adds.
PATH = re.compile(r"`((?:kernels|io|host|validation|bench|docs|\.ci)/[\w./-]*)`")
PLACEHOLDER = re.compile(r"NAME|AREA")


def missing_paths(text):
    return [path for path in PATH.findall(text) if not PLACEHOLDER.search(path) and not (ROOT / path).exists()]


class Documents(unittest.TestCase):
    def test_every_file_that_a_document_names_exists(self):
        for name in DOCUMENTS:
            text = (ROOT / name).read_text()
            self.assertTrue(PATH.search(text), f"{name} names no file")
            self.assertEqual(missing_paths(text), [], name)

    def test_every_page_is_linked_from_the_readme(self):
        readme = (ROOT / "README.md").read_text()
        for page in PAGES:
            self.assertIn(f"(docs/{page.name})", readme)
            self.assertEqual(missing_paths(page.read_text()), [], page.name)

    def test_a_file_that_does_not_exist_is_found(self):
        self.assertEqual(missing_paths("see `host/nowhere.cpp` and `kernels/terms.h`"), ["host/nowhere.cpp"])


if __name__ == "__main__":
    unittest.main()
