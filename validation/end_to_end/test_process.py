"""The process and its files: descriptors, signals, one run a folder, full disks, folders that move."""
import glob
import json
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM = os.path.abspath(os.environ.get("SELVAGE", "build/selvage"))
SMALL = ["builtin:hanging", "--set", "sheet.resolution=9", "--set", "output.checkpoint_interval=0", "--threads", "1",
         "--set", "output.picture=false"]
TIMED = [*SMALL, "--set", "solver.until=0.2"]
ENDLESS = [*SMALL, "--set", "solver.until=100000"]

# A disk that is full after FULL_AFTER bytes, and one without locks.
SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
static long left = -1;
static long room(int descriptor, size_t size)
{
    struct stat status;
    const char* most = getenv("FULL_AFTER");
    if (!most || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return size;
    if (left < 0) left = atol(most);
    const long part = left < (long)size ? left : (long)size;
    left -= part;
    return part;
}
ssize_t write(int descriptor, const void* data, size_t size)
{
    const long part = room(descriptor, size);
    if (size > 0 && part == 0) { errno = ENOSPC; return -1; }
    return ((ssize_t (*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write"))(descriptor, data, part);
}
ssize_t pwrite(int descriptor, const void* data, size_t size, off_t address)
{
    const long part = room(descriptor, size);
    if (size > 0 && part == 0) { errno = ENOSPC; return -1; }
    return ((ssize_t (*)(int, const void*, size_t, off_t))dlsym(RTLD_NEXT, "pwrite"))(descriptor, data, part, address);
}
ssize_t pwrite64(int descriptor, const void* data, size_t size, off_t address)
{
    return pwrite(descriptor, data, size, address);
}
int flock(int descriptor, int operation)
{
    if (getenv("NO_LOCKS")) { errno = ENOLCK; return -1; }
    return ((int (*)(int, int))dlsym(RTLD_NEXT, "flock"))(descriptor, operation);
}
"""


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], **{"capture_output": True, "text": True, "timeout": 60, **options})


class Folder(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = holder.name
        self.folder = self.path("out")

    def path(self, *names):
        return os.path.join(self.root, *names)

    def start(self, *arguments, folder=None, **options):
        """Starts a run and waits until it has committed some frames."""
        folder = folder or self.folder
        process = subprocess.Popen([PROGRAM, "drape", *arguments, "-o", folder],
                                   **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True, **options})
        self.addCleanup(lambda: (process.poll() is None and process.kill(), process.wait(), process.stderr.close()))
        self.wait_for(process, lambda: len(self.lines(folder)) > 20)
        return process

    def wait_for(self, process, reached, seconds=30):
        deadline = time.monotonic() + seconds
        while not reached():
            self.assertIsNone(process.poll(), "the run has ended")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)

    def lines(self, folder):
        try:
            with open(os.path.join(folder, "progress.jsonl")) as file:
                return file.readlines()
        except FileNotFoundError:
            return []

    def frames(self, folder):
        """Returns the number of committed frames, after a look at all of them; -1 without a file."""
        if not os.path.exists(os.path.join(folder, "run.h5")):
            return -1
        with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
            count, points = int(file["VTKHDF/Steps"].attrs["NSteps"]), int(file["VTKHDF/NumberOfPoints"][0])
            positions = file["VTKHDF/Points"][:count * points]
            self.assertEqual(len(positions), count * points)
            self.assertTrue(np.isfinite(positions).all())
            self.assertTrue((np.diff(file["selvage/time"][:count]) > 0).all())
            return count

    def summary(self, folder):
        with open(os.path.join(folder, "summary.json")) as file:
            return json.load(file)


class Descriptors(Folder):
    def test_a_run_without_standard_streams_leaves_whole_files(self):
        def close_all():
            for descriptor in range(3):
                os.close(descriptor)
        result = run("drape", *TIMED, "-o", self.folder, preexec_fn=close_all)
        self.assertEqual(result.returncode, 0)
        self.assertGreater(self.frames(self.folder), 3)
        for line in self.lines(self.folder):
            json.loads(line)

    def test_a_run_without_stderr_leaves_whole_files(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.folder, preexec_fn=lambda: os.close(2)).returncode, 0)
        self.assertGreater(self.frames(self.folder), 3)
        for line in self.lines(self.folder):
            json.loads(line)

    def test_results_that_cannot_be_printed_are_missed(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.folder).returncode, 0)
        for command in [["info", self.path("out", "run.h5")], ["check", "builtin:hanging", "--json"], ["--version"],
                        ["plan", "builtin:hanging"], ["scenes"], ["fabrics", "--json"], ["schema"], ["drape", "--help"],
                        ["drape", *TIMED, "-o", self.path("json"), "--json"]]:
            with self.subTest(command), open("/dev/full", "w") as full:
                result = run(*command, capture_output=False, stdout=full, stderr=subprocess.PIPE)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("stdout: found No space left on device", result.stderr)
        result = run("scenes", capture_output=False, stderr=subprocess.PIPE, preexec_fn=lambda: os.close(1))
        self.assertEqual((result.returncode, "stdout" in result.stderr), (2, True), result.stderr)

    def test_a_reader_that_has_gone_is_missed_where_no_signal_tells_of_it(self):
        reader, writer = os.pipe()
        os.close(reader)
        result = run("scenes", capture_output=False, stdout=writer, stderr=subprocess.PIPE, restore_signals=False,
                     preexec_fn=lambda: signal.signal(signal.SIGPIPE, signal.SIG_IGN))
        os.close(writer)
        self.assertEqual((result.returncode, "Broken pipe" in result.stderr), (2, True), result.stderr)


class OneRunAFolder(Folder):
    def test_a_second_run_is_refused_and_the_first_goes_on(self):
        process = self.start(*ENDLESS)
        for more in [], ["--resume"], ["--set", "sheet.resolution=5"]:
            began = time.monotonic()
            result = run("drape", *ENDLESS, "-o", self.folder, *more)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(f"process {process.pid}", result.stderr)
            self.assertIn("-o", result.stderr)
            self.assertLess(time.monotonic() - began, 5)
        for command in ["info", "render"] * 2:
            result = run(command, self.path("out", "run.h5"))
            self.assertEqual(result.returncode, 0, result.stderr)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=30), 143)
        self.assertEqual(self.summary(self.folder)["vertices"], 81)
        self.assertFalse(os.path.exists(self.path("out", "run.lock")))

    def test_a_kill_leaves_no_lock_and_the_next_run_clears_up(self):
        process = self.start(*ENDLESS)
        process.kill()
        process.wait()
        for name in ["run.h5.0123456789ab.partial", "checkpoint.h5.partial"]:
            open(self.path("out", name), "w").close()
        open(self.path("out", "notes.partial"), "w").close()
        result = run("drape", *TIMED, "-o", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([os.path.basename(name) for name in glob.glob(self.path("out", "*.partial"))],
                         ["notes.partial"])
        self.assertFalse(os.path.exists(self.path("out", "run.lock")))

    def test_a_run_that_has_ended_is_told_again_also_in_a_folder_that_is_held(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.folder).returncode, 0)
        os.mkdir(self.path("out", "run.lock"))      # nothing is to be written, so that nothing has to be held
        result = run("drape", *TIMED, "-o", self.folder, "--resume", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["status"], "finished")

    def test_a_refused_scene_leaves_no_folder(self):
        result = run("drape", *TIMED, "-o", self.folder, "--set", "solver.memory_limit=1000")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertFalse(os.path.exists(self.folder))


class Links(Folder):
    def test_no_file_of_a_run_is_written_through_a_link(self):
        victim, names = self.path("victim"), ["progress.jsonl", "preview.png", "run.h5", "run.h5.partial", "final.obj",
                                              "summary.json", "checkpoint.h5", "checkpoint.h5.partial", "run.xdmf"]
        with open(victim, "w") as file:
            file.write("untouched")
        os.mkdir(self.folder)
        for name in names:
            os.symlink(victim, self.path("out", name))
        scene = [*TIMED, "--set", "output.picture=true", "--set", "output.picture_width=64"]
        result = run("drape", *scene, "-o", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(victim) as file:
            self.assertEqual(file.read(), "untouched")
        for name in names:
            self.assertFalse(os.path.islink(self.path("out", name)), name)

    def test_a_lock_that_is_a_link_is_refused(self):
        os.mkdir(self.folder)
        os.symlink(self.path("victim"), self.path("out", "run.lock"))
        result = run("drape", *TIMED, "-o", self.folder)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("run.lock", result.stderr)
        self.assertIn("symbolic link", result.stderr)
        self.assertFalse(os.path.exists(self.path("victim")))


class Signals(Folder):
    def stopped(self, process, number, folder=None):
        folder = folder or self.folder
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 128 + number, errors)
        self.assertEqual(self.summary(folder)["status"], "interrupted")
        self.assertTrue(os.path.exists(os.path.join(folder, "checkpoint.h5")))
        self.assertEqual(self.frames(folder), self.summary(folder)["frames"])
        return self.summary(folder)["simulated_s"]

    def test_a_closed_terminal_and_a_time_limit_save_the_run(self):
        for number in signal.SIGHUP, signal.SIGXCPU, signal.SIGTERM:
            with self.subTest(number):
                folder = self.path(f"out{number}")
                process = self.start(*ENDLESS, folder=folder)
                # The kernel repeats SIGXCPU, a shell SIGHUP; `timeout` signals the process and its group.
                process.send_signal(number)
                process.send_signal(number)
                reached = self.stopped(process, number, folder)
                until = ["--set", f"solver.until={reached + 0.1:.3f}"]
                result = run("drape", *SMALL, *until, "-o", folder, "--resume")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertGreater(self.summary(folder)["simulated_s"], reached)

    def test_who_asks_a_run_to_end_after_its_time_limit_asks_for_the_first_time(self):
        """Batch systems send SIGXCPU or SIGHUP, and SIGTERM later: only a second request ends a run at once."""
        large = ["--set", "output.picture=true", "--set", "output.picture_width=16384", "--set",
                 "output.picture_samples=64"]      # so that the run takes a while to end
        process = self.start(*ENDLESS, *large)
        process.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        self.stopped(process, signal.SIGHUP)

    def test_a_closed_pipe_saves_the_run(self):
        process = self.start(*ENDLESS)
        process.stderr.close()     # the next line of progress finds no reader
        self.assertEqual(process.wait(timeout=30), 128 + signal.SIGPIPE)
        self.assertEqual(self.summary(self.folder)["status"], "interrupted")
        self.assertTrue(os.path.exists(self.path("out", "checkpoint.h5")))

    def test_below_nohup_a_closed_terminal_is_no_matter(self):
        process = self.start(*ENDLESS, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        before = len(self.lines(self.folder))
        process.send_signal(signal.SIGHUP)
        self.wait_for(process, lambda: len(self.lines(self.folder)) > before + 20)
        process.send_signal(signal.SIGTERM)
        self.stopped(process, signal.SIGTERM)

    def test_a_signal_breaks_a_picture_off_and_the_run_can_be_resumed(self):
        large = ["--set", "output.picture=true", "--set", "output.picture_width=16384", "--set",
                 "output.picture_samples=64"]
        process = subprocess.Popen([PROGRAM, "drape", *TIMED, *large, "-o", self.folder], stderr=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        self.wait_for(process, lambda: os.path.exists(self.path("out", "final.obj")))
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        began = time.monotonic()
        self.stopped(process, signal.SIGTERM)
        self.assertLess(time.monotonic() - began, 10)
        self.assertFalse(os.path.exists(self.path("out", "preview.png")))
        result = run("drape", *TIMED, "--set", "output.picture=true", "--set", "output.picture_width=64", "-o",
                     self.folder, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(os.path.exists(self.path("out", "preview.png")))


class Disks(Folder):
    def shim(self, **variables):
        library = self.path("shim.so")
        if not os.path.exists(library):
            with open(self.path("shim.c"), "w") as file:
                file.write(SHIM)
            compiler = next((name for name in ["cc", "gcc", "c++", "g++"] if shutil.which(name)), None)
            language = ["-x", "c"]
            subprocess.run([compiler, *language, "-shared", "-fPIC", "-o", library, self.path("shim.c"), "-ldl"],
                           check=True)
        return {**os.environ, "LD_PRELOAD": library, **variables}

    def check_failed(self, result, folder, words):
        self.assertEqual(result.returncode, 2, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(os.path.exists(os.path.join(folder, "summary.json")))
        self.assertEqual(glob.glob(os.path.join(folder, "*.partial")), [])
        for line in self.lines(folder):
            json.loads(line)
        return self.frames(folder)

    def check_resumed(self, folder, result):
        """A run that names its checkpoint goes on from it, now with room, to the end of one that always had room."""
        if not os.path.exists(os.path.join(folder, "checkpoint.h5")):
            return False
        self.assertIn("--resume", result.stderr)
        again = run("drape", *TIMED, "-o", folder, "--resume")
        self.assertEqual(again.returncode, 0, again.stderr)
        with h5py.File(os.path.join(folder, "run.h5")) as one, h5py.File(self.path("whole", "run.h5")) as other:
            self.assertTrue((one["selvage/positions"][-1] == other["selvage/positions"][-1]).all())
        return True

    def test_a_full_disk_is_told_wherever_it_comes_and_frames_so_far_stay(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.path("whole")).returncode, 0)
        most, resumed = -1, 0
        for room in 0, 1000, 20000, 100000, 250000, 500000, 1000000, 2000000:
            folder = self.path(f"full{room}")
            result = run("drape", *TIMED, "-o", folder, env=self.shim(FULL_AFTER=str(room)))
            if result.returncode == 0:
                break
            with self.subTest(room):
                words = ["No space left on device", "free some", "-o"]
                most = max(most, self.check_failed(result, folder, words))
                resumed += self.check_resumed(folder, result)
        self.assertGreater(most, 1, "no run came to its second frame")
        self.assertGreater(resumed, 0, "no run came to a checkpoint")

    def test_a_limit_of_file_size_is_told_instead_of_a_signal(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.path("whole")).returncode, 0)
        whole = self.frames(self.path("whole"))
        counts = []
        size = os.path.getsize(self.path("whole", "run.h5"))
        for part in 0.3, 0.9, 0.95:
            limit, folder = int(part * size), self.path(f"limited{part}")
            result = run("drape", *TIMED, "-o", folder,
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            with self.subTest(part):
                counts.append(self.check_failed(result, folder, ["File too large", "ulimit -f"]))
                self.check_resumed(folder, result)
        self.assertEqual(counts, sorted(counts))
        self.assertTrue(any(0 < count < whole for count in counts), counts)

    def test_a_file_system_without_locks_is_told_and_everything_works(self):
        without = self.shim(NO_LOCKS="1")
        for more in [], ["--resume"]:
            result = run("drape", *TIMED, "-o", self.folder, "--set", "output.keep_checkpoint=true", *more, env=without)
            self.assertEqual(result.returncode, 0, result.stderr)
            if "No locks available" not in result.stderr:
                self.assertIn("--resume", more)
        for command in ["info", "render"]:
            result = run(command, self.path("out", "run.h5"), env=without)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_run_follows_its_folder(self):
        process = self.start(*ENDLESS)
        moved = self.path("elsewhere")
        os.rename(self.folder, moved)
        before = len(self.lines(moved))
        self.wait_for(process, lambda: len(self.lines(moved)) > before + 20)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 143, errors)
        self.assertIn(moved, errors)
        self.assertEqual(self.summary(moved)["frames"], self.frames(moved))
        self.assertFalse(os.path.exists(self.folder))

    def test_a_run_whose_folder_is_removed_says_so(self):
        process = self.start(*ENDLESS)
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.rmtree(self.folder, ignore_errors=True)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 2, errors)
        self.assertIn(self.folder, errors)
        self.assertIn("gone", errors)

    def test_a_picture_replaces_its_file_only_when_it_is_whole(self):
        self.assertEqual(run("drape", *TIMED, "-o", self.folder).returncode, 0)
        picture = self.path("out", "picture.png")
        with open(picture, "w") as file:
            file.write("old")
        render = ["render", self.path("out", "run.h5"), "--width", "64", "-o"]
        result = run(*render, picture, env=self.shim(FULL_AFTER="100"))
        self.assertEqual((result.returncode, "No space left" in result.stderr), (2, True), result.stderr)
        with open(picture) as file:
            self.assertEqual(file.read(), "old")
        result = run(*render, "/dev/full")
        self.assertEqual((result.returncode, "No space left" in result.stderr), (2, True), result.stderr)
        self.assertEqual(run(*render, "/dev/stdout", text=False).stdout[:4], b"\x89PNG")


if __name__ == "__main__":
    unittest.main()
