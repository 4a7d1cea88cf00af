"""Interrupted, killed and stopped runs: the files stay readable, and --resume goes on as if nothing had happened."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
KILLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "kills", "kills.py")
GARMENT = ["builtin:vest", "--set", "garment.resolution=0.05"]  # tangles at its seams
SHEET = ["builtin:sphere", "--set", "sheet.resolution=21", "--set", "solver.until=1"]
COMMON = ["--quiet", "--threads", "1", "--set", "output.picture=false", "--set", "output.checkpoint_interval=0.2"]


def command(folder, scene, *more):
    return [PROGRAM, "drape", *scene, *COMMON, "-o", folder, *more]


def run(folder, scene, *more):
    return subprocess.run(command(folder, scene, *more), capture_output=True, text=True, timeout=120)


def summary(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def frames(folder):
    with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
        return file["selvage/time"][()], file["selvage/positions"][()].astype(float)


def last_positions(folder):
    with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
        return file["selvage/positions"][-1].astype(float)


class Folder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def path(self, name, folder=None):
        return os.path.join(folder or self.folder, name)

    def check_committed_frames(self, folder):
        """Every trajectory that exists opens and holds as many finite frames as it says."""
        for name in ["run.h5", "sewing.h5"]:
            if not os.path.exists(self.path(name, folder)):
                continue
            with h5py.File(self.path(name, folder), "r") as file:
                root = file["VTKHDF"]
                frames, points = int(root["Steps"].attrs["NSteps"]), int(root["NumberOfPoints"][0])
                self.assertGreaterEqual(len(root["Points"]), frames * points)
                self.assertTrue(np.isfinite(root["Points"][:frames * points]).all())
                times = root["Steps/Values"][:frames]
                self.assertEqual(len(times), frames)
                self.assertTrue(np.all(np.diff(times) > 0), times)


class Killed(Folder):
    def test_runs_that_are_killed_and_resumed_again_and_again_end_bit_for_bit_as_those_left_alone(self):
        """The program of docs/resume.md with a few kills; by hand it is run with more."""
        result = subprocess.run([sys.executable, "-B", KILLS, "--kills", "9", "--scenes", "vest", "sheets", "hanging",
                                 "--small"], capture_output=True, text=True, timeout=300,
                                env={**os.environ, "SELVAGE": PROGRAM})
        print(result.stdout, end="")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        kills = [int(line.split(": ")[1].split()[0]) for line in result.stdout.splitlines()]
        self.assertEqual(kills, [3, 3, 3])

    def test_the_checkpoint_is_kept_until_the_summary_is_there(self):
        """A large picture makes the end of the run last long enough to look into the folder meanwhile."""
        scene = ["builtin:sphere", "--set", "sheet.resolution=9", "--set", "solver.until=1"]
        process = subprocess.Popen([*command(self.folder, scene, "--set", "output.checkpoint_interval=0"),
                                    "--set", "output.picture=true", "--set", "output.picture_width=3000"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        deadline = time.monotonic() + 60
        while not os.path.exists(self.path("checkpoint.h5")) and process.poll() is None:
            self.assertLess(time.monotonic(), deadline)
        self.assertIsNone(process.poll(), "the run ended before its checkpoint was seen")
        while os.path.exists(self.path("checkpoint.h5")) and process.poll() is None:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.002)
        ended = os.path.exists(self.path("summary.json"))
        process.wait(timeout=60)
        self.assertTrue(ended, "there was neither a checkpoint nor a summary: a kill then would have lost the run")


class Interrupted(Folder):
    def interrupt(self, scene, number, reached):
        """Sends the signal once the folder shows that the run got where it should be interrupted."""
        process = subprocess.Popen(command(self.folder, scene), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        deadline = time.monotonic() + 60
        while process.poll() is None and time.monotonic() < deadline and not reached():
            time.sleep(0.01)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 128 + number, errors)
        self.assertIn("resume", errors)
        self.assertEqual(summary(self.folder)["status"], "interrupted")
        self.assertTrue(os.path.exists(self.path("checkpoint.h5")))
        self.check_committed_frames(self.folder)

    def resume(self, scene):
        """Goes on from the checkpoint: where there is none, a run says that it starts from the beginning."""
        with open(self.path("progress.jsonl")) as file:
            before = len(file.readlines())
        result = run(self.folder, scene, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("from the beginning", result.stderr)
        with open(self.path("progress.jsonl")) as file:
            self.assertGreater(len(file.readlines()), before)

    def check_resumed(self, scene):
        before = summary(self.folder)
        self.resume(scene)
        after = summary(self.folder)
        self.assertGreater(after["simulated_s"], before["simulated_s"])
        self.assertGreater(after["wall_s"], before["wall_s"])
        self.assertFalse(os.path.exists(self.path("checkpoint.h5")))
        self.check_committed_frames(self.folder)
        reference = self.path("reference")
        result = run(reference, scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        times, positions = frames(self.folder)
        reference_times, reference_positions = frames(reference)
        np.testing.assert_array_equal(times, reference_times)
        np.testing.assert_array_equal(positions, reference_positions)
        for key, value in summary(reference).items():
            if key not in ["wall_s", "phases", "kernels", "peak_memory_bytes"]:
                self.assertEqual(after[key], value, key)

    def progressed(self, phase, steps):
        """Returns a question: has the run reported that many steps of the phase?"""
        def answer():
            if not os.path.exists(self.path("progress.jsonl")):
                return False
            with open(self.path("progress.jsonl")) as file:
                return file.read().count(f'"phase":"{phase}"') >= steps
        return answer

    def test_ctrl_c_while_sewing(self):
        self.interrupt(GARMENT, signal.SIGINT, self.progressed("sew", 5))
        self.check_resumed(GARMENT)

    def test_ctrl_c_while_pressing_the_seams(self):
        self.interrupt(GARMENT, signal.SIGINT, self.progressed("press", 1))
        self.check_resumed(GARMENT)

    def test_ctrl_c_while_draping(self):
        self.interrupt(SHEET, signal.SIGINT, self.progressed("drape", 10))
        self.check_resumed(SHEET)

    def check_bit_by_bit(self, *more):
        scene = ["builtin:hanging", "--set", "sheet.resolution=41", "--set", "solver.until=0.6",
                 "--set", "output.precision=lossless", *more]
        self.interrupt(scene, signal.SIGINT, self.progressed("drape", 5))
        self.resume(scene)
        result = run(self.path("reference"), scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        np.testing.assert_array_equal(last_positions(self.folder), last_positions(self.path("reference")))

    def test_integrators_with_a_memory_go_on_bit_by_bit(self):
        for name in ["bdf2", "central_difference", "velocity_verlet"]:
            with self.subTest(name), tempfile.TemporaryDirectory() as self.folder:
                self.check_bit_by_bit("--set", f"solver.integrator={name}")

    def test_bending_hysteresis_goes_on_bit_by_bit(self):
        self.check_bit_by_bit("--set", "bending.hysteresis=true", "--set", "sheet.fabric=matsudaira_cotton_broad")

    def test_a_cloth_that_sleeps_in_places_goes_on_bit_by_bit(self):
        """A sheet falls on a ball beside one that lies on the floor: the checkpoint is taken while that sleeps."""
        scene_file = self.path("places.toml")
        with open(scene_file, "w") as file:
            file.write("""
sheet = [{width = 0.8, height = 0.8, resolution = 33, fabric = "cotton", center = [-0.7, 0, 0.0012]},
         {width = 0.3, height = 0.3, resolution = 13, fabric = "cotton", center = [0.2, 0, 0.24]}]
body = [{name = "floor", shape = "plane"}, {name = "ball", shape = "sphere", radius = 0.1, center = [0.2, 0, 0.11]}]
solver = {until = "equilibrium"}
""")
        scene = [scene_file, "--set", "output.precision=lossless"]
        self.interrupt(scene, signal.SIGINT, self.progressed("drape", 15))
        with h5py.File(self.path("checkpoint.h5"), "r") as file:
            names = []
            file.visit(names.append)
        self.assertTrue(any(name.endswith("is_awake") for name in names), names)
        self.resume(scene)
        result = run(self.path("reference"), scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        np.testing.assert_array_equal(last_positions(self.folder), last_positions(self.path("reference")))

    def test_a_request_to_terminate(self):
        self.interrupt(SHEET, signal.SIGTERM, self.progressed("drape", 10))
        self.check_resumed(SHEET)

    def test_a_wall_time_limit_saves_and_can_be_resumed(self):
        result = run(self.folder, SHEET, "--set", "solver.max_wall=0.1")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(summary(self.folder)["status"], "time_limit")
        self.assertTrue(os.path.exists(self.path("checkpoint.h5")))
        self.resume(SHEET)
        self.assertEqual(summary(self.folder)["status"], "finished")

    def test_a_checkpoint_of_another_scene_is_refused(self):
        self.interrupt(SHEET, signal.SIGINT, self.progressed("drape", 5))
        result = run(self.folder, SHEET, "--resume", "--set", "sheet.fabric=silk")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("checkpoint.h5", result.stderr)
        self.assertIn("sheet[0].fabric is `silk`, was `", result.stderr)
        self.assertTrue(os.path.exists(self.path("summary.json")), "a refused resume removed the summary")

    def test_whatever_the_scene_says_is_looked_at(self):
        scene_file, ball = self.path("scene.toml"), self.path("ball.obj")

        def write(fabric="thickness = 0.0003", body="friction = 0.2", height=0.1):
            with open(ball, "w") as file:
                file.write(f"v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 {height}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
            with open(scene_file, "w") as file:
                file.write(f"""
sheet = [{{resolution = 9, fabric = "own", center = [0, 0, 0.5]}}]
fabric.own = {{base = "cotton", {fabric}}}
body = [{{mesh = "ball.obj", {body}}}]
solver = {{until = 0.2}}
""")
        write()
        result = run(self.path("out"), [scene_file], "--set", "output.keep_checkpoint=true")
        self.assertEqual(result.returncode, 0, result.stderr)
        more = ["--resume", "--set", "solver.until=0.3"]
        for key, change in [("fabric.own.thickness", {"fabric": "thickness = 0.0004"}),
                            ("fabric.own.bending_coupling", {"fabric": "thickness = 0.0003, bending_coupling = 1e-7"}),
                            ("fabric.own.bending_twist", {"fabric": "thickness = 0.0003, bending_twist = 1e-6"}),
                            ("body[0].friction", {"body": "friction = 0.4"}),
                            ("body[0].mesh.contents", {"height": 0.12})]:
            with self.subTest(key):
                write(**change)
                result = run(self.path("out"), [scene_file], *more)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(key + " is ", result.stderr)
        write()
        result = run(self.path("out"), [scene_file], "--set", "solver.step=0.01", *more)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("solver.step is `0.01`, was `0.02`", result.stderr)
        result = run(self.path("out"), [scene_file], "--set", "output.frames=false", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(summary(self.path("out"))["simulated_s"], 0.3)

    def test_a_frame_at_the_time_of_an_interruption_is_left_out_again(self):
        scene = [*SHEET, "--set", "solver.frame_rate=7"]
        self.interrupt(scene, signal.SIGTERM, self.progressed("drape", 10))
        self.resume(scene)
        times, _ = frames(self.folder)
        np.testing.assert_allclose(times, np.arange(8) / 7, atol=1e-12)


class WithoutCheckpoint(Folder):
    def contents(self):
        return {name: (os.stat(self.path(name)).st_mtime_ns, os.path.getsize(self.path(name)))
                for name in sorted(os.listdir(self.folder)) if name != "run.lock"}

    def test_a_run_that_has_ended_is_left_alone(self):
        for more in [[], ["--set", "output.keep_checkpoint=true"]]:
            with self.subTest(more):
                self.assertEqual(run(self.folder, SHEET, *more).returncode, 0)
                before = self.contents()
                result = run(self.folder, SHEET, *more, "--resume")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("nothing left to do", result.stderr)
                self.assertEqual(self.contents(), before)

    def test_a_run_that_has_ended_and_left_no_checkpoint_cannot_go_on_further(self):
        self.assertEqual(run(self.folder, SHEET).returncode, 0)
        before = self.contents()
        for change, word in [("solver.until=2", "keep_checkpoint"), ("sheet.fabric=silk", "sheet[0].fabric")]:
            result = run(self.folder, SHEET, "--resume", "--set", change)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(word, result.stderr)
        self.assertEqual(self.contents(), before)

    def test_a_run_that_never_started_starts_and_says_so(self):
        for quiet in [[], ["--quiet"]]:
            with self.subTest(quiet), tempfile.TemporaryDirectory() as folder:
                arguments = [word for word in command(folder, SHEET, "--resume") if word != "--quiet"] + quiet
                result = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("starts from the beginning", result.stderr)
                self.assertNotIn("replaces", result.stderr)
                self.assertEqual(summary(folder)["status"], "finished")

    def test_a_lost_checkpoint_is_said_to_cost_the_results(self):
        self.assertEqual(run(self.folder, SHEET, "--set", "solver.max_wall=0.1").returncode, 4)
        os.remove(self.path("checkpoint.h5"))
        result = run(self.folder, SHEET, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("replaces the results", result.stderr)


if __name__ == "__main__":
    unittest.main()
