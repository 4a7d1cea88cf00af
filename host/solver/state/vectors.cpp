#include "host/solver/state/vectors.hpp"

#include <cmath>

#include "host/parallel/launch.hpp"
#include "kernels/stages/vector_ops.h"

namespace selvage {

void clear(std::vector<real>& y) { launch<vector_clear>(int(y.size()), vector_scale_args{y.data(), 0}); }

void clear(std::vector<block_real>& blocks)
{
    launch<block_clear>(int(blocks.size()), block_scale_args{blocks.data(), 0});
}

void scale(std::vector<real>& y, real factor)
{
    launch<vector_scale>(int(y.size()), vector_scale_args{y.data(), factor});
}

void divide(std::vector<real>& y, real divisor)
{
    launch<vector_divide>(int(y.size()), vector_divide_args{y.data(), divisor});
}

void add(std::vector<real>& y, const std::vector<real>& x, real factor, const std::vector<real>& p)
{
    launch<vector_add>(int(y.size()), vector_add_args{y.data(), x.data(), p.data(), factor});
}

void scale_difference(std::vector<real>& y, real factor, const std::vector<real>& x, const std::vector<real>& p)
{
    launch<vector_scale_difference>(int(y.size()), vector_add_args{y.data(), x.data(), p.data(), factor});
}

void root(std::vector<real>& y, const std::vector<real>& x)
{
    launch<vector_root>(int(y.size()), vector_root_args{y.data(), x.data()});
}

void weigh(Planes y, const std::vector<real>& weight, ConstPlanes x)
{
    launch<vertex_weigh>(y.count, vertex_weigh_args{y.data, weight.data(), x.data, y.stride});
}

void free_difference(const State& state, std::vector<real>& y, const std::vector<real>& x, const std::vector<real>& p)
{
    launch<vertex_free_difference>(
        state.size.vertex_count,
        vertex_free_args{y.data(), x.data(), p.data(), state.inv_mass.data(), state.size.vertex_stride});
}

void free_negative(const State& state, std::vector<real>& y, const std::vector<real>& x)
{
    launch<vertex_free_negative>(
        state.size.vertex_count,
        vertex_free_args{y.data(), x.data(), nullptr, state.inv_mass.data(), state.size.vertex_stride});
}

void free_copy(const State& state, std::vector<real>& y, const std::vector<real>& x)
{
    launch<vertex_free_copy>(
        state.size.vertex_count,
        vertex_free_args{y.data(), x.data(), nullptr, state.inv_mass.data(), state.size.vertex_stride});
}

void clear_asleep(const State& state, std::vector<real>& y)
{
    if (state.awake.all) return;
    launch<vertex_clear_resting>(
        state.size.vertex_count,
        vertex_rest_args{y.data(), nullptr, state.awake.is_awake.data(), state.size.vertex_stride});
}

void clear_resting(const State& state, std::vector<real>& y)
{
    const char* is_awake = state.awake.all ? nullptr : state.awake.is_awake.data();
    launch<vertex_clear_resting>(state.size.vertex_count,
                                 vertex_rest_args{y.data(), state.inv_mass.data(), is_awake, state.size.vertex_stride});
}

void clear(std::vector<real>& field, int stride, const Items& items)
{
    const int planes = stride > 0 ? int(field.size()) / stride : 0;
    launch<clear_planes>(items, clear_planes_args{field.data(), planes, stride});
}

void clear(std::vector<block_real>& field, int stride, const Items& items)
{
    const int blocks = stride > 0 ? int(field.size()) / (9 * stride) : 0;
    launch<clear_blocks>(items, clear_blocks_args{field.data(), blocks, stride});
}

void scale_blocks(std::vector<block_real>& blocks, block_real factor, const Items& vertices)
{
    launch<block_scale>(vertices, block_scale_args{blocks.data(), factor});
}

double dot(const std::vector<real>& x, const std::vector<real>& y)
{
    return launch_sum<vector_dot>(Items{int(x.size())}, vector_pair_args{x.data(), y.data()});
}

double dot(ConstPlanes x, ConstPlanes y)
{
    return launch_sum<vertex_dot>(Items{x.count}, vertex_pair_args{x.data, y.data, x.stride});
}

double dot(const State& state, const std::vector<real>& x, const std::vector<real>& y)
{
    return dot(vertex_planes(state.size, x), vertex_planes(state.size, y));
}

double square(const State& state, const std::vector<real>& x, const Items& vertices)
{
    return launch_sum<vertex_dot>(vertices, vertex_pair_args{x.data(), x.data(), state.size.vertex_stride});
}

double square_asleep(const State& state, const std::vector<real>& x, const std::vector<char>& is_awake)
{
    return launch_sum<vertex_square_asleep>(Items{state.size.vertex_count},
                                            vertex_mask_args{x.data(), is_awake.data(), state.size.vertex_stride});
}

double free_mass(const State& state)
{
    const vertex_mass_args args{nullptr, state.mass.data(), state.inv_mass.data(), state.size.vertex_stride};
    return launch_sum<vertex_free_mass>(Items{state.size.vertex_count}, args);
}

double mass_square(const State& state, const std::vector<real>& x)
{
    const vertex_mass_args args{x.data(), state.mass.data(), state.inv_mass.data(), state.size.vertex_stride};
    return launch_sum<vertex_mass_square>(Items{state.size.vertex_count}, args);
}

double largest_distance(const State& state, const std::vector<real>& a, const std::vector<real>& b)
{
    const vertex_pair_args args{a.data(), b.data(), state.size.vertex_stride};
    return std::sqrt(launch_max<vertex_square_distance>(state.size.vertex_count, args));
}

double largest_square(const State& state, const std::vector<real>& x)
{
    return launch_max<vertex_dot>(state.size.vertex_count,
                                  vertex_pair_args{x.data(), x.data(), state.size.vertex_stride});
}

bool is_finite(const State& state)
{
    return std::isfinite(launch_sum<vector_magnitudes>(Items{int(state.pos.size())},
                                                       vector_pair_args{state.pos.data(), state.vel.data()}));
}

}  // namespace selvage
