"""Folders include only lower layers, units form no circles, and packages stay in their places."""
import re
import unittest
from typing import NamedTuple, Optional

from sources import Sources, folder_of, reached_from, read_sources

# The layers of the project, lowest first. A file may include headers of its own folder and of lower layers; folders of
# one layer do not know each other. A new folder gets its place here, or in INNER_LAYERS if it lies in one listed there.
LAYERS = [
    ["kernels", "io"],                      # kernels: all folders below it count as one
    ["host/parallel", "host/embree"],
    ["host/model", "host/render"],
    ["host/mesh"],
    ["host/collision", "host/mannequin", "host/body"],
    ["host/solver", "host/garment"],
    ["host/styles"],
    ["host/examine"],
    ["host/scene"],
    ["host/run"],
    ["host/commands"],
    ["bench"],
    ["validation"],
    ["host"],                               # main.cpp
]
# Entries of the table above that have layers of their own, under the same rule.
INNER_LAYERS = {
    "io": [["io"], ["io/mesh", "io/scene", "io/run"], ["io/pattern"]],
    "host/solver": [["host/solver/state"], ["host/solver/terms"], ["host/solver/linear", "host/solver/contact"],
                    ["host/solver/stepping"], ["host/solver/stepping/integrators"]],
    "host/styles": [["host/styles/blocks"], ["host/styles"]],
    "bench": [["bench/harness"], ["bench/accuracy", "bench/suites"], ["bench"]],
    "validation": [["validation/measure"], ["validation/cases"], ["validation"], ["validation/unit"],
                   ["validation/unit/collision", "validation/unit/contact", "validation/unit/garment",
                    "validation/unit/io", "validation/unit/run", "validation/unit/solver"],
                   ["validation/fuzz"]],
}


class Package(NamedTuple):
    headers: str                            # pattern of how its headers begin
    includers: list                         # files and folders that may include them
    passing: Optional[list] = None          # where headers may pass them on, directly or not; None: everywhere
    inner: bool = False                     # a header that only its own folder sees may use them as a source may


COMMANDS = ["host/main.cpp", "host/commands", "bench/bench_command.cpp", "validation/validate_command.cpp"]
ALL_BUT_KERNELS = ["io", "host", "bench", "validation"]
PACKAGES = {
    # Loops over items are templates, so a header with such loops has to see TBB.
    "TBB": Package(r"(tbb|oneapi)/", ["host", "bench", "validation"], ["host/parallel"], inner=True),
    "Embree": Package(r"embree", ["host/embree"], ["host/embree", "host/render"]),
    "HDF5": Package(r"(hdf5|H5)", ["io/run"], ["io/run"]),
    "OpenCV": Package(r"opencv", ["io/image.cpp", "bench/harness/chart.cpp"], []),
    "toml++": Package(r"toml\+\+/", ["io/scene"], ["io/scene"]),
    "CLI11": Package(r"CLI/", COMMANDS, []),
    "Catch2": Package(r"catch2/", ["validation/unit/catch.hpp"], ["validation/unit"]),
    "Google Benchmark": Package(r"benchmark/", ["bench"], ["bench"]),
    "JSON for Modern C++": Package(r"nlohmann/", ALL_BUT_KERNELS),
    "fmt": Package(r"fmt/", ALL_BUT_KERNELS),
    "Eigen": Package(r"(Eigen|unsupported)/", ALL_BUT_KERNELS),
    "the benchmarks": Package(r"bench/", ["bench", "host/main.cpp", "validation/unit"]),
}


def layered_folder(name):
    return "kernels" if name.startswith("kernels/") else folder_of(name)


def index_of(folder, layers):
    """Returns the index of the layer that lists the folder, or None."""
    return next((index for index, layer in enumerate(layers) if folder in layer), None)


def place_of(folder):
    """Returns the layer's index, the folder listed there, and the index of the layer within that folder."""
    for top, inner in INNER_LAYERS.items():
        if index_of(folder, inner) is not None:
            return index_of(top, LAYERS), top, index_of(folder, inner)
    return index_of(folder, LAYERS), folder, 0


def may_include(folder, other):
    (layer, top, inner), (other_layer, other_top, other_inner) = place_of(folder), place_of(other)
    return folder == other or other_layer < layer or (other_top == top and other_inner < inner)


def folders_without_place(sources):
    return sorted(folder for folder in {layered_folder(name) for name in sources.texts} if place_of(folder)[0] is None)


def includes_against_layers(sources):
    unplaced = folders_without_place(sources)
    found = []
    for name, includes in sources.includes.items():
        for number, header in includes:
            folders = [layered_folder(name), layered_folder(header)]
            if header in sources.texts and not any(folder in unplaced for folder in folders):
                if not may_include(*folders):
                    found.append(f"{name}:{number} includes {header}, which is not in a lower layer")
    return found


def circles(graph):
    """Groups of nodes that reach each other."""
    reached = {node: reached_from(node, graph.get) for node in graph}
    groups = {frozenset(other for other in reached[node] if node in reached[other]) for node in graph}
    return sorted(sorted(group) for group in groups if group)


def lies_in(name, places):
    return any(name == place or name.startswith(place + "/") for place in places)


def misplaced_packages(sources):
    return [f"{name}:{number} includes {header}, but {title} is kept to {', '.join(package.includers)}"
            for name, includes in sources.includes.items() for number, header in includes
            for title, package in PACKAGES.items()
            if re.match(package.headers, header) and not lies_in(name, package.includers)]


def leaks(sources):
    """Headers through which files come to depend on a package that is no concern of theirs."""
    includers = sources.includers()
    found = []
    for name in [name for name in sources.texts if not name.endswith(".cpp")]:
        inner = {folder_of(user) for user in reached_from(name, includers.get)} == {folder_of(name)}
        for title, package in PACKAGES.items():
            if package.passing is None or lies_in(name, package.passing) or (inner and package.inner):
                continue
            way = way_to_package(sources, name, package)
            if way:
                found.append(f"{name} passes {title} on: " + " > ".join(way))
    return found


def way_to_package(sources, name, package):
    """Returns the shortest chain of includes from a file to a header of the package, or None."""
    before, waiting = {name: None}, [name]
    for file in waiting:
        for _, header in sources.includes.get(file, []):
            if header not in before:
                before[header] = file
                waiting.append(header)
        if re.match(package.headers, file):
            way = [file]
            while before[way[0]]:
                way.insert(0, before[way[0]])
            return way
    return None


class Layers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sources = read_sources()

    def assert_none(self, violations):
        if violations:
            self.fail("\n" + "\n".join(violations))

    def test_every_folder_has_its_place_in_the_layers(self):
        self.assertGreater(len(self.sources.texts), 100)
        self.assert_none([f"{folder}: give this folder its place in LAYERS or INNER_LAYERS of {__file__}"
                          for folder in folders_without_place(self.sources)])

    def test_every_entry_of_the_layers_is_a_folder(self):
        listed = {folder for layer in LAYERS for folder in layer if folder not in INNER_LAYERS}
        listed |= {folder for inner in INNER_LAYERS.values() for layer in inner for folder in layer}
        self.assertEqual(listed - {layered_folder(name) for name in self.sources.texts}, set())

    def test_the_top_layer_is_the_main_program_alone(self):
        self.assertEqual([name for name in self.sources.texts if folder_of(name) == "host"], ["host/main.cpp"])

    def test_includes_lead_to_lower_layers(self):
        self.assert_none(includes_against_layers(self.sources))

    def test_units_form_no_circle(self):
        self.assert_none([" <-> ".join(circle) for circle in circles(self.sources.units())])

    def test_quoted_includes_name_files_of_the_project(self):
        self.assert_none([f"{name}:{number} includes {header}, which is no file of the project"
                          for name, number, header in self.sources.unknown if not header.startswith("generated/")])

    def test_kernels_include_nothing_but_themselves_and_cmath(self):
        for name, includes in self.sources.includes.items():
            for number, header in includes if layered_folder(name) == "kernels" else []:
                own = header in self.sources.texts and layered_folder(header) == "kernels"
                self.assertTrue(own or header == "cmath", f"{name}:{number} includes {header}")

    def test_packages_are_included_only_in_their_places(self):
        self.assert_none(misplaced_packages(self.sources))

    def test_headers_do_not_pass_packages_on(self):
        self.assert_none(leaks(self.sources))


class Guards(unittest.TestCase):
    """Small projects with one fault each: it is reported, and nothing else is."""

    def test_a_folder_without_a_place_is_reported(self):
        self.assertEqual(folders_without_place(Sources({"host/attic/box.cpp": "", "io/text.cpp": ""})), ["host/attic"])

    def test_an_include_of_a_higher_or_the_same_layer_is_reported(self):
        terms, linear, contact = (f"host/solver/{unit}.hpp" for unit in ("terms/a", "linear/b", "contact/c"))
        project = Sources({terms: f'#include "{linear}"', linear: f'#include "{terms}"\n#include "{contact}"',
                           contact: '#include "io/d.hpp"', "io/d.hpp": "",
                           "kernels/e.h": "", "kernels/terms/f.h": '#include "../e.h"'})
        found = [message.split(",")[0] for message in includes_against_layers(project)]
        self.assertEqual(found, [f"{terms}:1 includes {linear}", f"{linear}:2 includes {contact}"])

    def test_a_circle_of_units_is_reported(self):
        project = Sources({"io/a.hpp": "", "io/a.cpp": '#include "io/b.hpp"', "io/b.hpp": '#include "io/c.hpp"',
                           "io/c.hpp": "", "io/c.cpp": '#include "io/c.hpp"\n#include "io/a.hpp"',
                           "io/d.cpp": '#include "io/a.hpp"'})
        self.assertEqual(circles(project.units()), [["io/a", "io/b", "io/c"]])

    def test_a_package_out_of_its_place_is_reported(self):
        project = Sources({"io/run/a.cpp": "#include <hdf5.h>", "host/run/b.cpp": "#include <hdf5.h>"})
        self.assertEqual([message.split(",")[0] for message in misplaced_packages(project)],
                         ["host/run/b.cpp:1 includes hdf5.h"])

    def test_a_header_that_passes_a_package_on_is_reported(self):
        project = Sources({"host/parallel/a.hpp": "#include <tbb/task_arena.h>",
                           "host/solver/terms/inner.hpp": '#include "host/parallel/a.hpp"',
                           "host/solver/terms/b.cpp": '#include "inner.hpp"',
                           "host/solver/terms/outer.hpp": '#include "host/parallel/a.hpp"',
                           "host/solver/stepping/c.cpp": '#include "host/solver/terms/outer.hpp"'})
        self.assertEqual(leaks(project), ["host/solver/terms/outer.hpp passes TBB on: host/solver/terms/outer.hpp > "
                                          "host/parallel/a.hpp > tbb/task_arena.h"])


if __name__ == "__main__":
    unittest.main()
