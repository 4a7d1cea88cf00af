"""drape --profile: a trace that a viewer can nest, the table in run.h5, and the same result as without it."""
import json
import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SCENE = ["builtin:hanging", "--set", "sheet.resolution=65", "--set", "solver.until=0.2",
         "--set", "output.picture=false", "--threads", "2", "--quiet"]


class Profile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.TemporaryDirectory()
        cls.plain, cls.profiled = (os.path.join(cls.root.name, name) for name in ["plain", "profiled"])
        for folder, options in [(cls.plain, []), (cls.profiled, ["--profile"])]:
            result = subprocess.run([PROGRAM, "drape", *SCENE, "-o", folder, *options], capture_output=True, text=True,
                                    timeout=120)
            assert result.returncode == 0, result.stderr
        cls.table = result.stderr
        with open(os.path.join(cls.profiled, "trace.json")) as file:
            cls.trace = json.load(file)

    @classmethod
    def tearDownClass(cls):
        cls.root.cleanup()

    def test_events_nest_on_every_track_and_both_threads_worked(self):
        tracks = {}
        for event in self.trace["traceEvents"]:
            if event["ph"] == "X":
                begin = round(1000 * event["ts"])
                tracks.setdefault(event["tid"], []).append((begin, begin + round(1000 * event["dur"])))
        names = {e["args"]["name"] for e in self.trace["traceEvents"] if e["name"] == "thread_name"}
        self.assertIn("main", names)
        self.assertEqual(len(tracks), 2)
        self.assertGreater(len(tracks[0]), 500)
        for events in tracks.values():
            open_ends = []
            for begin, end in sorted(events, key=lambda span: (span[0], -span[1])):
                while open_ends and open_ends[-1] <= begin:
                    open_ends.pop()
                self.assertTrue(not open_ends or end <= open_ends[-1])
                open_ends.append(end)

    def test_the_run_holds_the_table_and_the_machine(self):
        with h5py.File(os.path.join(self.profiled, "run.h5"), "r") as file:
            group = file["selvage/profile"]
            phases = list(group.attrs["phase"])
            for phase in ["run/assemble", "run/drape", "run/drape/linear_solve/multigrid_cycle"]:
                self.assertIn(phase, phases)
            total, own, parent = group["total_s"][()], group["self_s"][()], group["parent"][()]
            for row in range(len(phases)):
                parts = total[parent == row].sum()
                self.assertAlmostEqual(own[row] + parts, total[row], delta=1e-6 * total[0])
            self.assertTrue(np.all(group["p50_s"][()] <= group["p95_s"][()]))
            self.assertGreater(group.attrs["copy_bytes_per_second"], 1e8)
            for key in ["cpu_name", "compiler", "flags", "version", "num_cpus", "memory_bytes"]:
                self.assertTrue(group.attrs[key], key)
        with h5py.File(os.path.join(self.plain, "run.h5"), "r") as file:
            self.assertNotIn("profile", file["selvage"])

    def test_the_table_is_printed_with_roofline_figures(self):
        for word in ["phase", "self s", "p95 ms", "linear_solve", "GB/s", "of copy", "GFLOP/s", "cores"]:
            self.assertIn(word, self.table)

    def test_the_result_is_the_same_as_without(self):
        self.assertFalse(os.path.exists(os.path.join(self.plain, "trace.json")))
        last = []
        for folder in [self.plain, self.profiled]:
            with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
                last.append(file["selvage/positions"][-1])
        np.testing.assert_array_equal(*last)


if __name__ == "__main__":
    unittest.main()
