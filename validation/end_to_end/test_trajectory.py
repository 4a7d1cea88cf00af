"""Sews and drapes one garment and checks every file of the result, with measures computed here from the files alone."""
import json
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml

import h5py
import numpy as np

PROGRAM = os.environ.get("SELVAGE", "build/selvage")
PANELS = ["front", "neck_band_front", "back", "neck_band_back", "left_sleeve", "right_sleeve"]
GRID = 2.0 ** -17   # output.precision = "8um" [m]

SUMMARY_KEYS = {
    "status", "scene", "version", "threads", "precision", "vertices", "triangles", "steps", "frames", "simulated_s",
    "wall_s", "phases", "kernels", "integrators", "active", "skipped", "peak_memory_bytes", "residual", "energy",
    "stretch", "body", "self", "seams", "panels"}
SUMMARY_PARTS = {
    "energy": {"membrane_J", "bending_J", "gravity_J", "contact_J", "kinetic_J"},
    "stretch": {"min", "max", "p99"},
    "body": {"max_penetration_m", "min_gap_m"},
    "self": {"intersections"},
    "seams": {"count", "max_gap_m"}}
LIST_PARTS = {
    "kernels": {"name", "calls", "seconds", "items", "bytes"},
    "skipped": {"name", "reason"},
    "panels": {"name", "area_error", "boundary_error"}}


def drape(folder, *arguments):
    return subprocess.run([PROGRAM, "drape", *arguments, "-o", folder, "--quiet", "--threads", "2"],
                          capture_output=True, text=True, timeout=300)


def read_obj(path):
    """Returns object names, vertices, texture coordinates and faces (vertex indices from 0)."""
    names, vertices, texture, faces = [], [], [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "o":
                names.append(words[1])
            elif words[0] == "v":
                vertices.append([float(w) for w in words[1:4]])
            elif words[0] == "vt":
                texture.append([float(w) for w in words[1:3]])
            elif words[0] == "f":
                faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return names, np.array(vertices), np.array(texture), np.array(faces)


def winding_numbers(points, vertices, faces):
    """How often a closed mesh winds around each point: 1 inside, 0 outside (van Oosterom and Strackee 1983)."""
    corners = vertices[faces]
    total = np.empty(len(points))
    for first in range(0, len(points), 64):
        a, b, c = (corners[None, :, k] - points[first:first + 64, None] for k in range(3))
        la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
        volume = np.einsum("pfi,pfi->pf", a, np.cross(b, c))
        edges = (la * lb * lc + np.einsum("pfi,pfi->pf", a, b) * lc + np.einsum("pfi,pfi->pf", b, c) * la
                 + np.einsum("pfi,pfi->pf", c, a) * lb)
        total[first:first + 64] = np.arctan2(volume, edges).sum(axis=1) / (2 * np.pi)
    return total


def larger_stretch(positions, triangles, rest):
    """Larger principal stretch - 1 of every triangle, from its rest edge lengths 01, 12 and 20."""
    ab, bc, ca = rest.astype(float).T
    x = (ab**2 + ca**2 - bc**2) / (2 * ab)
    y = np.sqrt(ca**2 - x**2)
    inverse = np.zeros((len(rest), 2, 2))
    inverse[:, 0, 0], inverse[:, 0, 1], inverse[:, 1, 1] = 1 / ab, -x / (ab * y), 1 / y
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    gradient = np.stack([b - a, c - a], axis=2) @ inverse
    return np.linalg.svd(gradient, compute_uv=False)[:, 0] - 1


class Garment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = holder.name
        cls.result = drape(cls.folder, "builtin:tshirt", "--set", "garment.resolution=0.03",
                           "--set", "output.picture=false")
        if cls.result.returncode != 0:
            raise AssertionError(f"exit code {cls.result.returncode}: {cls.result.stderr}")
        with open(cls.path("summary.json")) as file:
            cls.summary = json.load(file)
        cls.file = h5py.File(cls.path("run.h5"), "r")
        cls.addClassCleanup(cls.file.close)
        cls.group = cls.file["selvage"]

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def check_panels(self, triangles, of_point, of_triangle):
        """Where panels are sewn together a point is of one of them: its panel is that of a triangle around it."""
        agrees = np.zeros(len(of_point), bool)
        np.logical_or.at(agrees, triangles, of_point[triangles] == of_triangle[:, None])
        self.assertTrue(agrees[np.unique(triangles)].all())

    def check_layout(self, file):
        root = file["VTKHDF"]
        np.testing.assert_array_equal(root.attrs["Version"], [2, 0])
        self.assertEqual(root.attrs["Type"], b"PolyData")
        kind = h5py.h5a.open(root.id, b"Type").get_type()
        self.assertIsInstance(kind, h5py.h5t.TypeStringID)
        self.assertFalse(kind.is_variable_str())
        self.assertEqual(kind.get_cset(), h5py.h5t.CSET_ASCII)

        frames, points = int(root["Steps"].attrs["NSteps"]), int(root["NumberOfPoints"][0])
        self.assertEqual(root["Points"].shape, (frames * points, 3))
        self.assertEqual(root["Points"].dtype, np.float32)
        self.assertEqual(root["Points"].chunks, (points, 3))
        self.assertEqual((root["Points"].compression, root["Points"].compression_opts), ("gzip", 1))
        self.assertTrue(root["Points"].shuffle)
        for group in ["Vertices", "Lines", "Strips"]:
            np.testing.assert_array_equal(root[group]["Offsets"][()], [0])
            self.assertEqual(root[group]["Connectivity"].shape, (0,))
        cells = len(root["Polygons/Offsets"]) - 1
        np.testing.assert_array_equal(root["Polygons/Offsets"][()], 3 * np.arange(cells + 1))
        self.assertEqual(len(root["Polygons/Connectivity"]), 3 * cells)
        self.assertLess(root["Polygons/Connectivity"][()].max(), points)

        steps = root["Steps"]
        self.assertTrue(np.all(np.diff(steps["Values"][()]) > 0))
        np.testing.assert_array_equal(steps["PointOffsets"][()], points * np.arange(frames))
        np.testing.assert_array_equal(steps["PartOffsets"][()], np.zeros(frames))
        np.testing.assert_array_equal(steps["NumberOfParts"][()], np.ones(frames))
        for name in ["CellOffsets", "ConnectivityIdOffsets"]:
            np.testing.assert_array_equal(steps[name][()], np.zeros((frames, 4)))
        for name in root["PointData"]:
            np.testing.assert_array_equal(steps["PointDataOffsets"][name][()], np.zeros(frames))
        for name in root["CellData"]:
            np.testing.assert_array_equal(steps["CellDataOffsets"][name][()], np.zeros(frames))
        self.assertEqual(root["PointData/panel_coordinates"].shape, (points, 2))
        self.assertEqual(root["PointData/panel"].shape, (points,))
        self.assertEqual(root["CellData/rest_edge_lengths"].shape, (cells, 3))
        self.assertEqual(root["CellData/rest_corners"].shape, (cells, 6))   # VTK reads no third dimension
        self.assertEqual(root["CellData/panel"].shape, (cells,))
        corners, lengths = file["selvage/rest_corners"][()], root["CellData/rest_edge_lengths"][()]
        self.assertEqual((corners.shape, corners.dtype), ((cells, 3, 2), np.float32))
        np.testing.assert_array_equal(corners.reshape(cells, 6), root["CellData/rest_corners"][()])
        np.testing.assert_allclose(np.linalg.norm(np.roll(corners, -1, 1) - corners, axis=2), lengths, atol=1e-6)
        self.check_panels(file["selvage/triangles"][()], root["PointData/panel"][()], root["CellData/panel"][()])

        run = file["selvage"]
        self.assertLessEqual({"schema", "version", "scene_text", "length_unit", "up_axis"}, set(run.attrs))
        self.assertEqual(run["positions"].shape, (frames, points, 3))
        self.assertTrue(run["positions"].is_virtual)
        self.assertEqual(run["triangles"].shape, (cells, 3))
        np.testing.assert_array_equal(run["time"][()], steps["Values"][()])
        for name in ["kinetic_energy", "total_energy", "residual", "contacts", "iterations", "wall_seconds"]:
            self.assertEqual(run[name].shape, (frames,), name)
        for frame in range(frames):
            positions = run["positions"][frame]
            self.assertTrue(np.isfinite(positions).all(), f"frame {frame}")
            np.testing.assert_array_equal(positions, root["Points"][frame * points:(frame + 1) * points])

    def test_run_h5_is_laid_out_as_promised_and_finite(self):
        self.check_layout(self.file)
        self.assertEqual(self.file["VTKHDF/Steps"].attrs["NSteps"], self.summary["frames"])

    def test_sewing_h5_is_laid_out_as_promised_and_finite(self):
        with h5py.File(self.path("sewing.h5"), "r") as file:
            self.check_layout(file)

    def test_run_h5_has_a_superblock_that_old_readers_know(self):
        with open(self.path("run.h5"), "rb") as file:
            self.assertEqual(file.read(9), b"\x89HDF\r\n\x1a\n\x00")

    def test_the_summary_holds_every_promised_key(self):
        self.assertLessEqual(SUMMARY_KEYS, set(self.summary))
        for name, parts in SUMMARY_PARTS.items():
            self.assertLessEqual(parts, set(self.summary[name]), name)
        for name, parts in LIST_PARTS.items():
            self.assertTrue(self.summary[name], name)
            for item in self.summary[name]:
                self.assertLessEqual(parts, set(item), name)
        self.assertGreater(self.summary["wall_s"], 0)
        self.assertEqual(self.summary["threads"], 2)

    def test_the_garment_converges(self):
        self.assertEqual(self.summary["status"], "converged")
        self.assertLessEqual(self.summary["residual"], 1e-3)
        self.assertFalse(os.path.exists(self.path("checkpoint.h5")))

    def test_no_vertex_is_inside_the_body(self):
        self.assertEqual(self.summary["body"]["max_penetration_m"], 0)
        _, vertices, _, faces = read_obj(self.path("body.obj"))
        inside = winding_numbers(self.group["positions"][-1].astype(float), vertices, faces) > 0.5
        self.assertEqual(np.count_nonzero(inside), 0)

    def test_the_cloth_is_hardly_stretched(self):
        self.assertLessEqual(self.summary["stretch"]["p99"], 0.03)
        root = self.file["VTKHDF"]
        stretch = larger_stretch(self.group["positions"][-1], root["Polygons/Connectivity"][()].reshape(-1, 3),
                                 root["CellData/rest_edge_lengths"][()])
        self.assertLessEqual(np.percentile(stretch, 99), 0.03)
        self.assertAlmostEqual(stretch.max(), self.summary["stretch"]["max"], delta=0.003)

    def test_every_principal_stretch_follows_from_the_file(self):
        root, last = self.file["VTKHDF"], self.group["positions"][-1].astype(float)
        corners = root["CellData/rest_corners"][()].astype(float).reshape(-1, 3, 2)
        x = last[self.group["triangles"][()]]
        rest = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
        self.assertGreater(np.linalg.det(rest).min(), 0)
        gradient = np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=2) @ np.linalg.inv(rest)
        strains = np.linalg.svd(gradient, compute_uv=False) - 1
        told = self.summary["stretch"]
        self.assertAlmostEqual(strains.min(), told["min"], delta=1e-6)
        self.assertAlmostEqual(strains.max(), told["max"], delta=1e-6)
        sizes = np.sort(np.abs(strains).ravel())
        self.assertAlmostEqual(sizes[int(0.99 * (len(sizes) - 1))], told["p99"], delta=1e-6)

    def test_every_seam_is_closed(self):
        pairs, last = self.group["seam_pairs"][()], self.group["positions"][-1].astype(float)
        self.assertGreater(len(pairs), 50)
        gaps = np.linalg.norm(last[pairs[:, 0]] - last[pairs[:, 1]], axis=1)
        self.assertLess(gaps.max(), 1e-3)
        with h5py.File(self.path("sewing.h5"), "r") as file:
            first = file["selvage/positions"][0].astype(float)
        self.assertGreater(np.linalg.norm(first[pairs[:, 0]] - first[pairs[:, 1]], axis=1).max(), 0.05)

    def test_final_obj_is_the_last_frame_with_one_object_per_panel(self):
        names, vertices, texture, faces = read_obj(self.path("final.obj"))
        self.assertEqual(names, PANELS)
        self.assertEqual(len(faces), self.summary["triangles"])
        triangles = self.group["triangles"][()]
        self.assertEqual(len(vertices), len(np.unique(triangles)))      # sewn points once
        np.testing.assert_allclose(vertices[faces], self.group["positions"][-1][triangles], atol=GRID)
        np.testing.assert_allclose(texture, self.file["VTKHDF/PointData/panel_coordinates"][()], atol=1e-5)
        with open(self.path("final.obj")) as file:
            corners = [[int(w.split("/")[1]) - 1 for w in line.split()[1:]] for line in file if line[0] == "f"]
        np.testing.assert_allclose(texture[corners], self.group["rest_corners"][()], atol=1e-5)
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        uses = np.unique(edges, axis=0, return_counts=True)[1]
        self.assertEqual(uses.max(), 2)
        self.assertLess(np.count_nonzero(uses == 1), 250)               # neck, hem and cuffs; seams are closed

    def test_body_obj_is_a_closed_body_of_a_person(self):
        names, vertices, _, faces = read_obj(self.path("body.obj"))
        self.assertEqual(len(names), 1)
        self.assertTrue(1.4 < np.ptp(vertices[:, 2]) < 2.1)
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        self.assertEqual(set(map(tuple, edges)), set(map(tuple, edges[:, ::-1])))

    def test_run_xdmf_addresses_data_that_run_h5_holds(self):
        for name in ["run", "sewing"]:
            with self.subTest(name), h5py.File(self.path(name + ".h5"), "r") as file:
                root = xml.parse(self.path(name + ".xdmf")).getroot()
                self.assertEqual(root.tag, "Xdmf")
                frames = root.findall("./Domain/Grid[@CollectionType='Temporal']/Grid")
                np.testing.assert_allclose([float(f.find("Time").get("Value")) for f in frames],
                                           file["selvage/time"][()], atol=1e-6)
                for item in root.iter("DataItem"):
                    if item.get("Format") == "XML":
                        continue
                    place, _, selection = item.text.strip().partition("|")
                    target, _, dataset = place.partition(":")
                    self.assertEqual(target, name + ".h5")
                    dims = [int(n) for n in item.get("Dimensions").split()]
                    if not selection:
                        self.assertEqual(file[dataset].size, np.prod(dims))
                        continue
                    start, stride, count, whole = ([int(n) for n in re.split(r"\s+", part)]
                                                   for part in selection.split(":"))
                    self.assertEqual((stride, count), ([1, 1], dims))
                    self.assertEqual(tuple(whole), file[dataset].shape)
                    self.assertLessEqual(start[0] + count[0], whole[0])
                    rows, array = item.findall("DataItem")   # the same for readers of the other kind
                    self.assertEqual([int(n) for n in rows.text.split()], start + stride + count)
                    self.assertEqual([int(n) for n in array.get("Dimensions").split()], whole)

    def test_vtk_reads_every_frame_by_either_name_of_the_trajectory(self):
        try:
            import vtk
            from vtk.util.numpy_support import vtk_to_numpy
        except ImportError:
            self.skipTest("no VTK for Python")
        for name in ["run", "sewing"]:
            with h5py.File(self.path(name + ".h5"), "r") as file:
                positions, times = file["selvage/positions"][()], file["selvage/time"][()]
                corners = file["VTKHDF/CellData/rest_corners"][()]
            self.assertTrue(os.path.samefile(self.path(name + ".h5"), self.path(name + ".vtkhdf")))
            for reader, path in [(vtk.vtkHDFReader(), name + ".vtkhdf"), (vtk.vtkXdmfReader(), name + ".xdmf")]:
                reader.SetFileName(self.path(path))
                reader.UpdateInformation()
                for frame, time in enumerate(times):
                    reader.UpdateTimeStep(time)
                    mesh = reader.GetOutputDataObject(0)
                    self.assertEqual(mesh.GetNumberOfCells(), len(corners), path)
                    np.testing.assert_array_equal(vtk_to_numpy(mesh.GetPoints().GetData()), positions[frame], path)
                if path.endswith(".vtkhdf"):
                    found = vtk_to_numpy(mesh.GetCellData().GetArray("rest_corners"))
                    np.testing.assert_array_equal(found, corners)

    def test_progress_is_one_json_object_per_line(self):
        with open(self.path("progress.jsonl")) as file:
            lines = [json.loads(line) for line in file]
        self.assertGreater(len(lines), 10)
        self.assertEqual({"sew", "drape"} - {line["phase"] for line in lines}, set())


class Leftovers(unittest.TestCase):
    """Settings decide which files a run leaves."""

    SCENE = ["builtin:sphere", "--set", "sheet.resolution=5", "--set", "solver.until=0.1"]

    def test_picture_and_checkpoint_appear_when_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            result = drape(folder, *self.SCENE, "--set", "output.picture_width=64",
                           "--set", "output.keep_checkpoint=true")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue(os.path.exists(os.path.join(folder, "checkpoint.h5")))
            with open(os.path.join(folder, "preview.png"), "rb") as file:
                self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
            self.assertEqual([name for name in os.listdir(folder) if "tmp" in name or name.endswith("~")], [])

    def test_the_last_frame_is_at_the_end_of_the_time_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            result = drape(folder, *self.SCENE, "--set", "output.picture=false")
            self.assertEqual(result.returncode, 0, result.stderr)
            with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
                times, positions = file["selvage/time"][()], file["selvage/positions"][()]
            self.assertAlmostEqual(times[-1], 0.1, delta=1e-6)
            for frame in range(1, len(times)):
                self.assertTrue(np.any(positions[frame] != positions[frame - 1]), f"frame {frame} repeats another")

    def test_a_scene_without_bodies_and_seams_leaves_neither_file(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ["sewing.h5", "body.obj", "preview.png"]:
                open(os.path.join(folder, name), "w").close()
            result = drape(folder, "builtin:hanging", "--set", "sheet.resolution=5", "--set", "solver.until=0.1",
                           "--set", "output.picture=false", "--set", "output.precision=lossless",
                           "--set", "output.frames=false")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual({"sewing.h5", "body.obj", "preview.png"} & set(os.listdir(folder)), set())
            with h5py.File(os.path.join(folder, "run.h5"), "r") as file:
                self.assertEqual(file["selvage/positions"].shape, (1, 25, 3))


if __name__ == "__main__":
    unittest.main()
