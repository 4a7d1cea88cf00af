"""Runs the program as a user would and checks exit codes, messages and JSON output."""
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
COMMANDS = ["drape", "plan", "check", "render", "info", "styles", "scenes", "fabrics", "schema", "bench"]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=120)


class Usage(unittest.TestCase):
    def test_every_command_explains_itself_with_an_example(self):
        listed = run("--help").stdout
        for command in COMMANDS:
            with self.subTest(command):
                self.assertIn(command, listed)
                result = run(command, "--help")
                self.assertEqual(result.returncode, 0)
                self.assertIn("Example:\n  selvage " + command, result.stdout)

    def test_bad_usage_ends_with_2_and_names_the_nearest_valid_word(self):
        for arguments, nearest in [
            (["drpae"], "drape"),
            (["drape", "--thread", "2"], "--threads"),
            (["bench", "kernel"], "kernels"),
            (["plan", "builtin:sphre"], "sphere"),
            (["plan", "builtin:sphere", "--set", "solver.stp=1"], "step"),
            (["plan", "builtin:sphere", "--set", "sheet.fabric=coton"], "cotton"),
        ]:
            with self.subTest(arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("did you mean", result.stderr)
                self.assertIn(nearest, result.stderr)
                self.assertEqual(result.stdout, "")

    def test_a_fault_in_a_scene_file_is_named_with_file_line_and_key(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.toml")
            with open(path, "w") as file:
                file.write("[[sheet]]\nwidth = 1\n\n[solver]\nstep = -1\n")
            result = run("plan", path)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("bad.toml:5:", result.stderr)
            self.assertIn("solver.step", result.stderr)

    def test_a_missing_file_ends_with_2(self):
        for command in ["drape", "plan", "check", "info", "render"]:
            with self.subTest(command):
                result = run(command, "no/such/file")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("no/such/file", result.stderr)


class MachineReadable(unittest.TestCase):
    def test_scenes_list_what_the_contract_names(self):
        scenes = json.loads(run("scenes", "--json").stdout)
        self.assertLessEqual({"tshirt", "vest", "sphere", "cusick", "cantilever", "hanging"},
                             {scene["name"] for scene in scenes})
        for scene in scenes:
            self.assertTrue(scene["summary"])
            self.assertIsInstance(scene["parameters"], list)

    def test_schema_and_plan_are_json(self):
        json.loads(run("schema", "--json").stdout)
        json.loads(run("plan", "builtin:sphere", "--json").stdout)

    def test_validation_prints_what_the_contract_names_and_knows_its_cases(self):
        cases = json.loads(run("validate", "--json", "stretch").stdout)["cases"]
        self.assertGreater(len(cases), 20)
        for case in cases:
            self.assertLessEqual({"case", "quantity", "reference", "measured", "error", "tolerance", "pass", "source"},
                                 set(case))
            self.assertTrue(case["pass"], case)
        wrong = run("validate", "strech")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("stretch", wrong.stderr)

    def test_every_fabric_has_a_source(self):
        fabrics = json.loads(run("fabrics", "--json").stdout)
        self.assertIn("cotton", {fabric["name"] for fabric in fabrics})
        for fabric in fabrics:
            self.assertTrue(fabric["source"], fabric["name"])


class Interruption(unittest.TestCase):
    def test_a_signal_saves_the_state_and_the_run_can_go_on(self):
        with tempfile.TemporaryDirectory() as folder:
            arguments = ["drape", "builtin:hanging", "-o", folder, "--set", "sheet.resolution=17"]
            process = subprocess.Popen([PROGRAM, *arguments, "--set", "solver.until=10000"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            deadline = time.monotonic() + 60
            while process.poll() is None and time.monotonic() < deadline:
                if os.path.exists(os.path.join(folder, "run.h5")):
                    break
                time.sleep(0.05)
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130, errors)
            with open(os.path.join(folder, "summary.json")) as file:
                summary = json.load(file)
            self.assertEqual(summary["status"], "interrupted")
            reached = summary["simulated_s"]

            result = run(*arguments, "--resume", "--set", f"solver.until={reached + 0.2:.3f}")
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(os.path.join(folder, "summary.json")) as file:
                self.assertGreater(json.load(file)["simulated_s"], reached)


if __name__ == "__main__":
    unittest.main()
