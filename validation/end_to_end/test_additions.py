"""A force term or an integrator is one new file and its line in one list: nothing else of the program changes.

Both are added to copies of the sources. What includes the changed lists and is needed by a small program is compiled
without optimisation; everything else is taken from the build as it is.
"""
import collections
import concurrent.futures
import difflib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import unittest

from sources import ROOT

BUILD = pathlib.Path(os.environ.get("SELVAGE", ROOT / "build/selvage")).resolve().parent
FOLDERS = ["kernels", "io", "host", "validation/measure"]
TERM = """// Draws every vertex to the origin.
//     E = 1/2 k m |x|^2  [J]        f = -k m x  [N]        d2E/dx2 = k m I
#pragma once
#include "../term_args.h"

#define tether_PARAMS(STRENGTH, PARAM) STRENGTH(rate, 0.0, "1/s^2", "stiffness over mass")
#define tether_FIELDS(READ, ADD) READ(pos) READ(mass) ADD(force) ADD(vertex_stiffness)
TERM_ARGS(tether)

KERNEL_FN real tether_energy(int vertex, const tether_args* a)
{
    vec3 x = load3(a->pos, a->size.vertex_stride, vertex);
    return REAL(0.5) * a->rate * a->mass[vertex] * dot(x, x);
}

KERNEL_FN void tether_force(int vertex, const tether_args* a)
{
    vec3 x = load3(a->pos, a->size.vertex_stride, vertex);
    add3(a->force, a->size.vertex_stride, vertex, (-a->rate * a->mass[vertex]) * x);
}

KERNEL_FN void tether_stiffness(int vertex, const tether_args* a)
{
    mat3 zero = outer3(REAL(0), make_vec3(0, 0, 0), make_vec3(0, 0, 0));
    add_block(a->vertex_stiffness, a->size.vertex_stride, vertex, 0,
              mat3_add_diagonal(zero, a->rate * a->mass[vertex]));
}
"""
TERM_PROGRAM = """
#include <iostream>

#include "host/scene/plan_text.hpp"
#include "host/solver/terms/unit_strengths.hpp"
#include "io/scene/read_scene.hpp"
#include "validation/measure/finite_differences.hpp"
#include "validation/measure/small_cloth.hpp"

using namespace selvage;

int main()
{
    const Params params = unit_strengths();
    double force_error = -1, stiffness_error = -1;
    for (const Term& term : all_terms()) {
        if (term.name != "tether") continue;
        State state = crumpled_state(params, 3);
        const std::vector<real> force = term_force(term, state, params), other = differenced_force(term, state, params);
        double size = 0;
        force_error = 0;
        for (const int dof : active_dofs(state)) {
            force_error = std::max(force_error, std::abs(force[dof] - other[dof]));
            size = std::max(size, std::abs(force[dof]));
        }
        force_error /= size;
        const Eigen::MatrixXd stiffness = ordered_stiffness(term, state, params, false);
        stiffness_error = (stiffness - differenced_stiffness(term, state, params)).norm() / stiffness.norm();
    }
    const std::vector<std::string> small{"sheet.resolution=9"};
    std::cout << "{\\"force\\": " << force_error << ", \\"stiffness\\": " << stiffness_error
              << ", \\"plan\\": " << describe_plan(read_scene("builtin:hanging", small), true) << "}";
}
"""
INTEGRATOR_PROGRAM = """
#include <iostream>

#include "host/scene/run_settings.hpp"
#include "io/scene/read_scene.hpp"
#include "io/scene/scene_schema.hpp"

using namespace selvage;

std::vector<Vec3> moved(const std::string& integrator)
{
    const std::vector<std::string> changes{"sheet.resolution=9", "solver.until=1", "solver.integrator=" + integrator};
    const Scene scene = read_scene("builtin:hanging", changes);
    const SceneModel model = build_scene_model(scene);
    const ClothModel& cloth = model.cloth_model;
    Profile profile;
    Phase phase(cloth, phase_options(scene, model, false), nullptr, profile, cloth.cloth.positions, {});
    const auto scheme = make_integrator(word_of(integrator_of(scene, cloth)), phase);
    for (int step = 0; step < 20; ++step) scheme->step(1e-4, {});
    return phase.positions();
}

int main()
{
    const std::vector<Vec3> by_copy = moved("copied_scheme"), by_original = moved("symplectic_euler");
    const bool is_offered = scene_schema_text().find(" copied_scheme") != std::string::npos;
    std::cout << "{\\"offered\\": " << is_offered << ", \\"equal\\": " << (by_copy == by_original) << "}";
}
"""


def lines_changed(folder):
    """Of every file that differs from the project's: lines added and lines removed."""
    changed = {}
    for path in sorted(path for top in FOLDERS for path in (folder / top).rglob("*") if path.is_file()):
        name = str(path.relative_to(folder))
        original = ROOT / name
        old = original.read_text().splitlines() if original.exists() else []
        if old != path.read_text().splitlines():
            delta = list(difflib.ndiff(old, path.read_text().splitlines()))
            changed[name] = tuple(sum(line.startswith(sign) for line in delta) for sign in "+-")
    return changed


def ninja(*arguments):
    return subprocess.run(["ninja", "-C", BUILD, *arguments], capture_output=True, text=True, check=True).stdout


class Objects:
    """The object files of the build: the source, the compiler's command and the files that each was made of."""

    def __init__(self):
        self.source, self.command = {}, {}
        for entry in json.loads(ninja("-t", "compdb")):
            if re.match(r"CMakeFiles/(selvage_(io|host)|linear_\w+)\.dir/.*\.o$|.*/validation/measure/.*\.o$",
                        entry["output"]):
                self.source[entry["output"]] = os.path.relpath(entry["file"], ROOT)
                self.command[entry["output"]] = shlex.split(entry["command"])
        self.reads = {}
        for block in ninja("-t", "deps").split("\n\n"):
            output, *files = block.split("\n")
            self.reads[output.partition(":")[0]] = {os.path.relpath(BUILD / file.strip(), ROOT) for file in files}
        symbols = subprocess.run(["nm", "-A", *self.source], cwd=BUILD, capture_output=True, text=True, check=True)
        self.needs, self.home = collections.defaultdict(set), {}
        for line in symbols.stdout.splitlines():
            output, _, rest = line.partition(":")
            kind, name = rest.split()[-2:]
            if kind == "U":
                self.needs[output].add(name)
            elif kind in "TDBR" or name not in self.home:
                self.home[name] = output

    def changed_by(self, names):
        return {output for output in self.source if self.reads[output] & set(names)}


def symbols_needed(file):
    listed = subprocess.run(["nm", "-u", file], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1] for line in listed.splitlines()}


class Copy:
    """A copy of the sources in which a program is built that links what has not changed from the build."""

    def __init__(self, name):
        self.folder = BUILD / "additions" / name
        shutil.rmtree(self.folder, ignore_errors=True)
        for top in FOLDERS:
            shutil.copytree(ROOT / top, self.folder / top)

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def insert_after(self, name, line, added):
        text = (self.folder / name).read_text()
        assert text.count(line) == 1, line
        self.write(name, text.replace(line, line + added))

    def compile(self, command, source, output):
        """Compiles as the build does, but from this folder and without optimisation."""
        arguments = [word.replace(f"-I{ROOT}", f"-I{self.folder}") if word == f"-I{ROOT}" else word
                     for word in command[:command.index("-MD")] if not word.startswith("-O")]
        arguments = [str(self.folder / "precompiled.hpp") if word.endswith("cmake_pch.hxx") else word
                     for word in arguments]
        subprocess.run([*arguments, "-O0", "-w", "-o", output, "-c", source], cwd=self.folder, check=True)
        return output

    def build(self, objects, program, added):
        """Returns the path of the program, linked with the sources that were added."""
        self.write("program.cpp", program)
        self.write("precompiled.hpp", "#include <Eigen/Core>\n#include <Eigen/Geometry>\n#include <string>\n"
                                      "#include <algorithm>\n#include <array>\n#include <map>\n#include <vector>\n")
        command = next(objects.command[output] for output in objects.source if "host/scene/plan.cpp" in output)
        plain = [word for word in command if word != "-include" and not word.endswith("cmake_pch.hxx")]
        self.compile([*plain[:plain.index("-MD")], "-x", "c++-header", "-MD"], "precompiled.hpp", "precompiled.hpp.gch")
        changed = objects.changed_by(lines_changed(self.folder))
        made = {name: self.compile(command, name, f"{index}.o")
                for index, name in enumerate(["program.cpp", *added])}
        waiting = set().union(*(symbols_needed(self.folder / file) for file in made.values()))
        used = set()
        while waiting:
            found = set()
            while waiting:
                output = objects.home.get(waiting.pop())
                if output and output not in used:
                    used.add(output)
                    found.add(output)
                    waiting |= objects.needs[output]
            fresh = [output for output in sorted(found & changed)]
            with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
                made.update(zip(fresh, pool.map(
                    lambda output: self.compile(objects.command[output], objects.source[output],
                                                re.sub(r"\W", "_", output) + ".o"), fresh)))
            for output in fresh:
                waiting |= symbols_needed(self.folder / made[output])
        link = shlex.split(ninja("-t", "commands", "selvage").splitlines()[-1])
        # Newer CMake also has the linker write a list of what it read, for the link of the program alone.
        libraries = [word for word in link if re.match(r"-l|-Wl,(?!--dependency-file)|.*\.so[.\d]*$", word)]
        kept = [BUILD / output for output in used - changed]
        subprocess.run(["c++", "-o", "program", *made.values(), *kept, *libraries], cwd=self.folder, check=True)
        return self.folder / "program"


@unittest.skipUnless((BUILD / "build.ninja").exists() and shutil.which("ninja"), "not built with ninja")
class Additions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.objects = Objects()

    def run_program(self, copy, program, added):
        path = copy.build(self.objects, program, added)
        return json.loads(subprocess.run([path], capture_output=True, text=True, check=True).stdout)

    def test_a_force_term_is_its_file_and_its_line_in_the_list_of_terms(self):
        copy = Copy("term")
        copy.write("kernels/terms/tether.h", TERM)
        copy.insert_after("kernels/terms.h", '#include "terms/spring.h"\n', '#include "terms/tether.h"\n')
        first = next(line for line in (ROOT / "kernels/terms.h").read_text().splitlines(True)
                     if line.startswith("    TERM(gravity,"))
        copy.insert_after("kernels/terms.h", first, first.replace("gravity", "tether"))
        self.assertEqual(lines_changed(copy.folder),
                         {"kernels/terms.h": (2, 0), "kernels/terms/tether.h": (len(TERM.splitlines()), 0)})
        found = self.run_program(copy, TERM_PROGRAM, [])
        self.assertTrue(0 <= found["force"] < 1e-6, found["force"])
        self.assertTrue(0 <= found["stiffness"] < 2e-6, found["stiffness"])
        self.assertIn({"name": "tether", "reason": "its strength is zero"}, found["plan"]["skipped"])

    def test_an_integrator_is_its_file_and_its_line_in_the_list_of_integrators(self):
        copy = Copy("integrator")
        folder = "host/solver/stepping/integrators"
        text = (ROOT / folder / "symplectic_euler.cpp").read_text().replace("symplectic_euler", "copied_scheme")
        copy.write(f"{folder}/copied_scheme.cpp", text)
        line = next(line for line in (ROOT / "io/integrators.hpp").read_text().splitlines(True)
                    if line.startswith("    INTEGRATOR(symplectic_euler,"))
        copy.insert_after("io/integrators.hpp", line, line.replace("symplectic_euler", "copied_scheme"))
        self.assertEqual(lines_changed(copy.folder), {"io/integrators.hpp": (1, 0), f"{folder}/copied_scheme.cpp":
                                                      (len(text.splitlines()), 0)})
        found = self.run_program(copy, INTEGRATOR_PROGRAM, [f"{folder}/copied_scheme.cpp"])
        self.assertEqual(found, {"offered": 1, "equal": 1})


if __name__ == "__main__":
    unittest.main()
