#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "host/solver/contact/contact_pairs.hpp"
#include "validation/unit/catch.hpp"
#include "validation/unit/contact/small_stack.hpp"

using namespace selvage;

namespace {

constexpr double spacing = 0.02, gap = 0.003;
constexpr int side = 6;

// Pairs of sheets that touch, listed from candidates in whatever order.
struct TouchingSheets : FilteredSheets {
    Params params = contact_alone(gap);
    std::vector<PairCandidate> touching;
    ContactPairs pairs;

    TouchingSheets()
        : FilteredSheets(sheets_above_each_other(3, side, spacing, 0.7 * gap), gap, spacing),
          pairs(gaps, ContactShares(topology.faces, pieces_of(cloth)),
                std::vector<double>(crossings.inside.size(), spacing * spacing),
                std::vector<double>(crossings.inside.size(), 0.5))
    {
        filter.refresh({state.pos, nullptr, stride(), bodies()});
        touching = filter.within_gap();
    }

    // Lists every `step`-th pair, whose candidates stand in a random order.
    void list(unsigned seed, int step = 1)
    {
        std::mt19937 random(seed);
        std::vector<PairCandidate> near;
        for (std::size_t k = 0; k < touching.size(); k += std::size_t(step)) near.push_back(touching[k]);
        std::shuffle(near.begin(), near.end(), random);
        pairs.list(state, bodies(), near, crossings);
    }

    std::vector<PairKey> keys() const
    {
        std::vector<PairKey> result;
        for (int p = 0; p < state.size.pair_count; ++p) {
            PairKey key{state.pair_edges[p] == 1, {}};
            for (int i = 0; i < 4; ++i) key.corner[i] = state.pair_vertex[i * state.size.pair_stride + p];
            result.push_back(key);
        }
        return result;
    }

    FrictionMemory in_state() const
    {
        FrictionMemory result;
        const std::vector<PairKey> pair = keys();
        const int ps = state.size.pair_stride;
        for (int p = 0; p < state.size.pair_count; ++p) {
            if (state.pair_limit[p] == 0) continue;
            PairFriction friction{pair[p], {}, {}, {}, state.pair_limit[p]};
            for (int i = 0; i < 4; ++i) friction.weight[i] = state.pair_held_weight[i * ps + p];
            for (int c = 0; c < 3; ++c) friction.normal[c] = state.pair_held_normal[c * ps + p];
            for (int c = 0; c < 3; ++c) friction.bristle[c] = state.pair_bristle[c * ps + p];
            result.push_back(friction);
        }
        return result;
    }
};

// Bristles that tell pairs apart.
FrictionMemory with_bristles(FrictionMemory memory)
{
    for (std::size_t k = 0; k < memory.size(); ++k)
        for (int c = 0; c < 3; ++c) memory[k].bristle[c] = 1e-6 * double(3 * k + c);
    return memory;
}

bool ascends(const std::vector<PairKey>& keys)
{
    return std::adjacent_find(keys.begin(), keys.end(), std::greater_equal<>()) == keys.end();
}

}  // namespace

TEST_CASE("pairs of the state and friction memory stand in ascending order, whatever the candidates' order",
          "[contact_pairs]")
{
    std::vector<PairKey> first;
    FrictionMemory first_memory;
    for (unsigned seed : {1u, 2u, 3u}) {
        TouchingSheets sheets;
        sheets.list(seed);
        const std::vector<PairKey> keys = sheets.keys();
        REQUIRE(keys.size() > 50);
        CHECK(std::any_of(keys.begin(), keys.end(), [](const PairKey& key) { return key.edges; }));
        CHECK(ascends(keys));
        sheets.pairs.settle(sheets.state, sheets.params);
        const FrictionMemory& memory = sheets.pairs.memory();
        REQUIRE(memory.size() > 20);
        CHECK(is_ordered(memory));
        CHECK((memory == sheets.in_state()));  // too long to print
        if (first.empty()) first = keys;
        if (first_memory.empty()) first_memory = memory;
        CHECK((keys == first));
        CHECK((memory == first_memory));
    }
}

TEST_CASE("a pair finds its friction again when pairs come and go and candidates change their order", "[contact_pairs]")
{
    TouchingSheets sheets;
    sheets.list(1);
    sheets.pairs.settle(sheets.state, sheets.params);
    const FrictionMemory memory = with_bristles(sheets.pairs.memory());
    REQUIRE(memory.size() > 20);
    sheets.pairs.set_memory(memory);
    for (int step : {3, 1}) {
        sheets.list(2, step);
        CHECK((sheets.in_state() == memory));
        CHECK(ascends(sheets.keys()));
    }
}

TEST_CASE("what has come apart keeps its friction to the end of the step, unless it may cross", "[contact_pairs]")
{
    TouchingSheets sheets;
    sheets.list(1);
    sheets.pairs.settle(sheets.state, sheets.params);
    const FrictionMemory memory = sheets.pairs.memory();
    REQUIRE(memory.size() > 20);
    sheets.pairs.list(sheets.state, sheets.bodies(), {}, sheets.crossings);
    CHECK((sheets.in_state() == memory));
    std::fill(sheets.crossings.tangled.begin(), sheets.crossings.tangled.end(), 1);
    sheets.pairs.list(sheets.state, sheets.bodies(), {}, sheets.crossings);
    CHECK(sheets.state.size.pair_count == 0);
}

TEST_CASE("a pair that friction knows nothing of starts without any", "[contact_pairs]")
{
    TouchingSheets sheets;
    sheets.list(1, 2);
    sheets.pairs.settle(sheets.state, sheets.params);
    std::map<PairKey, PairFriction> known;
    for (const PairFriction& friction : sheets.pairs.memory()) known[friction.pair] = friction;
    sheets.list(2);
    const std::vector<PairKey> keys = sheets.keys();
    int fresh = 0;
    for (std::size_t p = 0; p < keys.size(); ++p) {
        if (known.contains(keys[p])) continue;
        ++fresh;
        CHECK(sheets.state.pair_limit[p] == 0);
        CHECK(sheets.state.pair_friction[p] == 0.5);
    }
    CHECK(fresh > 20);
}

TEST_CASE("a memory that is out of order is refused", "[contact_pairs]")
{
    TouchingSheets sheets;
    sheets.list(1);
    sheets.pairs.settle(sheets.state, sheets.params);
    FrictionMemory memory = sheets.pairs.memory();
    std::swap(memory.front(), memory.back());
    CHECK_THROWS_AS(sheets.pairs.set_memory(memory), std::invalid_argument);
    memory.assign(2, memory.front());  // the same pair twice
    CHECK_THROWS_AS(sheets.pairs.set_memory(memory), std::invalid_argument);
}

TEST_CASE("a packed memory is unpacked bit by bit, and one that is damaged is refused", "[contact_pairs]")
{
    TouchingSheets sheets;
    sheets.list(1);
    sheets.pairs.settle(sheets.state, sheets.params);
    const FrictionMemory memory = with_bristles(sheets.pairs.memory());
    const PackedFriction packed = pack(memory);
    const auto refused = [&](const auto& damage) {
        PackedFriction damaged = packed;
        damage(damaged);
        return !unpack(damaged).has_value();
    };
    REQUIRE(unpack(packed).has_value());
    CHECK((*unpack(packed) == memory));
    CHECK(refused([](PackedFriction& p) { p.keys.pop_back(); }));
    CHECK(refused([](PackedFriction& p) { p.values.pop_back(); }));
    CHECK(refused([](PackedFriction& p) { p.keys[0] = 2; }));
    CHECK(refused([](PackedFriction& p) { std::swap_ranges(p.keys.begin(), p.keys.begin() + 5, p.keys.end() - 5); }));
}
