"""What is found in the OBJ files of sheets, bodies and sequences of bodies, and what is made of them."""
import json
import math
import os
import subprocess
import unittest

from scratch import Scratch

PROGRAM = os.environ["SELVAGE"]
QUIET = "[output]\npicture = false\n[solver]\nuntil = 0.05\n"
CUBE_FACES = ["f 1 4 3 2", "f 5 6 7 8", "f 1 2 6 5", "f 2 3 7 6", "f 3 4 8 7", "f 4 1 5 8"]


def vertex(x, y, z):
    return f"v {x:.9g} {y:.9g} {z:.9g}"


def cube(low=(-0.1, -0.1, 0), size=0.2, faces=None, first=1):
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    lines = [vertex(*(l + size * c for l, c in zip(low, corner))) for corner in corners]
    for face in faces or CUBE_FACES:
        lines.append("f " + " ".join(str(int(k) + first - 1) for k in face.split()[1:]))
    return lines


def grid(n=4, size=0.4):
    """n x n quads around the origin at height 0."""
    at = [(size * (i / n - 0.5), size * (j / n - 0.5)) for j in range(n + 1) for i in range(n + 1)]
    quads = [(j * (n + 1) + i + 1, j * (n + 1) + i + 2, (j + 1) * (n + 1) + i + 2, (j + 1) * (n + 1) + i + 1)
             for j in range(n) for i in range(n)]
    return at, quads


def ball(rings=8, sectors=12, radius=0.1, centre=(0, 0, 0), swap=None):
    points = [(0, 0, 1)]
    points += [(math.sin(math.pi * r / rings) * math.cos(2 * math.pi * s / sectors),
                math.sin(math.pi * r / rings) * math.sin(2 * math.pi * s / sectors), math.cos(math.pi * r / rings))
               for r in range(1, rings) for s in range(sectors)] + [(0, 0, -1)]
    points = [tuple(c + radius * x for c, x in zip(centre, p)) for p in points]
    if swap:
        points = [points[(swap * k) % len(points)] for k in range(len(points))]
    lines = [vertex(*p) for p in points]
    at = lambda r, s: 2 + (r - 1) * sectors + s % sectors
    last = len(points)
    for s in range(sectors):
        lines += [f"f 1 {at(1, s)} {at(1, s + 1)}", f"f {last} {at(rings - 1, s + 1)} {at(rings - 1, s)}"]
        lines += [f"f {at(r, s)} {at(r + 1, s)} {at(r + 1, s + 1)} {at(r, s + 1)}" for r in range(1, rings - 1)]
    return lines


class MeshInput(Scratch):
    def run_on(self, command, scene, *more):
        path = self.write("scene.toml", scene)
        return subprocess.run([PROGRAM, command, path, *more], capture_output=True, text=True, timeout=120)

    def found(self, scene):
        """The findings of `check` by kind."""
        result = self.run_on("check", scene, "--json")
        self.assertIn(result.returncode, [0, 2], result.stderr)
        self.assertTrue(result.stdout, result.stderr)
        told = json.loads(result.stdout)
        self.assertEqual(result.returncode, 0 if told["clean"] else 2)
        return {finding["kind"]: finding["text"] for finding in told["findings"]}, told["clean"]

    def refused(self, scene, *words):
        for command in [["check"], ["drape", "-o", self.path("out")]]:
            result = self.run_on(command[0], scene, *command[1:])
            self.assertEqual(result.returncode, 2, result.stderr + result.stdout)
            for word in words:
                self.assertIn(word, result.stderr)

    def drape(self, scene, *more):
        return self.run_on("drape", scene + QUIET, "-o", self.path("out"), *more)

    def positions(self, name="out/final.obj"):
        with open(self.path(name)) as file:
            return [[float(x) for x in line.split()[1:4]] for line in file if line.startswith("v ")]


class Sheets(MeshInput):
    SCENE = '[[sheet]]\nshape = "mesh"\nmesh = "sheet.obj"\n'

    def sheet(self, more=(), texture=None):
        at, faces = grid()
        lines = [vertex(x, y, 0) for x, y in at] + list(more)
        if texture:
            lines += [f"vt {texture * x:.9g} {texture * y:.9g}" for x, y in at]
        corner = (lambda k: f"{k}/{k}") if texture else str
        return self.write("sheet.obj", lines + ["f " + " ".join(map(corner, q)) for q in faces])

    def test_a_sheet_stays_where_its_file_has_it_unless_it_is_moved(self):
        self.sheet()
        self.assertEqual(self.drape(self.SCENE + '[pins]\nsheet = "corners"\n').returncode, 0)
        self.assertAlmostEqual(self.positions()[0][2], 0, delta=1e-4)
        self.assertEqual(self.drape(self.SCENE + 'center = [0, 0, 3]\n[pins]\nsheet = "corners"\n').returncode, 0)
        self.assertAlmostEqual(self.positions()[0][2], 3, delta=1e-4)

    def test_a_vertex_without_a_face_is_left_out_and_told(self):
        self.sheet(["v 1e8 0 0"])
        findings, clean = self.found(self.SCENE)
        self.assertRegex(findings["unused_vertex"], r"sheet\.obj:26: vertex 26 .*left out")
        self.assertTrue(clean)
        self.assertEqual(self.drape(self.SCENE).returncode, 0)
        self.assertEqual(len(self.positions()), 25)

    def test_triangles_that_share_no_vertices_are_told_and_joined_on_request(self):
        at, quads = grid()
        lines, faces = [], []
        for a, b, c, d in quads:
            for triangle in [(a, b, c), (a, c, d)]:
                lines += [vertex(*at[k - 1], 0) for k in triangle]
                faces.append(f"f {len(lines) - 2} {len(lines) - 1} {len(lines)}")
        self.write("sheet.obj", lines + faces)
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertRegex(findings["coincident_vertices"],
                         r"sheet\.obj:4: 71 vertices .* vertex 4 on vertex 1.*32 pieces")
        self.assertIn('weld = "exact"', findings["coincident_vertices"])
        self.assertNotIn("coincident_vertices", self.found(self.SCENE + 'weld = "exact"\n')[0])
        self.assertEqual(self.drape(self.SCENE + "weld = 1e-6\n").returncode, 0)
        self.assertEqual(len(self.positions()), 25)

    def cut_grid(self, shift):
        """A grid cut in the middle, its right half moved in the texture."""
        at, quads = grid()
        cut = [k for k, (x, y) in enumerate(at) if abs(x) < 1e-9]
        lines = [vertex(x, y, 0) for x, y in at] + [vertex(*at[k], 0) for k in cut]
        lines += [f"vt {x + (shift if x > 1e-9 else 0):.9g} {y:.9g}" for x, y in at]
        lines += [f"vt {at[k][0] + shift:.9g} {at[k][1]:.9g}" for k in cut]
        for quad in quads:
            right = max(at[k - 1][0] for k in quad) > 1e-9
            own = [len(at) + cut.index(k - 1) + 1 if right and k - 1 in cut else k for k in quad]
            lines.append("f " + " ".join(f"{k}/{k}" for k in own))
        return self.write("sheet.obj", lines)

    def test_a_cut_in_the_texture_is_a_seam_that_holds(self):
        self.cut_grid(0.05)
        findings, clean = self.found(self.SCENE)
        self.assertTrue(clean, findings)
        self.assertIn("5 vertices are joined", findings["weld"])
        pinned = self.SCENE + '[pins]\nsheet = "left_edge"\n'
        self.assertEqual(self.drape(pinned, "--set", "solver.until=0.5").returncode, 0)
        self.assertGreater(min(x[2] for x in self.positions()), -0.45)     # what is loose has fallen by 1.2 m
        findings, clean = self.found(self.SCENE + 'weld = "none"\n')
        self.assertFalse(clean)
        self.assertIn("2 pieces", findings["coincident_vertices"])

    def test_several_texture_coordinates_at_a_vertex_make_the_same_seam(self):
        at, quads = grid()
        lines = [vertex(x, y, 0) for x, y in at]
        for quad in quads:
            right = max(at[k - 1][0] for k in quad) > 1e-9
            lines += [f"vt {at[k - 1][0] + 0.05 * right:.9g} {at[k - 1][1]:.9g}" for k in quad]
            lines.append("f " + " ".join(f"{k}/{n}" for k, n in zip(quad, [-4, -3, -2, -1])))
        self.write("sheet.obj", lines)
        self.assertEqual(self.found(self.SCENE), ({}, True))
        self.assertEqual(self.drape(self.SCENE + '[pins]\nsheet = "left_edge"\n').returncode, 0)

    def test_texture_coordinates_in_another_unit_are_told_with_the_unit_that_fits(self):
        self.sheet(texture=100)
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertIn("1e+04 times", findings["rest_area"])
        self.assertIn('texture_unit = "cm"', findings["rest_area"])
        self.assertEqual(self.found(self.SCENE + 'texture_unit = "cm"\n'), ({}, True))

    def test_a_vertex_on_the_edge_of_other_faces_is_told(self):
        self.sheet(["v 0.2 -0.15 0", "v 0.3 -0.2 0", "f 26 5 27 10"])
        self.assertRegex(self.found(self.SCENE)[0]["vertex_on_edge"],
                         r"sheet\.obj:26: .*vertex 26 on the edge from vertex 5 to 10")

    def test_a_face_with_a_corner_twice_is_refused_with_its_line(self):
        self.sheet(["f 4 5 5 10"])
        self.refused(self.SCENE, "sheet.obj:26:", "vertex 5 twice")

    def test_another_unit_is_told_with_what_each_would_mean(self):
        at, quads = grid(size=40)
        self.write("sheet.obj", [vertex(x, y, 0) for x, y in at] + ["f " + " ".join(map(str, q)) for q in quads])
        self.assertIn("0.4 m as cm", self.found(self.SCENE)[0]["unit"])

    def test_pins_keep_the_numbers_of_the_file(self):
        self.write("sheet.obj", ["v 9 9 9"] + [vertex(x, y, 0) for x, y in grid()[0]] +
                   ["f " + " ".join(str(k + 1) for k in q) for q in grid()[1]])
        self.assertEqual(self.drape(self.SCENE + '[pins]\nvertices = "1, 5"\n').returncode, 0)
        x = self.positions()
        self.assertAlmostEqual(x[0][2], 0, delta=1e-4)
        self.assertAlmostEqual(x[4][2], 0, delta=1e-4)
        self.assertLess(x[24][2], -1e-3)
        self.refused(self.SCENE + '[pins]\nvertices = "0"\n', "pins.vertices", "a face uses")

    def loose(self, apart=0):
        """A sheet of four quads, each with its own corners: the left ones end at -apart / 2, the others begin there."""
        lines = []
        for i, j in [(0, 0), (1, 0), (0, 1), (1, 1)]:
            left, right = ([-0.2, -apart / 2] if i == 0 else [apart / 2, 0.2])
            lines += [vertex(left, 0.2 * j, 0), vertex(right, 0.2 * j, 0), vertex(right, 0.2 * j + 0.2, 0),
                      vertex(left, 0.2 * j + 0.2, 0)]
        return lines + [f"f {4 * k + 1} {4 * k + 2} {4 * k + 3} {4 * k + 4}" for k in range(4)]

    def test_every_vertex_of_the_file_can_be_held_though_it_is_joined_to_another(self):
        self.write("sheet.obj", self.loose())
        for number in [12, 14]:                 # the last quad's corner in the middle, and one beside it
            scene = self.SCENE + f'weld = "exact"\n[pins]\nvertices = "{number}"\n'
            self.assertEqual(self.drape(scene).returncode, 0)
            held = [x for x in self.positions() if abs(x[2]) < 1e-6]
            self.assertEqual(len(held), 1, number)
            self.assertAlmostEqual(math.dist(held[0], [0 if number == 12 else 0.2, 0.4 if number == 14 else 0.2, 0]), 0,
                                   places=5)

    def test_vertices_as_far_apart_as_weld_says_are_joined_wherever_they_lie(self):
        self.write("sheet.obj", self.loose(0.001))
        told = self.found(self.SCENE + 'weld = "0.001"\n')[0]["weld"]
        self.assertIn("7 vertices are joined to others within 0.001 m", told)
        told = self.found(self.SCENE + 'weld = "0.0009"\n')[0]["weld"]
        self.assertIn("4 vertices are joined to others within 0.0009 m", told)      # those of one place

    def test_a_distance_that_would_join_the_corners_of_a_face_is_refused_with_its_line(self):
        lines = self.loose()
        self.write("sheet.obj", lines + [vertex(0.2, 0, 0), vertex(0.201, 0, 0), vertex(0.2, 0.2, 0), "f 17 18 19"])
        self.refused(self.SCENE + 'weld = "0.002"\n', "sheet[0].weld", "face at line 24 would lose its area")


class Bodies(MeshInput):
    SCENE = '[[sheet]]\nwidth = 0.5\nheight = 0.5\nresolution = 9\ncenter = [0, 0, 0.6]\n[[body]]\nmesh = "body.obj"\n'

    def test_a_good_body_is_clean_however_its_text_is_written(self):
        for text in ["\n".join(cube()), "\ufeff" + "\r".join(cube()), "\r\n".join(cube()).replace(" ", "\u00a0")]:
            self.write("body.obj", text)
            self.assertEqual(self.found(self.SCENE), ({}, True))

    def test_a_vertex_without_a_face_does_not_make_a_body_large(self):
        self.write("body.obj", ["v 1e8 0 0"] + cube(first=2))
        findings, clean = self.found(self.SCENE)
        self.assertEqual(list(findings), ["unused_vertex"])
        self.assertTrue(clean)

    def test_a_concave_face_gives_the_same_body_from_every_corner(self):
        outline = [(-0.2, -0.2), (0.2, -0.2), (0.2, 0), (0, 0), (0, 0.2), (-0.2, 0.2)]
        points = [vertex(x, y, z) for z in [0.1, 0.3] for x, y in outline]
        sides = [f"f {k + 1} {(k + 1) % 6 + 1} {(k + 1) % 6 + 7} {k + 7}" for k in range(6)]
        ends = set()
        for start in range(6):
            roof = "f " + " ".join(str(7 + (start + k) % 6) for k in range(6))
            self.write("body.obj", points + sides + [roof, "f 6 5 4 3 2 1"])
            self.assertEqual(self.found(self.SCENE), ({}, True))
            self.assertEqual(self.drape(self.SCENE).returncode, 0)
            with open(self.path("out/body.obj")) as file:
                ends.add(file.read())
        self.assertEqual(len(ends), 1)

    def test_a_piece_inside_out_is_named(self):
        inward = ["f " + " ".join(reversed(face.split()[1:])) for face in CUBE_FACES]
        self.write("body.obj", cube(size=0.3) + ["o small"] + cube((0.4, 0, 0.1), 0.1, inward, first=9))
        self.refused(self.SCENE, "body.obj:24:", "piece 2 of 2", "`small`", "inside out")

    def test_a_cavity_is_no_piece_inside_out(self):
        inward = ["f " + " ".join(reversed(face.split()[1:])) for face in CUBE_FACES]
        self.write("body.obj", cube(size=0.3) + cube((0, 0, 0.1), 0.1, inward, first=9))
        findings, clean = self.found(self.SCENE)
        self.assertIn("cavity", findings)
        self.assertTrue(clean)

    def test_a_body_that_crosses_itself_is_told(self):
        lines = ball()
        lines[0] = vertex(0, 0, -0.15)     # the north pole, drawn through the south pole
        self.write("body.obj", lines)
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertRegex(findings["body_self_intersection"],
                         r"body\.obj:\d+: .*the face at line \d+ and the face at line \d+")

    def test_holes_are_placed_counted_and_closed_on_request(self):
        self.write("body.obj", cube(faces=CUBE_FACES[:5]))
        self.refused(self.SCENE, "1 hole in 1 piece", "rim of 0.8 m", "close_holes = 0.81")
        self.refused(self.SCENE + "close_holes = 0.7\n", "1 hole")
        findings, clean = self.found(self.SCENE + "close_holes = 0.81\n")
        self.assertTrue(clean)
        self.assertIn("1 hole of", findings["holes"])
        self.assertIn("2 triangles of 0.04 m^2", findings["holes"])

    def test_lengths_about_a_body_that_is_scaled_are_those_in_the_scene(self):
        self.write("body.obj", cube((-10, -10, 0), 20, faces=CUBE_FACES[:5]))
        scaled = self.SCENE + "scale = 0.01\n"
        self.refused(scaled, "rim of 0.8 m", "close_holes = 0.81 ")
        self.assertIn("2 triangles of 0.04 m^2", self.found(scaled + "close_holes = 0.81\n")[0]["holes"])
        self.refused(scaled + 'weld = "0.09"\nclose_holes = 0.7\n', "1 hole")     # its edges are 0.2 m long

    def test_a_wall_within_a_body_is_no_face_the_wrong_way(self):
        top = ["v -0.1 -0.1 0.4", "v 0.1 -0.1 0.4", "v 0.1 0.1 0.4", "v -0.1 0.1 0.4"]
        upper = ["f 9 10 11 12", "f 5 6 10 9", "f 6 7 11 10", "f 7 8 12 11", "f 8 5 9 12"]
        self.write("body.obj", cube() + top + upper)
        self.refused(self.SCENE, "body.obj:10:", "more than two faces", "from vertex 5 to 6", "inner walls")

    def test_a_body_of_loose_triangles_is_joined_on_request(self):
        corners = [line for line in cube() if line[0] == "v"]
        lines = [corners[int(k) - 1] for face in CUBE_FACES for k in face.split()[1:]]
        self.write("body.obj", lines + [f"f {4 * k + 1} {4 * k + 2} {4 * k + 3} {4 * k + 4}" for k in range(6)])
        self.refused(self.SCENE, "6 holes", 'body[0].weld = "exact"')
        self.assertTrue(self.found(self.SCENE + 'weld = "exact"\n')[1])

    def test_sizes_from_2_cm_to_20_m_are_taken_and_odd_ones_told_with_every_unit(self):
        for size, unit, clean in [(0.02, None, False), (0.2, None, True), (17, None, False), (19, "m", True)]:
            self.write("body.obj", cube((0, 0, 0), size))
            scene = self.SCENE.replace("0.6]", f"{size + 0.2}]") + (f'unit = "{unit}"\n' if unit else "")
            findings, told_clean = self.found(scene)
            self.assertEqual(told_clean, clean, (size, findings))
            if size == 17:
                self.assertIn("1.7 m as dm", findings["unit"])
                self.assertEqual(self.drape(scene).returncode, 0)
        self.write("body.obj", cube((0, 0, 0), 170))
        self.refused(self.SCENE, "measures 170 m", "1.7 m as cm")

    def test_a_sheet_below_and_beside_all_bodies_is_told(self):
        self.write("body.obj", cube())
        for center, word in [("[0, 0, -3]", "below it"), ("[4, 0, 0.1]", "beside it")]:
            findings, clean = self.found(self.SCENE.replace("[0, 0, 0.6]", center))
            self.assertFalse(clean)
            self.assertIn(word, findings["away"])
            self.assertIn("sheet[0].center", findings["away"])

    def test_cloth_too_far_out_for_single_precision_is_told(self):
        for far, told in [(100, False), (1000, True), (1e6, True)]:
            sheet = f"[[sheet]]\nwidth = 0.2\nheight = 0.2\nresolution = 9\ncenter = [{far}, 0, 0.2]\n"
            findings, _ = self.found(sheet)
            self.assertEqual("far" in findings, told, far)

    def test_what_cannot_end_well_is_told_as_a_fault(self):
        sheet = "[[sheet]]\nwidth = 0.2\nheight = 0.2\nresolution = 9\ncenter = [1e6, 0, 0.2]\n"
        told = json.loads(self.run_on("check", sheet, "--json").stdout)["findings"]
        self.assertEqual([finding["severity"] for finding in told if finding["kind"] == "far"], ["fault"])
        self.assertIn("fault: far: ", self.run_on("check", sheet).stdout)


class Sequences(MeshInput):
    SCENE = ('[[sheet]]\nwidth = 0.3\nheight = 0.3\nresolution = 9\ncenter = [0.06, 0, 0.24]\n'
             '[[body]]\nsequence = "pose_*.obj"\nsequence_rate = 10\n')

    def poses(self, numbers, pose):
        for number in numbers:
            self.write(f"pose_{number}.obj", pose(number))

    def test_poses_are_taken_by_number(self):
        self.poses(range(1, 13), lambda n: ball(centre=(0.01 * n, 0, 0)))
        self.assertEqual(self.found(self.SCENE), ({}, True))
        scene = self.SCENE + "[output]\npicture = false\n[solver]\nuntil = 0.1\n"
        self.assertEqual(self.run_on("drape", scene, "-o", self.path("out")).returncode, 0)
        self.assertAlmostEqual(self.positions("out/body.obj")[0][0], 0.02, places=6)

    def test_a_missing_number_is_told(self):
        self.poses([1, 2, 3, 5, 6], lambda n: ball(centre=(0.01 * n, 0, 0)))
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertIn("between `pose_3.obj` and `pose_5.obj`", findings["sequence_gap"])
        self.poses([4], lambda n: ball())
        self.write("pose_04.obj", ball())
        self.refused(self.SCENE, "same number")

    def test_poses_that_are_no_motion_are_refused_by_name(self):
        def mirrored(lines):
            return [vertex(-float(w[1]), float(w[2]), float(w[3])) if (w := line.split())[0] == "v" else line
                    for line in lines]

        pressed = [line if line[0] == "f" else " ".join(line.split()[:3] + ["0"]) for line in ball()]
        for pose, words in [(mirrored(ball()), ["inside out"]), (ball(radius=10), ["100 times as large"]),
                            (pressed, ["flat"]),
                            (ball(swap=37), ["another order"]), (ball(sectors=11), ["numbered as there"])]:
            self.poses([1, 3], lambda n: ball())
            self.write("pose_2.obj", pose)
            self.refused(self.SCENE, "pose_2.obj", *words)

    def test_a_fault_of_a_pose_is_told_with_its_line_in_that_pose(self):
        self.poses([1], lambda n: ball())
        lines = ball()
        lines[1] = lines[2]                     # a corner of the first face lies on another
        self.write("pose_2.obj", ["# a line more"] + lines)
        first = 1 + lines.index("f 1 2 3")
        self.refused(self.SCENE, f"pose_2.obj:{first + 1}:", "without area")

    def test_a_thin_body_that_bulges_the_other_way_does_not_turn(self):
        def bulged(side):
            def moved(x, y, z):
                return vertex(x, y, 0.1 * z + 0.3 * side * (0.5 - (x * x + y * y) / 0.01) * 0.1)
            return [moved(*map(float, line.split()[1:])) if line[0] == "v" else line for line in ball()]
        self.poses([1, 2], lambda n: bulged(1 if n == 1 else -1))
        self.assertNotIn("pose", self.found(self.SCENE)[0])

    def test_a_jump_is_told(self):
        self.poses([1, 2, 3], lambda n: ball(centre=(5 * (n == 2), 0, 0)))
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertIn("jumps by 5 m", findings["pose"])

    def test_vertices_that_are_exchanged_are_named(self):
        self.poses([1, 2], lambda n: ball())
        lines = ball()
        lines[13], lines[55] = lines[55], lines[13]     # almost opposite
        self.write("pose_2.obj", lines)
        findings, clean = self.found(self.SCENE)
        self.assertFalse(clean)
        self.assertIn("exchanged", findings["pose"])


class Speed(MeshInput):
    def test_examining_a_garment_around_a_body_takes_seconds(self):
        result = subprocess.run([PROGRAM, "check", "builtin:tshirt"], capture_output=True, text=True, timeout=30)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()
