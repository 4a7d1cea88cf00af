#include <algorithm>
#include <cmath>
#include <limits>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"
#include "kernels/stages/vector_ops.h"
#include "kernels/stages/vector_rows.h"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// Around the padding of planes (48 past a multiple of 128) and around the items of one task.
constexpr int counts[] = {1, 2, 47, 48, 49, 79, 80, 81, 127, 128, 129, 1023, 1024, 1025, 2047, 2048, 2049, 3072, 5000};

// Small whole numbers: sums and products of them are exact in any order, so that results are compared bit for bit.
std::vector<real> whole_numbers(std::size_t size, std::uint32_t seed)
{
    std::vector<real> result(size);
    for (real& number : result) number = int((seed = seed * 1664525u + 1013904223u) >> 16) % 17 - 8;
    return result;
}

// Fields of vertices with every third vertex pinned; the entries between planes hold 0, as in a state.
struct Fields {
    mesh_sizes size{};
    std::vector<real> mass, inv_mass;

    explicit Fields(int count)
    {
        size.vertex_count = count;
        size.vertex_stride = padded_stride(count);
        mass.assign(std::size_t(size.vertex_stride), 0);
        inv_mass = mass;
        for (int v = 0; v < count; ++v) mass[v] = 1 + v % 5;
        for (int v = 0; v < count; ++v) inv_mass[v] = v % 3 == 0 ? 0 : 4;
    }
    std::vector<real> field(std::uint32_t seed) const
    {
        std::vector<real> result = whole_numbers(3 * std::size_t(size.vertex_stride), seed);
        for (int i = 0; i < int(result.size()); ++i)
            if (i % size.vertex_stride >= size.vertex_count) result[i] = 0;
        return result;
    }
    ConstPlanes planes(const std::vector<real>& field) const { return vertex_planes(size, field); }
    State state() const
    {
        State state;
        state.size = size;
        state.mass = mass;
        state.inv_mass = inv_mass;
        return state;
    }
};

// Those items that are not asleep: all but every fourth.
std::vector<int> awake(int count)
{
    std::vector<int> list;
    for (int item = 0; item < count; ++item)
        if (item % 4 != 1) list.push_back(item);
    return list;
}

bool is_awake(int item) { return item % 4 != 1; }

}  // namespace

TEST_CASE("planes read and write the three components of an item and leave the others alone")
{
    const Fields f(81);
    std::vector<real> field = f.field(1), expected = field;
    const Planes planes = vertex_planes(f.size, field);
    for (int v = 0; v < planes.count; v += 2) planes.set(v, {1.0 * v, 2.0 * v, 3.0 * v});
    for (int v = 0; v < planes.count; ++v)
        for (int c = 0; c < 3; ++c) {
            const int i = c * f.size.vertex_stride + v;
            if (v % 2 == 0) expected[i] = (c + 1) * v;
            CHECK(planes(v)[c] == expected[i]);
        }
    CHECK(field == expected);
}

TEST_CASE("operations on every entry of a field give what a plain loop gives, for any count")
{
    for (const int count : counts) {
        INFO(count << " vertices");
        const Fields f(count);
        const std::vector<real> x = f.field(1), p = f.field(2);
        std::vector<real> y = x, expected(x.size());

        add(y, x, 0.5, p);
        for (std::size_t i = 0; i < x.size(); ++i) expected[i] = x[i] + 0.5 * p[i];
        CHECK(y == expected);
        scale_difference(y, 0.5, x, p);
        CHECK(y == [&] {
            std::vector<real> halves = x;
            for (std::size_t i = 0; i < x.size(); ++i) halves[i] = 0.5 * (x[i] - p[i]);
            return halves;
        }());
        y = expected;
        add(y, y, -2, y);  // all operands the same field
        for (real& e : expected) e = e - 2 * e;
        CHECK(y == expected);
        scale(y, -4);
        for (real& e : expected) e *= -4;
        CHECK(y == expected);
        divide(y, 8);
        for (real& e : expected) e /= 8;
        CHECK(y == expected);
        std::fill(y.begin(), y.end(), 0.25);
        root(y, y);
        CHECK(y == std::vector<real>(x.size(), 0.5));
        clear(y);
        CHECK(y == std::vector<real>(x.size(), 0));

        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * p[i];
        CHECK(dot(x, p) == sum);
        CHECK(dot(f.planes(x), f.planes(p)) == sum);
    }
}

TEST_CASE("operations on vertices heed weights and pins, for any count")
{
    for (const int count : counts) {
        INFO(count << " vertices");
        const Fields f(count);
        const State state = f.state();
        const std::vector<real> x = f.field(1), p = f.field(2);
        double square = 0, longest = 0;
        for (int v = 0; v < count; ++v) {
            if (f.inv_mass[v] != 0) square += f.mass[v] * f.planes(x)(v).squaredNorm();
            longest = std::max(longest, (f.planes(x)(v) - f.planes(p)(v)).squaredNorm());
        }
        CHECK(mass_square(state, x) == square);
        CHECK(largest_distance(state, x, p) == std::sqrt(longest));

        std::vector<real> y = p, expected = p;
        weigh(vertex_planes(f.size, y), f.inv_mass, f.planes(x));
        for (int v = 0; v < count; ++v) vertex_planes(f.size, expected).set(v, f.inv_mass[v] * f.planes(x)(v));
        CHECK(y == expected);
    }
}

TEST_CASE("masked operations heed pinned vertices and vertices that are asleep, for any count")
{
    for (const int count : counts) {
        INFO(count << " vertices");
        const Fields f(count);
        State state = f.state();
        state.awake.is_awake.resize(std::size_t(count));
        for (int v = 0; v < count; ++v) state.awake.is_awake[v] = is_awake(v);
        const std::vector<int> list = awake(count);
        const std::vector<real> x = f.field(1), p = f.field(2), before = f.field(3);
        std::vector<real> difference = before, negative = before, copy = before, resting = x, asleep = x, pinned = x;
        free_difference(state, difference, x, p);
        free_negative(state, negative, x);
        free_copy(state, copy, x);
        clear_resting(state, pinned);  // all are awake
        clear_asleep(state, asleep);
        CHECK(asleep == x);
        state.awake.all = false;
        clear_resting(state, resting);
        clear_asleep(state, asleep);

        const auto expected = [&](const auto& value) {
            std::vector<real> result = before;
            for (int v = 0; v < count; ++v) vertex_planes(f.size, result).set(v, value(v, f.inv_mass[v] != 0));
            for (int i = 0; i < int(result.size()); ++i)
                if (i % f.size.vertex_stride >= count) result[i] = 0;
            return result;
        };
        const ConstPlanes a = f.planes(x), b = f.planes(p), c = f.planes(before);
        const Vec3 zero = Vec3::Zero();
        CHECK(difference == expected([&](int v, bool free) { return free ? Vec3(a(v) - b(v)) : zero; }));
        CHECK(negative == expected([&](int v, bool free) { return free ? Vec3(-a(v)) : zero; }));
        CHECK(copy == expected([&](int v, bool free) { return free ? a(v) : c(v); }));
        CHECK(pinned == expected([&](int v, bool free) { return free ? a(v) : zero; }));
        CHECK(resting == expected([&](int v, bool free) { return free && is_awake(v) ? a(v) : zero; }));
        CHECK(asleep == expected([&](int v, bool) { return is_awake(v) ? a(v) : zero; }));

        double of_awake = 0, of_asleep = 0, largest = 0, mass = 0;
        for (int v = 0; v < count; ++v) {
            (is_awake(v) ? of_awake : of_asleep) += a(v).squaredNorm();
            largest = std::max(largest, a(v).squaredNorm());
            if (f.inv_mass[v] != 0) mass += f.mass[v];
        }
        CHECK(square(state, x, Items{int(list.size()), list.data()}) == of_awake);
        CHECK(square(state, x, Items{count}) == of_awake + of_asleep);
        CHECK(square_asleep(state, x, state.awake.is_awake) == of_asleep);
        CHECK(largest_square(state, x) == largest);
        CHECK(free_mass(state) == mass);
    }
}

TEST_CASE("a single number that is infinite or none makes a state not finite")
{
    Fields f(1025);
    State state = f.state();
    state.pos = f.field(1);
    state.vel = f.field(2);
    CHECK(is_finite(state));
    for (std::vector<real>* field : {&state.pos, &state.vel})
        for (const real bad : {std::numeric_limits<real>::infinity(), -std::numeric_limits<real>::infinity(),
                               std::numeric_limits<real>::quiet_NaN()}) {
            const real before = (*field)[1024];
            (*field)[1024] = bad;
            CHECK_FALSE(is_finite(state));
            (*field)[1024] = before;
        }
    CHECK(is_finite(state));
}

TEST_CASE("clearing and scaling leave what is asleep alone")
{
    for (const int count : counts) {
        INFO(count << " items");
        const int stride = padded_stride(count);
        const std::vector<int> list = awake(count);
        const Items items{int(list.size()), list.data()};

        std::vector<real> planes = whole_numbers(6 * std::size_t(stride), 1), expected = planes;
        clear(planes, stride, items);
        for (int i = 0; i < 6 * stride; ++i)
            if (i % stride < count && is_awake(i % stride)) expected[i] = 0;
        CHECK(planes == expected);

        const std::vector<real> numbers = whole_numbers(18 * std::size_t(stride), 2);
        std::vector<block_real> blocks(numbers.begin(), numbers.end()), left = blocks;
        clear(blocks, stride, items);
        for (int i = 0; i < 18 * stride; ++i)
            if (i / 9 % stride < count && is_awake(i / 9 % stride)) left[i] = 0;
        CHECK(blocks == left);
        scale_blocks(left, 2, items);
        for (int i = 0; i < 9 * count; ++i)
            if (is_awake(i / 9)) blocks[i] *= 2;
        CHECK(blocks == left);
        clear(blocks);
        CHECK(blocks == std::vector<block_real>(blocks.size(), 0));
    }
}

TEST_CASE("a field without items has nothing to clear and no sum")
{
    std::vector<real> none;
    std::vector<block_real> no_blocks;
    clear(none, 0, Items{});
    clear(no_blocks, 0, Items{});
    clear(none);
    CHECK(none.empty());
    CHECK(dot(none, none) == 0);
}

TEST_CASE("rows go from planes and back, and only those that take part")
{
    for (const int count : counts) {
        INFO(count << " rows");
        const Fields f(count);
        const std::vector<real> x = f.field(1);
        std::vector<linear> rows(3 * std::size_t(count), 7);
        const std::vector<int> list = awake(count);
        launch<row_pack>(Items{int(list.size()), list.data()},
                         row_pack_args{rows.data(), x.data(), f.size.vertex_stride, 2});
        for (int row = 0; row < count; ++row)
            for (int c = 0; c < 3; ++c)
                CHECK(rows[3 * row + c] == (is_awake(row) ? linear(f.planes(x)(row)[c] / 2) : linear(7)));
        launch<row_pack>(count, row_pack_args{rows.data(), x.data(), f.size.vertex_stride, 2});
        std::vector<real> back(x.size(), 0);
        launch<row_unpack>(count, row_unpack_args{back.data(), rows.data(), f.size.vertex_stride, 2});
        CHECK(back == x);
    }
}

TEST_CASE("operations on rows give what a plain loop gives, over all of them and over those awake")
{
    for (const int count : counts)
        for (const bool all : {true, false}) {
            INFO(count << " rows, all: " << all);
            const std::vector<int> list = awake(count);
            const Items items = all ? Items{count} : Items{int(list.size()), list.data()};
            const std::size_t size = 3 * std::size_t(count);
            std::vector<std::vector<linear>> v;
            for (std::uint32_t seed = 1; seed <= 4; ++seed) {
                const std::vector<real> numbers = whole_numbers(size, seed);
                v.emplace_back(numbers.begin(), numbers.end());
            }
            std::vector<linear> x = v[0], r = v[1], turned = v[2], scaled = v[3], cleared = v[3];
            launch<row_advance>(items, row_advance_args{x.data(), r.data(), v[2].data(), v[3].data(), 0.5});
            launch<row_turn>(items, row_turn_args{turned.data(), v[3].data(), -2});
            launch<row_scale>(items, row_scale_args{scaled.data(), 0.25});
            launch<row_clear>(items, row_scale_args{cleared.data(), 0});
            double sum = 0;
            for (std::size_t i = 0; i < size; ++i) {
                const bool part = all || is_awake(int(i / 3));
                if (part) sum += double(v[0][i]) * double(v[1][i]);
                const bool right = x[i] == (part ? v[0][i] + v[2][i] / 2 : v[0][i]) &&
                                   r[i] == (part ? v[1][i] - v[3][i] / 2 : v[1][i]) &&
                                   turned[i] == (part ? v[3][i] - 2 * v[2][i] : v[2][i]) &&
                                   scaled[i] == (part ? v[3][i] / 4 : v[3][i]) && cleared[i] == (part ? 0 : v[3][i]);
                if (!right) FAIL("entry " << i);
            }
            CHECK(launch_sum<row_dot>(items, row_dot_args{v[0].data(), v[1].data()}) == sum);
        }
}

TEST_CASE("vectors restricted and prolonged between levels are products with the matrix of weights")
{
    // Coarse row k stands for the fine rows 2k and 2k + 1.
    const std::vector<int> row_begin{0, 2, 4, 5}, column{0, 1, 2, 3, 4};
    const std::vector<linear> weight{1, 0.5, 2, 0.25, 4};
    const std::vector<linear> x{8, 4, 0, 2, 2, 2, 1, 3, 5, 4, 4, 8, 1, 1, 2};
    std::vector<linear> y(9, 100);
    row_transfer_args args{row_begin.data(), column.data(), weight.data(), x.data(), y.data()};
    launch<row_restrict>(3, args);
    CHECK(y == std::vector<linear>{9, 5, 1, 3, 7, 12, 4, 4, 8});
    launch<row_prolong>(3, args);
    CHECK(y == std::vector<linear>{18, 10, 2, 6, 14, 24, 8, 8, 16});
}
