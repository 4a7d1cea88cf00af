#pragma once
#include <type_traits>
#include <vector>

#include "host/solver/state/state.hpp"
#include "io/geometry.hpp"

namespace selvage {

/// View of a field with three components per item: one plane for each component, `stride` items apart.
template <class Number>
struct BasicPlanes {
    Number* data = nullptr;
    int stride = 0, count = 0;

    Vec3 operator()(int item) const { return {data[item], data[stride + item], data[2 * stride + item]}; }
    void set(int item, const Vec3& value) const requires(!std::is_const_v<Number>)
    {
        for (int c = 0; c < 3; ++c) data[c * stride + item] = value[c];
    }
};
using Planes = BasicPlanes<real>;
using ConstPlanes = BasicPlanes<const real>;

/// Views of a field of vertices with the sizes of a state: state.pos, or a vector like it.
inline Planes vertex_planes(const mesh_sizes& size, std::vector<real>& field)
{
    return {field.data(), size.vertex_stride, size.vertex_count};
}
inline ConstPlanes vertex_planes(const mesh_sizes& size, const std::vector<real>& field)
{
    return {field.data(), size.vertex_stride, size.vertex_count};
}

}  // namespace selvage
