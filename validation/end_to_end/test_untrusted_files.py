"""Runs and checkpoints are read as files that anyone may have made: faults in them end in exit code 2 and a message."""
import os
import resource
import shutil
import struct
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
MEMORY = 4 << 30    # address space for the program [bytes]; a file of 0.1 MB must need far less


def call(*arguments, timeout=60):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=timeout,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))


def replace(file, name, data, **options):
    del file[name]
    file.create_dataset(name, data=data, **options)


def first_value(name, value):
    def change(file):
        file[name][0] = value
    return change


# What is wrong with a run, and what the message must name.
FAULTS = {
    "flat triangles": (lambda f: replace(f, "selvage/triangles", np.arange(23, dtype="i4")),
                       ["/selvage/triangles", "(23)", "(any, 3)"]),
    "a triangle without its point": (first_value("selvage/triangles", 1000000),
                                     ["/selvage/triangles[0]", "1000000", "from 0 to 24"]),
    "a negative index": (first_value("selvage/triangles", -1), ["/selvage/triangles[0]", "-1"]),
    "triangles of real numbers": (lambda f: replace(f, "selvage/triangles", np.zeros((2, 3))), ["/selvage/triangles"]),
    "a panel without a name": (first_value("VTKHDF/PointData/panel", 7), ["/VTKHDF/PointData/panel[0]", "panel 7"]),
    "few panels": (lambda f: replace(f, "VTKHDF/PointData/panel", np.zeros(3, "i4")),
                   ["/VTKHDF/PointData/panel", "(3)", "(25)"]),
    "many steps": (lambda f: f["VTKHDF/Steps"].attrs.create("NSteps", np.arange(12)),
                   ["/VTKHDF/Steps@NSteps", "(12)", "single"]),
    "more steps than frames": (lambda f: f["VTKHDF/Steps"].attrs.modify("NSteps", 100), ["/selvage/time", "100 rows"]),
    "negative steps": (lambda f: f["VTKHDF/Steps"].attrs.modify("NSteps", -1), ["NSteps", "-1"]),
    "a grid of many": (lambda f: f["selvage"].attrs.create("position_grid", np.zeros(200)), ["position_grid", "(200)"]),
    "a grid of words": (lambda f: f["selvage"].attrs.create("position_grid", "fine"), ["position_grid"]),
    "a number for a text": (lambda f: f["selvage"].attrs.create("scene_text", 3), ["scene_text"]),
    "no points": (first_value("VTKHDF/NumberOfPoints", 0), ["NumberOfPoints", "0"]),
    "points beyond all bounds": (first_value("VTKHDF/NumberOfPoints", 1 << 40), ["NumberOfPoints"]),
    "fewer positions than frames": (lambda f: f["VTKHDF/Points"].resize(40, 0), ["/VTKHDF/Points", "40 rows"]),
    "positions in odd chunks": (lambda f: replace(f, "VTKHDF/Points", f["VTKHDF/Points"][()], chunks=(10, 3)),
                                ["/VTKHDF/Points", "chunk"]),
    "times that run backwards": (first_value("selvage/time", 9), ["/selvage/time[1]"]),
    "times that are not finite": (first_value("selvage/time", np.nan), ["/selvage/time[0]"]),
    "a file within the file": (lambda f: replace(f, "selvage/residual", "text"), ["/selvage/residual"]),
    "a dataset that is a group": (lambda f: (f.pop("selvage/contacts"), f.create_group("selvage/contacts")),
                                  ["/selvage/contacts"]),
    "values that are not stored": (
        lambda f: replace(f, "selvage/time", None, shape=(1 << 30,), dtype="f8"), ["/selvage/time", "stored"]),
    "arrays that are not stored": (
        lambda f: replace(f, "selvage/seam_pairs", None, shape=(1 << 28, 2), dtype="i4", chunks=(1 << 20, 2),
                          compression="gzip"), ["/selvage/seam_pairs", "stored"]),
    "a filter of another kind": (
        lambda f: replace(f, "selvage/seam_pairs", np.zeros((4, 2), "i4"), chunks=(4, 2), scaleoffset=0),
        ["/selvage/seam_pairs", "filter"])}


class Runs(unittest.TestCase):
    """Faults of run.h5, for `info` and `render`."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = holder.name
        cls.out = cls.path("out")
        result = call("drape", "builtin:sphere", "--set", "sheet.resolution=5", "--set", "solver.until=0.1", "--set",
                      "output.picture=false", "--set", "output.keep_checkpoint=true", "-o", cls.out, "--quiet")
        if result.returncode != 0:
            raise AssertionError(f"exit code {result.returncode}: {result.stderr}")

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def changed(self, change):
        path = self.path("changed.h5")
        shutil.copyfile(os.path.join(self.out, "run.h5"), path)
        with h5py.File(path, "r+") as file:
            change(file)
        return path

    def refused(self, path, words, timeout=20):
        for command in [["info", path], ["render", path, "-o", self.path("x.png"), "--width", "64"]]:
            result = call(*command, timeout=timeout)
            self.assertEqual(result.returncode, 2, result.stderr)
            for word in [path, *words]:
                self.assertIn(word, result.stderr)

    def test_the_run_itself_is_told_and_drawn(self):
        path = self.changed(lambda file: None)
        self.assertEqual(call("info", path).returncode, 0)
        self.assertEqual(call("render", path, "-o", self.path("x.png"), "--width", "64").returncode, 0)

    def test_faults_of_layout_size_and_index_are_named(self):
        for name, (change, words) in FAULTS.items():
            with self.subTest(name):
                self.refused(self.changed(change), words)

    def test_chunks_cannot_lie_in_the_same_place(self):
        """Else a small file could have the same bytes read and inflated for each of its frames."""
        path = self.changed(lambda file: None)
        with h5py.File(path) as file:
            chunks = [file["VTKHDF/Points"].id.get_chunk_info(k) for k in range(3)]
        with open(path, "rb") as file:
            bytes_ = file.read()
        for chunk in chunks:
            key = struct.pack("<IIQ", chunk.size, 0, chunk.chunk_offset[0])
            self.assertEqual(bytes_.count(key), 1)
            bytes_ = bytes_.replace(key, struct.pack("<IIQ", len(bytes_) // 2, 0, chunk.chunk_offset[0]))
        with open(path, "wb") as file:
            file.write(bytes_)
        self.refused(path, ["/VTKHDF/Points", "chunks that overlap"])

    def test_a_newer_format_is_refused_with_its_cure(self):
        path = self.path("newer.h5")
        with h5py.File(path, "w", libver="latest") as file:
            file["selvage/triangles"] = np.zeros((1, 3), "i4")
        self.refused(path, ["newer format", "h5repack --low=0"])

    def test_text_of_a_file_cannot_reach_the_terminal_as_control_characters(self):
        def change(file):
            file["selvage"].attrs["version"] = "1\x1b[2J\x9b31m"
        result = call("info", self.changed(change))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([c for c in result.stdout if c != "\n" and (c < " " or "\x7f" <= c < "\xa0")], [])
        self.assertIn("[2J", result.stdout)

    def test_rows_after_the_last_frame_are_not_read(self):
        path = self.changed(lambda file: file["selvage/kinetic_energy"].resize((10 ** 9,)))
        self.assertEqual(call("info", path).returncode, 0)

    def test_positions_that_are_not_finite_are_not_drawn(self):
        def change(file):
            file["VTKHDF/Points"][-25:] = np.nan
        result = call("render", self.changed(change), "-o", self.path("x.png"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("/VTKHDF/Points", result.stderr)

    def test_nothing_outside_the_file_is_read(self):
        pipe = self.path("pipe")
        if not os.path.exists(pipe):
            os.mkfifo(pipe)
        with h5py.File(self.path("other.h5"), "w") as file:
            file["data"] = np.zeros((32, 3), "i4")

        def external_link(target):
            def change(file):
                del file["selvage/triangles"]
                file["selvage/triangles"] = h5py.ExternalLink(target, "/data")
            return change

        def external_group(file):
            del file["selvage"]
            file["selvage"] = h5py.ExternalLink(self.path("other.h5"), "/")

        def virtual(target):
            def change(file):
                del file["selvage/triangles"]
                layout = h5py.VirtualLayout((32, 3), "i4")
                layout[:] = h5py.VirtualSource(target, "data", (32, 3))
                file.create_virtual_dataset("selvage/triangles", layout)
            return change

        def external_storage(file):
            replace(file, "selvage/triangles", None, shape=(32, 3), dtype="i4",
                    external=[("/etc/passwd", 0, 384)])

        for target in [pipe, self.path("other.h5")]:
            for change in [external_link(target), virtual(target)]:
                self.refused(self.changed(change), ["/selvage/triangles"])
        self.refused(self.changed(external_storage), ["/selvage/triangles", "another file"])
        self.refused(self.changed(external_group), ["/selvage", "out of the file"])

    def test_what_is_no_file_is_refused_at_once(self):
        pipe = self.path("a_pipe.h5")
        os.mkfifo(pipe)
        for place in [pipe, self.folder, "/dev/zero"]:
            self.refused(place, ["something that is not a file"], timeout=5)

    def test_damage_anywhere_is_survived(self):
        with open(os.path.join(self.out, "run.h5"), "rb") as file:
            whole = file.read()
        random = np.random.default_rng(1)
        path = self.path("damaged.h5")
        for number in range(12):
            damaged = bytearray(whole)
            for place in random.integers(0, len(whole) if number % 2 else 4096, 1 + number % 5):
                damaged[place] = random.integers(256)
            with open(path, "wb") as file:
                file.write(damaged if number % 4 else damaged[:random.integers(len(whole))])
            with self.subTest(number):
                self.assertIn(call("info", path).returncode, [0, 2])


if __name__ == "__main__":
    unittest.main()
