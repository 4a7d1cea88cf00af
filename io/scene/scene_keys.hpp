#pragma once
// Every key of a scene file, declared once: the scene's structs, their defaults, the reader, its range checks
// and `selvage schema` all come from these lists.
// clang-format off
//     KEY(type, name, default, unit, low, high, meaning)    a number or a flag in [low, high]
//     WORD(name, default, meaning)                          any text
//     CHOICE(name, type, default, meaning)                  one of the words of an enumeration in io/choices.hpp
//     VEC3(name, x, y, z, unit, meaning)                    three numbers
//     CURVE(name, number, measure, meaning)                 measured points [[strain, stress], ...] for `number`
// A default of `automatic` means: not given, chosen by the program.
// clang-format on

#define GARMENT_KEYS(KEY, WORD, CHOICE, VEC3)                                                                        \
    WORD(pattern, "", "pattern file (GarmentCode JSON), or a built-in pattern as builtin:tshirt")                    \
    KEY(double, resolution, 0.01, "m", 1e-4, 0.2, "target edge length of the triangles")                             \
    WORD(fabric, "cotton", "fabric of all panels: a preset's name or a [fabric.NAME] table")                         \
    CHOICE(size, BodySize, M, "mannequin for which a built-in pattern is drafted; not given: the scene's own body")  \
    CHOICE(up_axis, PatternAxis, automatic, "up direction of the pattern file; auto: y for GarmentCode JSON")        \
    CHOICE(rotation_order, RotationOrder, xyz,                                                                       \
           "order in which a GarmentCode panel's rotations are applied; xyz means R = Rz Ry Rx")                     \
    CHOICE(                                                                                                          \
        arrange, ArrangementChoice, automatic,                                                                       \
        "panels are placed on the body by their names and seams: automatic, where the pattern gives them no place, " \
        "or always, or never; [garment.parts] says what names do not")                                               \
    VEC3(translation, 0, 0, 0, "m", "moves the whole garment after reading")                                         \
    KEY(int, copies, 1, "1", 1, 64, "how many of the garment there are")                                             \
    VEC3(copy_offset, 0, 0, 1, "m", "way from one copy to the next")

// [[garment.elastic]]: bands that are sewn, stretched, to edges of a panel.
#define ELASTIC_KEYS(KEY, WORD, CHOICE, VEC3)                                                    \
    WORD(panel, "", "panel to whose edges elastic is sewn")                                      \
    WORD(edges, "", "indices of these edges, from 0 as in the pattern, separated by commas")     \
    KEY(double, length, 0.8, "1", 0.1, 1, "length of the elastic at rest over that of the edge") \
    KEY(double, stiffness, 20, "N", 1e-3, 1e5, "tension of the elastic at twice its length")

#define SHEET_KEYS(KEY, WORD, CHOICE, VEC3)                                                                            \
    WORD(name, "", "name in messages, of its pins and in final.obj; none: sheet[0], sheet[1] ...")                     \
    CHOICE(shape, SheetShape, rectangle, "outline of the sheet")                                                       \
    WORD(mesh, "", "OBJ file of the sheet (shape = mesh); texture coordinates give its rest shape")                    \
    KEY(double, width, 1, "m", 1e-3, 100, "extent along weft (rectangle)")                                             \
    KEY(double, height, 1, "m", 1e-3, 100, "extent along warp (rectangle)")                                            \
    KEY(double, radius, 0.15, "m", 1e-3, 100, "radius (disc)")                                                         \
    KEY(int, resolution, 65, "1", 2, 4097, "vertices per side; across the diameter for a disc")                        \
    CHOICE(                                                                                                            \
        mesh_family, MeshFamily, automatic,                                                                            \
        "triangles: alternating (automatic) to irregular for a rectangle; panel (automatic), equilateral, square or "  \
        "irregular for a disc")                                                                                        \
    WORD(fabric, "cotton", "a preset's name or a [fabric.NAME] table")                                                 \
    CHOICE(unit, LengthUnit, m, "length unit of the mesh file")                                                        \
    CHOICE(texture_unit, LengthUnit, m, "length unit of the mesh file's texture coordinates")                          \
    CHOICE(up_axis, Axis, z, "up direction of the mesh file")                                                          \
    WORD(weld, "seams",                                                                                                \
         "which vertices of the mesh file are joined: seams, those on each other where texture coordinates differ; "   \
         "none; exact, all that lie on each other; or all within a distance [m]")                                      \
    VEC3(center, 0, 0, 1, "m", "where the middle of the sheet starts; a mesh without it starts where its file has it") \
    VEC3(rotation, 0, 0, 0, "degrees",                                                                                 \
         "turns about the middle, about x, then y, then z; without them a rectangle or disc lies flat")

#define BODY_KEYS(KEY, WORD, CHOICE, VEC3)                                                                            \
    WORD(name, "", "name in messages and in body.obj")                                                                \
    CHOICE(shape, BodyShape, mesh, "kind of body")                                                                    \
    WORD(mesh, "", "OBJ file (shape = mesh)")                                                                         \
    CHOICE(unit, LengthUnit, m, "length unit of the mesh file")                                                       \
    CHOICE(up_axis, Axis, z, "up direction of the mesh file")                                                         \
    VEC3(center, 0, 0, 0, "m",                                                                                        \
         "centre (sphere, cylinder, torus), a point (plane), first end (capsule), middle of the base (cone), shift "  \
         "(mesh, mannequin)")                                                                                         \
    VEC3(end, 0, 0, 1, "m", "second end (capsule)")                                                                   \
    VEC3(normal, 0, 0, 1, "1", "upward normal (plane), axis (torus)")                                                 \
    VEC3(rotation, 0, 0, 0, "degrees", "turns about x, then y, then z (mesh, mannequin)")                             \
    KEY(double, scale, 1, "1", 1e-4, 1e4, "scales the mesh")                                                          \
    WORD(weld, "none",                                                                                                \
         "which vertices of the mesh file are joined: none; exact, all that lie on each other; or all within a "      \
         "distance [m]")                                                                                              \
    KEY(double, close_holes, 0, "m", 0, 100, "closes holes of the mesh whose rim is at most this long")               \
    KEY(double, radius, 0.25, "m", 1e-4, 100,                                                                         \
        "radius (sphere, capsule, cylinder), of the base (cone), of the circle in the middle of the tube (torus)")    \
    KEY(double, height, 0.1, "m", 1e-4, 100, "height of an upright cylinder or cone")                                 \
    KEY(double, tube, 0.02, "m", 1e-4, 100, "radius of the tube (torus)")                                             \
    KEY(double, friction, automatic, "1", 0, 10, "Coulomb coefficient; automatic: the fabric's")                      \
    CHOICE(size, BodySize, M,                                                                                         \
           "mannequin size, of a child by its stature in cm; not given: garment.size; single measurements below "     \
           "override it")                                                                                             \
    CHOICE(figure, BodyFigure, automatic,                                                                             \
           "mannequin: whose table of sizes and whose build; automatic: women's, of sizes that begin with child "     \
           "children's")                                                                                              \
    KEY(double, stature, automatic, "m", 0.8, 2.5, "mannequin: body height")                                          \
    KEY(double, bust, automatic, "m", 0.4, 2, "mannequin: bust girth")                                                \
    KEY(double, waist, automatic, "m", 0.3, 2, "mannequin: waist girth")                                              \
    KEY(double, hips, automatic, "m", 0.4, 2, "mannequin: hip girth")                                                 \
    KEY(double, shoulder_width, automatic, "m", 0.2, 0.8, "mannequin: shoulder to shoulder")                          \
    KEY(double, neck, automatic, "m", 0.2, 0.8, "mannequin: neck girth")                                              \
    KEY(double, arm_length, automatic, "m", 0.3, 1.2, "mannequin: shoulder to wrist")                                 \
    KEY(double, arm_angle, automatic, "degrees", 0, 90, "mannequin: arm below the horizontal; 90 hangs down")         \
    CHOICE(interpolation, Interpolation, linear,                                                                      \
           "between two keyframes: at a steady speed, or smoothly from rest to rest as 3 s^2 - 2 s^3")                \
    WORD(sequence, "",                                                                                                \
         "OBJ files of the body's poses, as pose_*.obj, taken by name (shape = mesh); same faces in each, positions " \
         "change linearly from one to the next")                                                                      \
    KEY(double, sequence_rate, 25, "1/s", 0.01, 10000,                                                                \
        "poses per second of the sequence, the first at sequence_start")                                              \
    KEY(double, sequence_start, 0, "s", 0, 1e6, "time at which the sequence begins")

// [[body.keyframe]]: where a body is at a time, relative to how it starts; it stays as at the last one.
#define KEYFRAME_KEYS(KEY, WORD, CHOICE, VEC3)                                                                        \
    KEY(double, time, 0, "s", 0, 1e6, "when the body is there; above that of the keyframe before, which starts at 0") \
    VEC3(translation, 0, 0, 0, "m", "way from where it starts")                                                       \
    VEC3(rotation, 0, 0, 0, "degrees",                                                                                \
         "turns through `center` about x, then y, then z from how it starts; the angles are interpolated, so 720 is " \
         "two turns")                                                                                                 \
    KEY(double, arm_angle, automatic, "degrees", 0, 80, "mannequin: arm below the horizontal; automatic: as before")  \
    WORD(mesh, "", "OBJ file of the pose, with the faces of the body's own (shape = mesh); none: as before")

#define FABRIC_KEYS(KEY, WORD, CHOICE, CURVE)                                                                          \
    WORD(base, "", "preset whose values are used where this table is silent")                                          \
    KEY(double, areal_density, automatic, "kg/m^2", 0.005, 5, "mass per area")                                         \
    KEY(double, thickness, automatic, "m", 1e-5, 0.02, "thickness; default: the base's, else 0.0003")                  \
    KEY(double, stretch_weft, automatic, "N/m", 0.1, 1e7,                                                              \
        "membrane stiffness along weft; with a curve: its slope at 0")                                                 \
    KEY(double, stretch_warp, automatic, "N/m", 0.1, 1e7,                                                              \
        "membrane stiffness along warp; with a curve: its slope at 0")                                                 \
    KEY(double, stretch_coupling, automatic, "N/m", 0, 1e7, "coupling of weft and warp")                               \
    KEY(double, shear, automatic, "N/m", 0, 1e7, "shear stiffness per radian; with a curve: its slope at 0")           \
    CURVE(stretch_weft_curve, stretch_weft, tension,                                                                   \
          "tension along weft in place of stretch_weft: elongation over length [1], force over unstretched width "     \
          "[N/m], as KES-FB1 prints them; read as e = x + x^2/2 (Green-Lagrange) and s = P/(1 + x) (second "           \
          "Piola-Kirchhoff)")                                                                                          \
    CURVE(stretch_warp_curve, stretch_warp, tension, "tension along warp in place of stretch_warp, as for weft")       \
    CURVE(shear_curve, shear, shear,                                                                                   \
          "shear in place of `shear`: angle phi [rad], shear force over length [N/m]; read as g = sin(phi), as of "    \
          "yarns that keep their length, and s = F")                                                                   \
    CHOICE(curve, CurveShape, not_given,                                                                               \
           "between the points of this table's curves: straight, which is the default, or monotone cubic")             \
    KEY(double, stretch_limit, automatic, "1", 0, 10,                                                                  \
        "elongation beyond which weft and warp stiffen; 0, the default: none")                                         \
    KEY(double, shear_limit, automatic, "rad", 0, 1.5,                                                                 \
        "shear angle beyond which shear stiffens; 0, the default: none")                                               \
    KEY(double, stretch_limit_factor, automatic, "1", 1, 1e4, "multiplies the slopes beyond these limits; default 20") \
    KEY(double, bending_weft, automatic, "N m", 0, 1, "bending rigidity along weft")                                   \
    KEY(double, bending_warp, automatic, "N m", 0, 1, "bending rigidity along warp")                                   \
    KEY(double, bending_coupling, automatic, "N m", 0, 1,                                                              \
        "rigidity that couples the curvatures along weft and warp; automatic: 0")                                      \
    KEY(double, bending_twist, automatic, "N m", 0, 1,                                                                 \
        "moment per twist d2z/dxdy; automatic: 2 (sqrt(weft warp) - coupling), as isotropic sheets have")              \
    KEY(double, hysteresis_weft, automatic, "N", 0, 0.1,                                                               \
        "2HB along weft as KES-FB2 measures it: width of the moment loop per width of fabric; 0, the default: none; "  \
        "only with bending.hysteresis")                                                                                \
    KEY(double, hysteresis_warp, automatic, "N", 0, 0.1, "2HB along warp, as for weft")                                \
    KEY(double, friction, automatic, "1", 0, 10, "Coulomb coefficient against a body; default: the base's, else 0.3")  \
    KEY(double, damping, automatic, "1/s", 0, 1000, "viscous drag per unit mass; default: the base's, else 0.5")       \
    WORD(source, "", "where the values come from")

#define SOLVER_KEYS(KEY, WORD, CHOICE, VEC3)                                                                          \
    CHOICE(integrator, IntegratorChoice, automatic,                                                                   \
           "how time is advanced while cloth drapes; static: straight to the shape at rest; the explicit ones "       \
           "(from symplectic_euler to rk4) need short steps and gain energy in contact with bodies")                  \
    WORD(until, "equilibrium", "\"equilibrium\", or the simulated seconds to run")                                    \
    KEY(double, step, 0.02, "s", 1e-6, 1, "time step, twice that towards rest; shrinks where a step fails")           \
    CHOICE(unstable_step, UnstableStep, shrink,                                                                       \
           "what happens to a step above an explicit integrator's stability limit: divided, or an error")             \
    KEY(bool, adaptive, false, "1", 0, 1,                                                                             \
        "steps, of at most solver.step, follow the integrator's estimate of its error")                               \
    KEY(double, step_error, 1e-4, "m", 1e-12, 1, "error of one step that adaptive steps allow")                       \
    KEY(double, step_tolerance, automatic, "1", 1e-6, 1,                                                              \
        "motion until a time: acceleration, over gravity, that implicit steps may leave to find; automatic: 0.1 for " \
        "limp cloth on bodies, 0.01 elsewhere")                                                                       \
    KEY(double, tolerance, 1e-3, "1", 1e-9, 1, "equilibrium: net force over gravity force on free vertices")          \
    KEY(double, energy_tolerance, 1e-4, "1", 0, 1,                                                                    \
        "sewing: relative change of elastic energy between steps at which it may stop")                               \
    KEY(bool, progressive, true, "1", 0, 1,                                                                           \
        "equilibrium: coarser meshes of the cloth are draped first, where that leads to the same rest; `plan` tells") \
    KEY(bool, sleep, true, "1", 0, 1, "equilibrium: what hardly moves on the way to rest sleeps for some steps")      \
    KEY(int, load_steps, 1, "1", 1, 100,                                                                              \
        "equilibrium: the weight grows to its whole in so many steps, with rest after each")                          \
    KEY(double, max_time, 30, "s", 0, 1e6, "simulated time after which a run to equilibrium gives up")                \
    KEY(double, max_wall, 0, "s", 0, 1e7, "wall time after which the run is saved and ends; 0: no limit")             \
    KEY(int, newton_iterations, 40, "1", 1, 1000, "Newton iterations per step before it is retried smaller")          \
    KEY(int, linear_iterations, 600, "1", 1, 100000, "conjugate-gradient iterations per Newton iteration")            \
    CHOICE(preconditioner, PreconditionerChoice, automatic,                                                           \
           "preconditioner of the conjugate gradients; auto: multigrid where levels exist")                           \
    CHOICE(precision, PrecisionChoice, automatic,                                                                     \
           "of the linear solves; automatic: float, but double above 500 000 vertices and for stiff cloth on fine "   \
           "meshes in long steps. State and forces are always double")                                                \
    KEY(int, threads, 0, "1", 0, 1024, "worker threads; 0: all cores")                                                \
    VEC3(gravity, 0, 0, -9.81, "m/s^2", "acceleration")                                                               \
    KEY(double, frame_rate, 30, "1/s", 0.01, 10000, "frames written per simulated second")                            \
    KEY(double, memory_limit, 0, "bytes", 0, 1e15, "refuse scenes that need more; 0: the machine's memory")

#define CONTACT_KEYS(KEY, WORD, CHOICE, VEC3)                                                                         \
    CHOICE(response, ContactResponse, barrier,                                                                        \
           "what keeps surfaces apart. Two are for comparison and do not carry the guarantee that nothing crosses: "  \
           "velocity_rule turns the velocities of vertices on bodies around after each step (no cloth on cloth, no "  \
           "rest to "                                                                                                 \
           "equilibrium); exponential is a bounded force that can be overcome")                                       \
    KEY(double, restitution, automatic, "1", 0, 1,                                                                    \
        "normal velocity of a vertex after an impact over that before; only with response = \"velocity_rule\"; "      \
        "automatic: 0")                                                                                               \
    KEY(double, gap, 0.002, "m", 1e-5, 0.05,                                                                          \
        "distance from the body at which contact pressure sets in, or a vertex bounces off")                          \
    KEY(double, stiffness, automatic, "Pa", 1e-3, 1e9,                                                                \
        "pressure scale of the barrier or the exponential law; automatic: 100 times the cloth's weight per area, or " \
        "what brings it to the speed of the fastest body within the gap if that is more")                             \
    KEY(bool, body, true, "1", 0, 1, "contact between cloth and bodies")                                              \
    KEY(bool, self, true, "1", 0, 1, "contact of the cloth with itself; without it cloth passes through cloth")

#define MEMBRANE_KEYS(KEY, WORD, CHOICE, VEC3)                                                                       \
    CHOICE(                                                                                                          \
        model, MembraneModel, orthotropic,                                                                           \
        "in-plane model of the cloth; springs follow stretch and shear at small strain, coupling becomes the shear " \
        "stiffness")                                                                                                 \
    KEY(double, scale, 1, "1", 0, 1e6, "multiplies every membrane stiffness")

#define BENDING_KEYS(KEY, WORD, CHOICE, VEC3)                                                                         \
    CHOICE(                                                                                                           \
        model, BendingModel, automatic,                                                                               \
        "bending model: plate shows the fabric's rigidity on any mesh, plain hinges err by 0.75 to 3 times, springs " \
        "match it at a curvature of 50/m only; automatic: springs if the membrane is of springs, else plate")         \
    KEY(double, scale, 1, "1", 0, 1e6, "multiplies every bending rigidity")                                           \
    KEY(bool, hysteresis, false, "1", 0, 1,                                                                           \
        "friction as the cloth bends, from the fabrics' hysteresis_weft and hysteresis_warp: folds partly stay; not " \
        "while sewing")

#define SEAMS_KEYS(KEY, WORD, CHOICE, VEC3)                                                                         \
    KEY(double, stiffness, 4e4, "N/m^2", 1e-1, 1e9, "seam force per metre of seam and metre of gap")                \
    KEY(double, force_limit, 1.5, "N/m", 1e-4, 1e6, "seam force per metre of seam where the edges are far apart")   \
    KEY(double, stiffening, 50, "1", 1, 1e6,                                                                        \
        "multiplies bending rigidity while panels are sewn: stiff panels do not fold over")                         \
    KEY(double, closed, 0.002, "m", 1e-6, 0.1, "gap below which a pair of vertices is joined")                      \
    KEY(double, max_time, 20, "s", 0.01, 1e4, "simulated time after which seams that are still open are given up")  \
    KEY(double, thin, 0.75, "1", 0, 0.95,                                                                           \
        "part of its thickness by which a mesh body is thin while seams close around it; 0: as thick as it is")     \
    KEY(double, room, 0.008, "m", 0, 0.05,                                                                          \
        "distance up to which parts of a mesh body at rest that touch, as thighs do, give way where a seam closes " \
        "between them; 0: they do not")

#define PINS_KEYS(KEY, WORD, CHOICE, VEC3)                                                                             \
    CHOICE(sheet, PinGroup, none,                                                                                      \
           "which vertices of each sheet are held; top is +warp, left is -weft, two_rows holds the first two columns " \
           "at the left, center the vertex nearest to the middle; [[pins.hold]] holds those of one sheet or panel")    \
    WORD(vertices, "", "indices of further held vertices of the one sheet there is, separated by commas")

// [[pins.hold]]: vertices of one sheet or panel that are held in place.
#define PIN_HOLD_KEYS(KEY, WORD, CHOICE, VEC3)                                                                      \
    WORD(panel, "", "whose vertices: a sheet's name (sheet[0], sheet[1] ... without one), or a panel of a garment") \
    CHOICE(group, PinGroup, none, "which of them are held, as for pins.sheet")                                      \
    WORD(edges, "",                                                                                                 \
         "indices of edges of a garment's panel that are held, from 0 as in the pattern, separated by commas")      \
    WORD(vertices, "", "indices of further held vertices, from 0 in each panel, separated by commas")

// [[pins.motion]]: vertices that are held and move; several are applied one after the other.
#define PIN_MOTION_KEYS(KEY, WORD, CHOICE, VEC3)                                                                      \
    WORD(panel, "", "whose vertices, as for pins.hold; none: those of every sheet")                                   \
    CHOICE(group, MovingPinGroup, automatic,                                                                          \
           "which vertices move, as for pins.sheet; they are held from the start; automatic: corners, or only the "   \
           "listed vertices and edges")                                                                               \
    WORD(edges, "", "indices of edges of a garment's panel that move, from 0 as in the pattern, separated by commas") \
    WORD(vertices, "", "indices of further vertices that move, from 0 in each panel, separated by commas")            \
    KEY(double, start, 0, "s", 0, 1e6, "when the motion begins")                                                      \
    KEY(double, end, 1, "s", 0, 1e6, "when it ends; the vertices then stay held")                                     \
    VEC3(velocity, 0, 0, 0, "m/s", "of the group while it moves")                                                     \
    KEY(double, turns, 0, "1", -1000, 1000, "whole turns about the axis from start to end, counter-clockwise")        \
    VEC3(axis, 0, 0, 1, "1", "direction of the axis")                                                                 \
    VEC3(point, 0, 0, 0, "m", "a point of the axis")

#define WIND_KEYS(KEY, WORD, CHOICE, VEC3)                                                                             \
    VEC3(velocity, 0, 0, 0, "m/s", "mean velocity of the air")                                                         \
    KEY(bool, still_air, false, "1", 0, 1,                                                                             \
        "air resists the cloth's motion even where it does not move itself; moving air always does")                   \
    KEY(double, density, 1.2, "kg/m^3", 1e-3, 2e3, "of the air")                                                       \
    KEY(double, normal_coefficient, 1.2, "1", 0, 10,                                                                   \
        "pressure along a face's normal over density/2 times the square of the air's velocity along it past the "      \
        "face: drag, and lift on faces that are inclined")                                                             \
    KEY(double, tangential_coefficient, 0.02, "1", 0, 10, "the same in the plane of the face, of both sides together") \
    KEY(double, gust, 0, "m/s", 0, 100,                                                                                \
        "standard deviation of each component of the gusts; not in runs to equilibrium")                               \
    KEY(double, gust_time, 3, "s", 0.01, 1e4, "period of the slowest and strongest waves of the gusts")                \
    KEY(int, seed, 1, "1", 0, 1e9, "of the gusts: the same seed gives the same gusts, whatever the step")

#define OUTPUT_KEYS(KEY, WORD, CHOICE, VEC3)                                                                     \
    CHOICE(precision, PositionGrid, fine_8um, "grid to which written positions are rounded")                     \
    KEY(bool, frames, true, "1", 0, 1, "write every frame; false: only the last one")                            \
    KEY(bool, sewing, true, "1", 0, 1, "write sewing.h5; not where a coarser mesh is sewn (solver.progressive)") \
    KEY(bool, picture, true, "1", 0, 1, "render preview.png")                                                    \
    KEY(int, picture_width, 1600, "1", 64, 16384, "width of preview.png in pixels")                              \
    KEY(int, picture_samples, 3, "1", 1, 64, "rays per pixel and side")                                          \
    KEY(double, checkpoint_interval, 5, "s", 0, 1e6, "wall time between checkpoints")                            \
    KEY(bool, keep_checkpoint, false, "1", 0, 1, "keep the checkpoint at a normal end")

// Tables that may be repeated: TABLE(path, struct, keys, meaning)
#define REPEATED_TABLES(TABLE)                                                                                  \
    TABLE("sheet", SheetScene, SHEET_KEYS, "plain cloth; may be repeated")                                      \
    TABLE("body", BodyScene, BODY_KEYS, "what the cloth falls on; may be repeated")                             \
    TABLE("body.keyframe", KeyframeScene, KEYFRAME_KEYS,                                                        \
          "where a body is at a time, under its [[body]]; it moves from one to the next and stays at the last") \
    TABLE("garment.elastic", ElasticScene, ELASTIC_KEYS,                                                        \
          "elastic along edges of a panel, which pulls once the seams are closed; may be repeated")             \
    TABLE("pins.hold", PinHoldScene, PIN_HOLD_KEYS,                                                             \
          "vertices of one sheet or panel that are held; may be "                                               \
          "repeated")                                                                                           \
    TABLE("pins.motion", PinMotionScene, PIN_MOTION_KEYS,                                                       \
          "held vertices that move; those that share vertices act one after the other on where these are")

// Tables that appear once: TABLE(name, struct, keys, meaning)
#define SCENE_TABLES(TABLE)                                                                                     \
    TABLE(garment, GarmentScene, GARMENT_KEYS, "a garment sewn from a pattern")                                 \
    TABLE(solver, SolverScene, SOLVER_KEYS, "how and how long the motion is computed")                          \
    TABLE(contact, ContactScene, CONTACT_KEYS, "contact between cloth and bodies")                              \
    TABLE(membrane, MembraneScene, MEMBRANE_KEYS, "in-plane elasticity")                                        \
    TABLE(bending, BendingScene, BENDING_KEYS, "bending elasticity")                                            \
    TABLE(seams, SeamsScene, SEAMS_KEYS, "how panels are sewn together")                                        \
    TABLE(pins, PinsScene, PINS_KEYS, "which vertices are held in place")                                       \
    TABLE(wind, WindScene, WIND_KEYS, "air that the cloth moves in; none unless it blows or still_air is true") \
    TABLE(output, OutputScene, OUTPUT_KEYS, "what is written")
