#include "host/solver/stepping/sleep.hpp"

#include <algorithm>

#include "host/parallel/launch.hpp"
#include "host/solver/state/vectors.hpp"

namespace selvage {
namespace {

// When parts of the cloth are deactivated. `bench skip -- --feature sleep` measures what that saves; nothing tells what
// chose the numbers without a reason here.
struct SleepTuning {
    static constexpr int sleep_interval = 8;        // steps until all wake and are looked at again
    static constexpr int active_rings = 3;          // rings of faces around a moving vertex that stay awake
    static constexpr double speed_fraction = 0.04;  // of the fastest vertex' speed: below it a vertex may sleep
    static constexpr double force_fraction = 0.1;   // of the mean of |f|^2: below it a vertex may sleep
    // Largest part of the vertices that may be awake while the others sleep. Letting more sleep took the sphere with
    // 129 vertices a side to rest in 320 to 444 iterations instead of 275, and garments came to rest later.
    static constexpr double max_awake = 0.25;
};

double squared(const std::vector<real>& field, int stride, int v)
{
    return field[v] * field[v] + field[stride + v] * field[stride + v] + field[2 * stride + v] * field[2 * stride + v];
}

// Wakes all corners of items that have one awake. Kinds that no term acts on have no corners.
void spread(const std::vector<int>& corners, int stride, int count, int per_item, std::vector<char>& is_awake)
{
    if (corners.empty()) return;
    const std::vector<char> before = is_awake;
    for (int item = 0; item < count; ++item) {
        bool any = false;
        for (int c = 0; c < per_item; ++c) {
            const int v = corners[c * stride + item];  // corners of bodies are below zero
            any = any || (v >= 0 && before[v]);
        }
        for (int c = 0; any && c < per_item; ++c)
            if (const int v = corners[c * stride + item]; v >= 0) is_awake[v] = 1;
    }
}

// Vertices that move or whose forces do not balance, with their neighbourhood.
std::vector<char> active_vertices(const State& s, const std::vector<real>& force)
{
    const int n = s.size.vertex_count, vs = s.size.vertex_stride;
    const double fastest = largest_square(s, s.vel), mean = square(s, force, Items{n}) / n;
    std::vector<char> is_awake(std::size_t(n), 0);
    for_each_item(n, [&](int v) {
        is_awake[v] = squared(s.vel, vs, v) > SleepTuning::speed_fraction * SleepTuning::speed_fraction * fastest ||
                      squared(force, vs, v) > SleepTuning::force_fraction * mean;
    });
    for (int ring = 0; ring < SleepTuning::active_rings; ++ring) {
        spread(s.face_vertex, s.size.face_stride, s.size.face_count, 3, is_awake);
        spread(s.spring_vertex, s.size.spring_stride, s.size.spring_count, 2, is_awake);
        if (ring == 0) spread(s.pair_vertex, s.size.pair_stride, s.size.pair_count, 4, is_awake);
    }
    return is_awake;
}

std::vector<char> items_awake(const std::vector<int>& corners, int stride, int count, int per_item,
                              const std::vector<char>& is_awake)
{
    std::vector<char> result(std::size_t(count), 0);
    if (corners.empty()) return result;
    for_each_item(count, [&](int item) {
        for (int c = 0; c < per_item; ++c) result[item] = result[item] || is_awake[corners[c * stride + item]];
    });
    return result;
}

std::vector<int> list_of(const std::vector<char>& is_awake)
{
    std::vector<int> result;
    for (std::size_t k = 0; k < is_awake.size(); ++k)
        if (is_awake[k]) result.push_back(int(k));
    return result;
}

// A hinge that turns changes the moments of those that a plate couples it to.
std::vector<char> hinges_awake(const State& s, const std::vector<char>& is_awake)
{
    const std::vector<char> turns = items_awake(s.hinge_vertex, s.size.hinge_stride, s.size.hinge_count, 4, is_awake);
    std::vector<char> result = turns;
    if (!s.coupling_slots.empty())
        for_each_item(s.size.hinge_count, [&](int h) {
            for (int k = s.coupling_slots[h]; k < s.coupling_slots[s.size.hinge_stride + h]; ++k)
                result[h] = result[h] || turns[s.coupling_hinge[k]];
        });
    return result;
}

}  // namespace

void put_to_sleep(System& system, const std::vector<char>& is_awake, double force_squared)
{
    const TraceScope scope("fall_asleep");
    State& s = system.state();
    AwakeItems& awake = s.awake;
    awake.all = false;
    awake.is_awake = is_awake;
    awake.force_squared = force_squared;
    awake.vertex = list_of(is_awake);
    awake.hinge = list_of(hinges_awake(s, is_awake));
#define LIST(kind, corners) \
    awake.kind = list_of(items_awake(s.kind##_vertex, s.size.kind##_stride, s.size.kind##_count, corners, is_awake));
    LIST(face, 3)
    LIST(stitch, 2)
    LIST(spring, 2)
#undef LIST
    clear_asleep(s, s.vel);
    if (system.cloth_contact()) system.cloth_contact()->let_sleep(&awake.is_awake);
}

void wake(System& system)
{
    system.state().awake.all = true;
    if (system.cloth_contact()) system.cloth_contact()->let_sleep(nullptr);
}

bool may_sleep(const System& system)
{
    const ClothContact* cloth = system.cloth_contact();
    return !system.has_velocity_filters() && !(cloth && (cloth->counts().tangles > 0 || cloth->counts().inside > 0));
}

void rest_in_places(System& system, const std::vector<real>& force, int& steps_left)
{
    const State& s = system.state();
    if (steps_left > 0) {
        const double moving = square(s, force, items_of(s, ItemKind::vertex));
        --steps_left;
        // What sleeps holds it up once its own forces are what is left.
        if (moving < s.awake.force_squared) steps_left = 0;
        if (steps_left == 0) wake(system);
        return;
    }
    if (!may_sleep(system)) return;
    const std::vector<char> is_awake = active_vertices(s, force);
    const double count = double(std::count(is_awake.begin(), is_awake.end(), 1));
    if (count > SleepTuning::max_awake * s.size.vertex_count || count == 0) return;
    put_to_sleep(system, is_awake, square_asleep(s, force, is_awake));
    steps_left = SleepTuning::sleep_interval;
}

}  // namespace selvage
