"""What tests share that write files of their own."""
import os
import tempfile
import unittest


class Scratch(unittest.TestCase):
    """`folder` is there for one test, and removed with what lies in it."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """Writes a text, or lines; returns the path."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w") as file:
            file.write(text if isinstance(text, str) else "\n".join(text) + "\n")
        return self.path(name)
