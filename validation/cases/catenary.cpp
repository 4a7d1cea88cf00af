// A strip of membrane without bending stiffness that hangs between two supports: catenary_cases.csv.
#include <cmath>

#include <fmt/format.h>

#include "validation/cases/cases.hpp"
#include "validation/measure/reference.hpp"
#include "validation/measure/specimen.hpp"

namespace selvage {
namespace {

constexpr int segments = 160;
constexpr double areal_density = 0.15, gravity = 9.81, width = 1;  // the table's weight of 1.4715 N per metre

// The rows of one case and kind of the table; each has nine points.
struct Catenary {
    std::string name, kind;
    double span, rise, length, stiffness, start_tension, end_tension;
    std::vector<Vec3> points;
    std::vector<double> fraction;
};

std::vector<Catenary> catenaries()
{
    std::vector<Catenary> all;
    for (const ReferenceRow& row : reference_table("catenary_cases.csv")) {
        const std::string name = row.text("case"), kind = row.text("kind");
        if (kind != "inext" && kind != "elastic_stvk") continue;
        if (all.empty() || all.back().name != name || all.back().kind != kind)
            all.push_back({name,
                           kind,
                           row.number("span"),
                           row.number("rise"),
                           row.number("length0"),
                           row.number("EA"),
                           row.number("T0"),
                           row.number("T1"),
                           {},
                           {}});
        all.back().points.emplace_back(row.number("x"), 0, row.number("y"));
        all.back().fraction.push_back(row.number("s_frac"));
    }
    return all;
}

// A ribbon of two rows of vertices with one row of faces between them, pinned at both ends.
Cloth ribbon(double length)
{
    constexpr int columns = segments + 1;
    Cloth cloth;
    for (const double y : {-0.5 * width, 0.5 * width})
        for (int i = 0; i < columns; ++i) {
            cloth.positions.emplace_back(length * i / segments, y, 0);
            cloth.panel_coordinates.emplace_back(length * i / segments, y);
        }
    for (int i = 0; i < segments; ++i) {
        cloth.faces.push_back({i, i + 1, columns + i + 1});
        cloth.faces.push_back({i, columns + i + 1, columns + i});
    }
    cloth.pinned = {0, columns - 1, columns, 2 * columns - 1};
    cloth.panels = {one_panel(cloth)};
    return cloth;
}

// Places the ribbon on a parabola between the supports, as a start for the equilibrium.
void hang(Cloth& cloth, const Catenary& wanted)
{
    const double slack = std::max(wanted.length - std::hypot(wanted.span, wanted.rise), 0.01 * wanted.length);
    const double sag = std::sqrt(0.4 * wanted.length * slack);
    for (Vec3& x : cloth.positions) {
        const double s = x.x() / wanted.length;
        x = Vec3(s * wanted.span, x.y(), s * wanted.rise - 4 * sag * s * (1 - s));
    }
}

}  // namespace

void check_catenary(CaseReport& report)
{
    report.from("catenary_cases.csv: closed form and shooting, Irvine 1981");
    Params params = heavy_plate(Vec3(0, 0, -gravity));
    params.plate.scale = 0;
    for (const Catenary& wanted : catenaries()) {
        const double weight = areal_density * gravity * width * wanted.length;
        const double stiffness = std::isinf(wanted.stiffness) ? 1e5 * weight : wanted.stiffness / width;
        Cloth cloth = ribbon(wanted.length);
        hang(cloth, wanted);
        Specimen strip(cloth, isotropic_fabric(stiffness, 0, 0, areal_density), params);
        strip.balance_from_soft(1e-6);
        double worst = 0;
        for (int i = 0; i < int(wanted.points.size()); ++i) {
            const int column = int(std::lround(wanted.fraction[i] * segments));
            const Vec3 middle = 0.5 * (strip.position(column) + strip.position(column + segments + 1));
            worst = std::max(worst, (middle - wanted.points[i]).norm() / wanted.length);
        }
        const std::string name = wanted.kind + " " + wanted.name;
        report.absolute(name + ", nine points, largest distance over length", 0, worst, 1e-3);
        for (const int end : {0, segments}) {
            const double tension = (strip.holding_force(end) + strip.holding_force(end + segments + 1)).norm();
            report.relative(name + (end == 0 ? ", tension at the start [N]" : ", tension at the end [N]"),
                            end == 0 ? wanted.start_tension : wanted.end_tension, tension, 1e-3);
        }
    }
}

}  // namespace selvage
