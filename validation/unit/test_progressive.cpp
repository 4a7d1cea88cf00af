#include <catch2/catch.hpp>

#include "host/garment/sheet.hpp"
#include "host/garment/transfer.hpp"
#include "host/progressive.hpp"

using namespace selvage;

namespace {

Cloth sheet_of(int resolution, const std::string& family)
{
    SheetScene sheet;
    sheet.resolution = resolution;
    sheet.mesh_family = family;
    PinsScene pins;
    pins.sheet = "top_edge";
    return make_sheet(sheet, pins, "test", "sheet[0]");
}

template <class Shape>
std::vector<Vec3> shaped(const Cloth& cloth, const Shape& shape)
{
    std::vector<Vec3> positions;
    for (const Vec2& u : cloth.panel_coordinates) positions.push_back(shape(u));
    return positions;
}

// Away from the rim, where gradients are one-sided, and from what is held.
double largest_error(const Cloth& cloth, const std::vector<Vec3>& positions, const std::vector<Vec3>& exact, double inside)
{
    double error = 0;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (cloth.panel_coordinates[v].cwiseAbs().maxCoeff() < inside) error = std::max(error, (positions[v] - exact[v]).norm());
    return error;
}

}  // namespace

TEST_CASE("a carried shape is exact where the shape is quadratic, and held vertices stay")
{
    const auto bowl = [](const Vec2& u) {
        return Vec3(u.x(), u.y() + 0.1 * u.x() * u.y(), u.x() * u.x() - 0.5 * u.y() * u.y() + 0.3 * u.x() * u.y());
    };
    const Cloth coarse = sheet_of(17, "same_diagonal"), fine = sheet_of(33, "same_diagonal");
    const std::vector<Vec3> carried = carry_over(coarse, fine, make_transfer(coarse, fine), shaped(coarse, bowl));
    CHECK(largest_error(fine, carried, shaped(fine, bowl), 0.43) < 1e-12);
    for (int v : fine.pinned) CHECK(carried[v] == fine.positions[v]);
}

TEST_CASE("a carried shape is at least three times as near as a linear one, on irregular meshes too")
{
    const auto wave = [](const Vec2& u) { return Vec3(u.x(), u.y(), 0.1 * std::sin(6 * u.x()) * std::cos(5 * u.y())); };
    const Cloth coarse = sheet_of(17, "irregular"), fine = sheet_of(33, "irregular");
    const Transfer transfer = make_transfer(coarse, fine);
    const std::vector<Vec3> from = shaped(coarse, wave), exact = shaped(fine, wave);
    std::vector<Vec3> linear(fine.positions.size(), Vec3::Zero());
    for (std::size_t v = 0; v < linear.size(); ++v)
        for (int k = transfer.offset[v]; k < transfer.offset[v + 1]; ++k) linear[v] += transfer.weight[k] * from[transfer.column[k]];
    const double carried = largest_error(fine, carry_over(coarse, fine, transfer, from), exact, 0.43);
    CHECK(3 * carried < largest_error(fine, linear, exact, 0.43));
}
