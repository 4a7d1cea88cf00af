"""The kernels are OpenCL C 1.2: clang compiles each of them for a device, and every term can be entered from one."""
import itertools
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from sources import ROOT

STRICT = ["clang", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I."]
# spir64 stands for any device: 64 bits, with address spaces that do not mix.
OPENCL = ["-x", "cl", "-cl-std=CL1.2", "--target=spir64", "-S", "-emit-llvm", "-o", "-"]
CPP = ["-x", "c++", "-std=c++20", "-fsyntax-only", "-Wno-unused-function"]
# portable.h makes `real` double where the device has it. Devices without must not see a double anywhere.
PRECISIONS = {
    "float": ["-Xclang", "-cl-ext=-cl_khr_fp64", "-cl-single-precision-constant"],
    "double, solver in float": ["-DSELVAGE_LINEAR=float"],
    "double": ["-DSELVAGE_LINEAR=double"],
}

# What a device would run: one entry for each term and rule, with a parameter for each array, since a struct that holds
# pointers cannot be the argument of an entry. The lists of terms and fields write them.
ENTRIES = """
#include "kernels/terms.h"
#include "kernels/velocity_filters.h"
#define BUFFER_READ(name) GLOBAL const name##_type* RESTRICT name##_buffer,
#define BUFFER_ADD(name) GLOBAL name##_type* RESTRICT name##_buffer,
#define VALUE(name, initial, unit, meaning) real name##_value,
#define SET_FIELD(name) args.name = name##_buffer;
#define SET_VALUE(name, initial, unit, meaning) args.name = name##_value;
#define ENTRY(name, kind, call, extra)                                                                     \\
    __kernel void enter_##name(name##_FIELDS(BUFFER_READ, BUFFER_ADD) name##_PARAMS(VALUE, VALUE)          \\
                               mesh_sizes size, int projected, GLOBAL real* extra)                         \\
    {                                                                                                      \\
        int item = (int)get_global_id(0);                                                                  \\
        name##_args args;                                                                                  \\
        args.size = size;                                                                                  \\
        args.mode.projected = projected;                                                                   \\
        name##_FIELDS(SET_FIELD, SET_FIELD) name##_PARAMS(SET_VALUE, SET_VALUE)                            \\
        if (item < size.kind##_count) { call }                                                             \\
    }
#define no_stage(item, args)
#define TERM(term, kind, nature, stage, family)                                                            \\
    ENTRY(term, kind, stage(item, &args); term##_force(item, &args); term##_stiffness(item, &args);        \\
          energy[item] = term##_energy(item, &args);, energy)
#define VELOCITY_FILTER(rule, kind) ENTRY(rule, kind, rule##_apply(item, step[0], &args);, step)
TERMS(TERM)
VELOCITY_FILTERS(VELOCITY_FILTER)
"""

# Lines that are legal in C++ but not in OpenCL C 1.2, and one that a device without double does not know.
CPP_ONLY = {
    "reference": "KERNEL_FN real planted(const real& a) { return a; }",
    "overloading": "KERNEL_FN int load3(int a) { return a; }",
    "brace initialiser": "KERNEL_FN int planted(int a) { int b{a}; return b; }",
    "functional cast": "KERNEL_FN real planted(int a) { return real(a); }",
    "default argument": "KERNEL_FN int planted(int a = 1) { return a; }",
    "template": "template <class T> static inline T planted(T a) { return a; }",
    "lost address space": "KERNEL_FN real planted(GLOBAL const real* a) { const real* b = a; return *b; }",
    "function of the standard library": "KERNEL_FN real planted(real a) { return std::sqrt(a); }",
}


def compiled(text, *options, folder=ROOT):
    return subprocess.run([*STRICT, *options, "-"], input=text, capture_output=True, text=True, cwd=folder)


def kernel_files():
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "kernels").rglob("*.h"))


def including(*files):
    return "".join(f'#include "{file}"\n' for file in files)


class Kernels(unittest.TestCase):
    def assert_compiles(self, text, *options):
        result = compiled(text, *OPENCL, *options)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stderr)
        return result.stdout

    def test_each_kernel_file_compiles_by_itself(self):
        self.assertGreater(len(kernel_files()), 30)
        for file, (precision, options) in itertools.product(kernel_files(), PRECISIONS.items()):
            with self.subTest(file=file, precision=precision):
                self.assert_compiles(including(file), *options)

    def test_all_kernel_files_compile_together(self):
        for precision, options in PRECISIONS.items():
            with self.subTest(precision=precision):
                self.assert_compiles(including("kernels/terms.h", *kernel_files()), *options)

    def test_every_term_and_rule_compiles_to_an_entry_of_a_device(self):
        terms = list((ROOT / "kernels/terms").glob("*.h")) + list((ROOT / "kernels/velocity_filters").glob("*.h"))
        for precision, options in PRECISIONS.items():
            with self.subTest(precision=precision):
                code = self.assert_compiles(ENTRIES, *options)
                for term in terms:
                    self.assertIn(f"spir_kernel void @enter_{term.stem}(", code)
                self.assertEqual("double" in code, precision != "float")


class Guards(unittest.TestCase):
    """Faults in a copy of one kernel: clang rejects them and names the line."""

    FILE = "kernels/terms/gravity.h"

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copytree(ROOT / "kernels", self.folder / "kernels")
        self.text = (ROOT / self.FILE).read_text()

    def compiled(self, text, *options):
        (self.folder / self.FILE).write_text(text)
        return compiled(including(self.FILE), *options, folder=self.folder)

    def assert_rejected(self, text, line, *options):
        result = self.compiled(text, *OPENCL, *options)
        self.assertNotEqual(result.returncode, 0, result.stdout)
        self.assertRegex(result.stderr, rf"{self.FILE}:{line}:\d+: error:")

    def appended(self, line):
        """Returns the kernel with one more line, and that line's number."""
        return f"{self.text}\n{line}\n", len(self.text.splitlines()) + 2

    def test_the_copy_compiles_without_a_fault(self):
        self.assertEqual(self.compiled(self.text, *OPENCL).stderr, "")

    def test_a_missing_semicolon_is_found(self):
        statement = "add3(a->force, a->size.vertex_stride, vertex, gravity_weight(vertex, a))"
        self.assertIn(statement + ";", self.text)
        line = 1 + self.text[:self.text.index(statement)].count("\n")
        self.assert_rejected(self.text.replace(statement + ";", statement), line)

    def test_what_only_cpp_allows_is_found(self):
        for name, line in CPP_ONLY.items():
            with self.subTest(name):
                text, number = self.appended(line)
                legal = self.compiled(text, *CPP)
                self.assertEqual(legal.returncode, 0, legal.stderr)
                self.assert_rejected(text, number)

    def test_a_double_is_found_where_the_device_has_none(self):
        text, number = self.appended("KERNEL_FN double planted(double a) { return a; }")
        self.assertEqual(self.compiled(text, *OPENCL, *PRECISIONS["double"]).stderr, "")
        self.assert_rejected(text, number, *PRECISIONS["float"])


if __name__ == "__main__":
    unittest.main()
