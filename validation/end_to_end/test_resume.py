"""Kills runs at random moments: the files stay readable, and --resume arrives where an uninterrupted run does."""
import json
import os
import random
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
# Sewn with contact, this coarse vest tangles at its seams, and resumes of tangled cloth are not exact: they end up to
# 6 mm away. test_contact.py kills and resumes layers in contact.
GARMENT = ["builtin:vest", "--set", "garment.resolution=0.04", "--set", "contact.self=false"]
SHEET = ["builtin:sphere", "--set", "sheet.resolution=21", "--set", "solver.until=1"]
COMMON = ["--quiet", "--threads", "1", "--set", "output.picture=false", "--set", "output.checkpoint_interval=0.2"]
CLOSE = 1e-3   # [m]


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
    """Runs that are killed, resumed, and killed again while they resume."""

    def start_and_kill(self, folder, scene, wait, *more):
        """Returns whether the run was killed before it had ended, which its summary tells."""
        process = subprocess.Popen(command(folder, scene, *more), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        try:
            _, errors = process.communicate(timeout=wait)
            self.assertEqual(process.returncode, 0, errors)
            return False
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.communicate()
            return not os.path.exists(self.path("summary.json", folder))

    def check_kills(self, scene, kills, seed):
        reference = self.path("reference")
        began = time.monotonic()
        result = run(reference, scene)
        duration = time.monotonic() - began
        self.assertEqual(result.returncode, 0, result.stderr)
        moments = random.Random(seed)
        done, before_first_checkpoint, worst, runs = 0, 0, 0.0, 0
        while done < kills:
            folder, more = self.path(f"run{runs}"), []
            runs += 1
            for _ in range(4):
                if done == kills or not self.start_and_kill(folder, scene, moments.uniform(0, duration), *more):
                    break
                done += 1
                self.check_committed_frames(folder)
                more = ["--resume"] if os.path.exists(self.path("checkpoint.h5", folder)) else []
                if not more:
                    before_first_checkpoint += 1
                    refused = run(folder, scene, "--resume")
                    self.assertEqual(refused.returncode, 2, refused.stderr)
                    self.assertIn("checkpoint.h5", refused.stderr)
            if not os.path.exists(self.path("summary.json", folder)):
                result = run(folder, scene, *more)
                self.assertEqual(result.returncode, 0, result.stderr)
            self.check_committed_frames(folder)
            self.assertEqual(summary(folder)["status"], summary(reference)["status"])
            worst = max(worst, np.abs(last_positions(folder) - last_positions(reference)).max())
        self.assertLess(before_first_checkpoint, kills, "no kill came after a checkpoint")
        print(f"{scene[0]}: {done} kills, {before_first_checkpoint} before the first checkpoint; "
              f"resumed and uninterrupted runs differ by at most {worst:.2e} m")
        self.assertLess(worst, CLOSE)

    def test_a_garment_survives_kills_while_it_is_sewn_and_draped(self):
        self.check_kills(GARMENT, kills=14, seed=1)

    def test_a_sheet_survives_kills(self):
        self.check_kills(SHEET, kills=6, seed=2)

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

    def check_resumed(self, scene):
        before = summary(self.folder)
        result = run(self.folder, scene, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        after = summary(self.folder)
        self.assertIn(after["status"], ["converged", "finished"])
        self.assertGreater(after["simulated_s"], before["simulated_s"])
        self.assertGreater(after["wall_s"], before["wall_s"])
        self.assertFalse(os.path.exists(self.path("checkpoint.h5")))
        self.check_committed_frames(self.folder)
        reference = self.path("reference")
        result = run(reference, scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        times, positions = frames(self.folder)
        reference_times, reference_positions = frames(reference)
        self.assertLess(np.abs(positions[-1] - reference_positions[-1]).max(), CLOSE)
        # The frame that an interrupted run ends with may be an extra one, but must not show a wrong moment.
        for time_, expected in zip(reference_times, reference_positions):
            nearest = np.argmin(np.abs(times - time_))
            self.assertAlmostEqual(times[nearest], time_, delta=1e-6, msg="a frame of the uninterrupted run is missing")
            self.assertLess(np.abs(positions[nearest] - expected).max(), CLOSE, f"the frame at {time_:.4f} s")

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
        result = run(self.folder, scene, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
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
        result = run(self.folder, scene, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
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
        result = run(self.folder, SHEET, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(summary(self.folder)["status"], "finished")

    def test_a_checkpoint_of_another_scene_is_refused(self):
        self.interrupt(SHEET, signal.SIGINT, self.progressed("drape", 5))
        result = run(self.folder, SHEET, "--resume", "--set", "sheet.fabric=silk")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("checkpoint.h5", result.stderr)
        self.assertTrue(os.path.exists(self.path("summary.json")), "a refused resume removed the summary")


if __name__ == "__main__":
    unittest.main()
