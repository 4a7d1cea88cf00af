#pragma once
#include "io/integrators.hpp"
#include "io/words.hpp"

// Every choice among words that a scene offers. io/scene/scene_keys.hpp says which key takes which, with its default;
// the reader, its messages and `selvage schema` take the words from here. io/words.hpp tells how the lists are read.

#define LETTER_SIZES(WORD) WORD(XS) WORD(S) WORD(M) WORD(L) WORD(XL) WORD(XXL)
#define SMALL_CHILD_SIZES(WORD) WORD(child110) WORD(child116) WORD(child120) WORD(child122) WORD(child128)
#define CHILD_SIZES(WORD) \
    SMALL_CHILD_SIZES(WORD) WORD(child130) WORD(child134) WORD(child140) WORD(child146) WORD(child150) WORD(child152)
#define BODY_SIZES(WORD) LETTER_SIZES(WORD) CHILD_SIZES(WORD)
#define BODY_FIGURES(WORD) WORD(automatic) WORD(women) WORD(men) WORD(children)
#define AXES(WORD) WORD(x) WORD(y) WORD(z)
#define PATTERN_AXES(WORD) WORD(automatic, "auto") AXES(WORD)
#define ROTATION_ORDERS(WORD) WORD(xyz) WORD(zyx) WORD(yxz) WORD(yzx) WORD(zxy) WORD(xzy)
#define LENGTH_UNITS(WORD) WORD(m) WORD(dm) WORD(cm) WORD(mm) WORD(inch)

#define SHEET_SHAPES(WORD) WORD(rectangle) WORD(disc) WORD(mesh)
#define MESH_FAMILIES(WORD) \
    WORD(automatic)         \
    WORD(alternating)       \
    WORD(same_diagonal) WORD(rows) WORD(cross) WORD(equilateral) WORD(irregular) WORD(panel) WORD(square)

#define BODY_SHAPES(WORD) \
    WORD(mesh) WORD(mannequin) WORD(sphere) WORD(plane) WORD(capsule) WORD(cylinder) WORD(cone) WORD(torus)
#define INTERPOLATIONS(WORD) WORD(linear) WORD(smooth)
#define CURVE_SHAPES(WORD) WORD(not_given, "") WORD(piecewise) WORD(smooth)

#define INTEGRATOR_CHOICES(WORD) WORD(automatic) INTEGRATORS(WORD)
#define UNSTABLE_STEPS(WORD) WORD(shrink) WORD(refuse)
#define PRECONDITIONER_CHOICES(WORD) WORD(automatic, "auto") WORD(block_jacobi) WORD(multigrid)
#define PRECISION_CHOICES(WORD) WORD(automatic) WORD(in_float, "float") WORD(in_double, "double")

#define CONTACT_RESPONSES(WORD) WORD(barrier) WORD(velocity_rule) WORD(exponential)
#define MEMBRANE_MODELS(WORD) WORD(orthotropic) WORD(springs) WORD(none)
#define BENDING_MODELS(WORD) WORD(automatic) WORD(plate) WORD(hinge) WORD(springs) WORD(none)

#define SHEET_RIMS(WORD) \
    WORD(corners) WORD(top_corners) WORD(right_corners) WORD(top_edge) WORD(left_edge) WORD(right_edge)
#define PIN_GROUPS(WORD) WORD(none) SHEET_RIMS(WORD) WORD(two_rows) WORD(center)
#define MOVING_PIN_GROUPS(WORD) WORD(automatic) SHEET_RIMS(WORD) WORD(two_rows) WORD(center)

#define ARRANGEMENTS(WORD) WORD(automatic) WORD(always) WORD(never)
#define POSITION_GRIDS(WORD) WORD(lossless) WORD(fine_8um, "8um") WORD(coarse_60um, "60um")

#define CHOICES(CHOICE)                                  \
    CHOICE(BodySize, BODY_SIZES)                         \
    CHOICE(BodyFigure, BODY_FIGURES)                     \
    CHOICE(Axis, AXES)                                   \
    CHOICE(PatternAxis, PATTERN_AXES)                    \
    CHOICE(RotationOrder, ROTATION_ORDERS)               \
    CHOICE(LengthUnit, LENGTH_UNITS)                     \
    CHOICE(SheetShape, SHEET_SHAPES)                     \
    CHOICE(MeshFamily, MESH_FAMILIES)                    \
    CHOICE(BodyShape, BODY_SHAPES)                       \
    CHOICE(Interpolation, INTERPOLATIONS)                \
    CHOICE(CurveShape, CURVE_SHAPES)                     \
    CHOICE(IntegratorChoice, INTEGRATOR_CHOICES)         \
    CHOICE(UnstableStep, UNSTABLE_STEPS)                 \
    CHOICE(PreconditionerChoice, PRECONDITIONER_CHOICES) \
    CHOICE(PrecisionChoice, PRECISION_CHOICES)           \
    CHOICE(ContactResponse, CONTACT_RESPONSES)           \
    CHOICE(MembraneModel, MEMBRANE_MODELS)               \
    CHOICE(BendingModel, BENDING_MODELS)                 \
    CHOICE(PinGroup, PIN_GROUPS)                         \
    CHOICE(MovingPinGroup, MOVING_PIN_GROUPS)            \
    CHOICE(ArrangementChoice, ARRANGEMENTS)              \
    CHOICE(PositionGrid, POSITION_GRIDS)

namespace selvage {

CHOICES(WORD_ENUM)

}  // namespace selvage
