#include "host/mesh/triangle_intersection.hpp"

#include <algorithm>

#include "host/mesh/exact_orientation.hpp"

namespace selvage {
namespace {

// Returns a point that is not in the plane of a triangle. The orientation of three points of the plane is then the sign
// of their determinant with this point, which needs no projection. The three candidates and the origin are not
// coplanar, so one of the four is off the plane.
Vec3 point_off_plane(const Triangle& t)
{
    for (const Vec3& candidate : {Vec3(1e3, 0, 0), Vec3(0, 1e3, 0), Vec3(0, 0, 1e3)})
        if (exact_orientation(t[0], t[1], t[2], candidate) != 0) return candidate;
    return Vec3::Zero();
}

// Tests two segments in one plane; `eye` is a point off that plane.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& eye)
{
    const int pa = exact_orientation(p, q, a, eye), pb = exact_orientation(p, q, b, eye);
    const int ap = exact_orientation(a, b, p, eye), aq = exact_orientation(a, b, q, eye);
    if (pa == 0 && pb == 0 && ap == 0 && aq == 0) {  // collinear: they meet if their extents overlap
        for (int c = 0; c < 3; ++c)
            if (std::max(p[c], q[c]) < std::min(a[c], b[c]) || std::max(a[c], b[c]) < std::min(p[c], q[c]))
                return false;
        return true;
    }
    return pa * pb <= 0 && ap * aq <= 0;
}

bool same_side(int a, int b, int c) { return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0); }

bool meet_in_plane(const Vec3& p, const Vec3& q, const Triangle& t)
{
    const Vec3 eye = point_off_plane(t);
    const auto side = [&](const Vec3& x, int k) { return exact_orientation(t[k], t[(k + 1) % 3], x, eye); };
    if (same_side(side(p, 0), side(p, 1), side(p, 2))) return true;
    for (int k = 0; k < 3; ++k)
        if (segments_meet(p, q, t[k], t[(k + 1) % 3], eye)) return true;
    return false;
}

bool edge_meets(const Triangle& edges, const Triangle& t)
{
    for (int k = 0; k < 3; ++k)
        if (segment_meets_triangle(edges[k], edges[(k + 1) % 3], t)) return true;
    return false;
}

}  // namespace

bool is_degenerate(const Triangle& t)
{
    // Only collinear corners are coplanar with each of four points that are not coplanar themselves.
    const auto flat = [&](const Vec3& x) { return exact_orientation(t[0], t[1], t[2], x) == 0; };
    return flat({1e3, 0, 0}) && flat({0, 1e3, 0}) && flat({0, 0, 1e3}) && flat({0, 0, 0});
}

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Triangle& t)
{
    const int at_p = exact_orientation(t[0], t[1], t[2], p), at_q = exact_orientation(t[0], t[1], t[2], q);
    if (at_p * at_q > 0) return false;
    if (at_p == 0 && at_q == 0) return meet_in_plane(p, q, t);
    return same_side(exact_orientation(p, q, t[0], t[1]), exact_orientation(p, q, t[1], t[2]),
                     exact_orientation(p, q, t[2], t[0]));
}

bool triangles_meet(const Triangle& a, const Triangle& b)
{
    const auto apart = [](const Triangle& t, const Triangle& from) {
        const int k = exact_orientation(t[0], t[1], t[2], from[0]);
        return k != 0 && k == exact_orientation(t[0], t[1], t[2], from[1]) &&
               k == exact_orientation(t[0], t[1], t[2], from[2]);
    };
    if (apart(a, b) || apart(b, a)) return false;
    return edge_meets(a, b) || edge_meets(b, a);
}

}  // namespace selvage
