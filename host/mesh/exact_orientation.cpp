#include "host/mesh/exact_orientation.hpp"

#include <cmath>
#include <vector>

namespace selvage {
namespace {

// A number as an exact sum of doubles whose bits do not overlap, the smallest first (Shewchuk 1997).
using Expansion = std::vector<double>;

// Adds one double exactly: the rounding error of every addition is kept as a smaller component of the sum. The function
// must not be inlined. The compiler could otherwise fuse a product with this addition, and the product would no longer
// be the rounded one whose error add_product has computed.
[[gnu::noinline]] void add(Expansion& sum, double value)
{
    std::size_t kept = 0;
    for (const double part : sum) {
        const double total = value + part, virtual_part = total - value;
        const double error = (value - (total - virtual_part)) + (part - virtual_part);
        if (error != 0) sum[kept++] = error;
        value = total;
    }
    sum.resize(kept);
    sum.push_back(value);
}

void add_product(Expansion& sum, double x, double y, double z)
{
    const double xy = x * y, xy_error = std::fma(x, y, -xy);
    for (const double part : {xy, xy_error}) {
        const double product = part * z;
        add(sum, std::fma(part, z, -product));
        add(sum, product);
    }
}

// Adds sign * det(x, y, z).
void add_determinant(Expansion& sum, const Vec3& x, const Vec3& y, const Vec3& z, double sign)
{
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(sum, sign * x[i], y[j], z[k]);
        add_product(sum, -sign * x[i], y[k], z[j]);
    }
}

}  // namespace

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double determinant = u.cross(v).dot(w);
    const double magnitude = u.cwiseAbs().sum() * v.cwiseAbs().sum() * w.cwiseAbs().sum();
    // Beyond this the rounded determinant has the right sign: twice Shewchuk's bound of (7 + 56 eps) eps, times an
    // upper bound of the permanent.
    if (std::abs(determinant) > 2e-15 * magnitude) return determinant > 0 ? 1 : -1;
    // det(b - a, c - a, d - a) = det(b, c, d) - det(a, c, d) + det(a, b, d) - det(a, b, c)
    Expansion sum;
    add_determinant(sum, b, c, d, 1);
    add_determinant(sum, a, c, d, -1);
    add_determinant(sum, a, b, d, 1);
    add_determinant(sum, a, b, c, -1);
    const double leading = sum.back();
    return leading > 0 ? 1 : leading < 0 ? -1 : 0;
}

}  // namespace selvage
