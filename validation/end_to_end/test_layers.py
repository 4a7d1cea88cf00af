"""The rooms of the project depend on each other one way only, and each package stays in its place."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = [path for room in ("kernels", "io", "host", "bench", "validation") for path in (ROOT / room).rglob("*")
           if path.suffix in (".h", ".hpp", ".cpp", ".def")]

# What may include a header whose name matches: folders, or single files.
PLACES = {
    r"^(tbb|oneapi)/": ["host", "bench", "validation"],
    r"^embree": ["host/collision", "host/render", "bench/suites/embree_pairs.cpp"],
    r"^(hdf5|H5)": ["io", "validation/unit/io/test_trajectory.cpp"],
    r"^opencv": ["io/image.cpp", "bench/harness/chart.cpp"],
    r"^(Eigen|unsupported)/": ["io", "host", "bench", "validation"],
    r"^toml\+\+/": ["io"],
    r"^CLI/": ["host/main.cpp", "host/commands", "bench/bench_command.cpp", "validation/validate_command.cpp"],
    r"^catch2/": ["validation/unit"],
    r"^benchmark/": ["bench"],
    r"^host/": ["host", "bench", "validation"],
    r"^bench/": ["bench", "host/main.cpp", "validation"],
    r"^io/": ["io", "host", "bench", "validation"],
    r"^validation/": ["validation", "host/main.cpp"],
}


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        if match:
            yield number, match.group(1)


class Layers(unittest.TestCase):
    def test_every_include_is_allowed_where_it_stands(self):
        self.assertGreater(len(SOURCES), 100)
        for path in SOURCES:
            here = path.relative_to(ROOT).as_posix()
            for number, header in includes(path):
                for pattern, places in PLACES.items():
                    if re.match(pattern, header):
                        allowed = any(here == place or here.startswith(place + "/") for place in places)
                        self.assertTrue(allowed, f"{here}:{number} includes {header}")

    def test_kernels_include_nothing_but_themselves_and_cmath(self):
        for path in (ROOT / "kernels").rglob("*.h"):
            for number, header in includes(path):
                own = (path.parent / header).resolve().is_relative_to(ROOT / "kernels") and (path.parent / header).exists()
                self.assertTrue(own or header == "cmath", f"{path.name}:{number} includes {header}")


if __name__ == "__main__":
    unittest.main()
