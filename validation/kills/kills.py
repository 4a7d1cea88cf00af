#!/usr/bin/env python3
"""Kills runs with SIGKILL at random moments, resumes them, and kills the resumed runs again.

A run that leaves a checkpoint must go on from it. After each kill every frame that run.h5 and sewing.h5 hold must be
readable by h5py and equal, bit for bit, to that of a run which nobody has killed; at the end all frames and all of
summary.json but what measures the machine must be equal.

    python3 -B validation/kills/kills.py --kills 100 --seed 1

prints a line for each scene and exits with 1 if anything differed. SELVAGE names the program.
"""
import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
SHEETS = """
sheet = [{width = 0.5, height = 0.5, resolution = 21, center = [0, 0, 0.16]},
         {width = 0.4, height = 0.4, resolution = 17, center = [0.03, 0.02, 0.19], rotation = [7, 0, 20]}]
body = [{shape = "sphere", radius = 0.12, center = [0, 0, 0]}]
solver = {until = 0.8}
"""
# What is sewn, pressed and draped with contact; what falls on itself; what grows from coarse meshes to its own; a
# garment that is sewn on a coarse mesh.
SCENES = {
    "vest": ["builtin:vest", "--set", "garment.resolution=0.05", "--set", "solver.max_time=2"],
    "sheets": ["sheets.toml"],
    "hanging": ["builtin:hanging", "--set", "sheet.resolution=129"],
    "growing": ["builtin:vest", "--set", "garment.resolution=0.0062", "--set", "solver.max_time=0.1"],
}
SMALL = {  # for a test that has to be quick
    "vest": ["builtin:vest", "--set", "garment.resolution=0.07", "--set", "solver.max_time=1"],
    "sheets": ["sheets.toml", "--set", "sheet.resolution=11"],
    "hanging": ["builtin:hanging", "--set", "sheet.resolution=65"],
}
MEASURED = ["wall_s", "phases", "kernels", "peak_memory_bytes"]  # of the machine, not of the cloth
MOST_KILLS_OF_A_RUN = 6


def command(scene, folder, threads, *more):
    return [PROGRAM, "drape", *scene, "-o", folder, "--quiet", "--threads", str(threads), "--set",
            "output.picture=false", "--set", "output.precision=lossless", "--set", "output.checkpoint_interval=0.1",
            *more]


def frames(path):
    """The committed frames of a trajectory: times, positions, and scalars but for the wall time."""
    if not os.path.exists(path):
        return None
    with h5py.File(path, "r") as file:
        steps = file["VTKHDF/Steps"]
        count, points = int(steps.attrs["NSteps"]), int(file["VTKHDF/NumberOfPoints"][0])
        found = {"time": steps["Values"][:count],
                 "positions": file["VTKHDF/Points"][:count * points].reshape(count, points, 3)}
        for name, data in file["selvage"].items():
            if isinstance(data, h5py.Dataset) and name not in ["positions", "triangles", "seam_pairs", "wall_seconds"]:
                if data.shape and len(data) >= count and data.ndim == 1:
                    found[name] = data[:count]
        return found


def differing(found, reference):
    """Names what differs from the first frames of the reference."""
    count = len(found["time"])
    if count > len(reference["time"]):
        return ["more frames"]
    return [name for name, values in found.items()
            if not np.array_equal(values, reference[name][:count], equal_nan=values.dtype.kind == "f")]


def summary(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        held = json.load(file)
    for name in MEASURED:
        held.pop(name, None)
    for stage in held.get("coarse_start", []):
        stage.pop("seconds", None)
        stage.pop("wall_s", None)
    return held


class Scene:
    def __init__(self, name, arguments, root, threads):
        self.name, self.root, self.threads = name, root, threads
        sheets = os.path.join(root, "sheets.toml")
        with open(sheets, "w") as file:
            file.write(SHEETS)
        self.arguments = [sheets if word == "sheets.toml" else word for word in arguments]
        self.kills, self.faults, self.resumed = 0, [], 0
        began = time.monotonic()
        self.whole = os.path.join(root, name + "_whole")
        result = subprocess.run(command(self.arguments, self.whole, threads), capture_output=True, text=True)
        if result.returncode not in [0, 4]:
            sys.exit(f"{name}: exit code {result.returncode}: {result.stderr}")
        self.code, self.duration = result.returncode, time.monotonic() - began
        self.reference = {file: frames(os.path.join(self.whole, file)) for file in ["run.h5", "sewing.h5"]}

    def check(self, folder, at_end):
        for file, reference in self.reference.items():
            try:
                found = frames(os.path.join(folder, file))
            except Exception as error:  # whatever h5py says of a damaged file
                self.faults.append(f"{file}: {error!r}")
                continue
            if found is None:
                continue
            self.faults += [f"{file}: {name}" for name in differing(found, reference)]
            if at_end and len(found["time"]) != len(reference["time"]):
                self.faults.append(f"{file}: {len(found['time'])} frames of {len(reference['time'])}")

    def kill_runs(self, kills, moments):
        run = 0
        while self.kills < kills:
            folder = os.path.join(self.root, f"{self.name}{run}")
            run += 1
            for _ in range(MOST_KILLS_OF_A_RUN):
                if self.kills == kills or not self.start_and_kill(folder, moments.uniform(0, self.duration)):
                    break
                self.check(folder, False)
            self.finish(folder)

    def start_and_kill(self, folder, wait):
        """Returns whether the run was killed before it had ended."""
        checkpoint = os.path.exists(os.path.join(folder, "checkpoint.h5"))
        process = subprocess.Popen(command(self.arguments, folder, self.threads, "--resume"),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            _, errors = process.communicate(timeout=wait)
        except subprocess.TimeoutExpired:
            process.kill()
            _, errors = process.communicate()
            self.note_start(checkpoint, errors)
            self.kills += 1
            return True
        self.note_start(checkpoint, errors)
        if process.returncode != self.code:
            self.faults.append(f"exit code {process.returncode}: {errors}")
        return False

    def note_start(self, checkpoint, errors):
        if checkpoint and "from the beginning" in errors:
            self.faults.append("a run that did not go on from its checkpoint")
        self.resumed += checkpoint

    def finish(self, folder):
        checkpoint = os.path.exists(os.path.join(folder, "checkpoint.h5"))
        result = subprocess.run(command(self.arguments, folder, self.threads, "--resume"), capture_output=True,
                                text=True)
        if result.returncode != self.code:
            self.faults.append(f"exit code {result.returncode}: {result.stderr}")
            return
        self.note_start(checkpoint, result.stderr)
        self.check(folder, True)
        ours, theirs = summary(folder), summary(self.whole)
        self.faults += [f"summary: {key}" for key in theirs if ours.get(key) != theirs[key]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--kills", type=int, default=100, help="in all, divided among the scenes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--small", action="store_true", help="smaller scenes")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, help="all, or all that there are in small, if left out")
    arguments = parser.parse_args()
    scenes = SMALL if arguments.small else SCENES
    names = arguments.scenes or list(scenes)
    moments = random.Random(arguments.seed)
    faults, resumed = 0, 0
    for k, name in enumerate(names):
        share = arguments.kills * (k + 1) // len(names) - arguments.kills * k // len(names)
        with tempfile.TemporaryDirectory() as root:
            scene = Scene(name, scenes[name], root, arguments.threads)
            scene.kill_runs(share, moments)
        print(f"{name}: {scene.kills} kills within {scene.duration:.1f} s each, {scene.resumed} starts from a "
              f"checkpoint, {len(scene.faults)} faults {sorted(set(scene.faults))}", flush=True)
        faults += len(scene.faults)
        resumed += scene.resumed
    if arguments.kills > 0 and resumed == 0:
        sys.exit("no run went on from a checkpoint: nothing has been shown")
    sys.exit(faults > 0)


if __name__ == "__main__":
    main()
