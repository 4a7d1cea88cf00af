#include "host/solver/state/snapshot.hpp"
#include "host/solver/terms/unit_strengths.hpp"
#include "validation/measure/small_cloth.hpp"

using namespace selvage;

namespace {

// Puts a number of its own into every entry of every kept field.
void fill_kept(State& state, double start)
{
    visit_kept(state, [&](std::string_view, auto& field) {
        for (auto& number : field) number = start += 0.25;
    });
}

}  // namespace

TEST_CASE("every kept field of a state is kept by a snapshot and restored bit for bit, and nothing else is touched")
{
    State state = crumpled_state(unit_strengths());
    fill_kept(state, 1);
    const State before = state;
    Snapshot snapshot;
    keep(state, snapshot);
    fill_kept(state, -1000);
    restore(state, snapshot);
#define FIELD(type, name, per, components, unit, meaning) \
    INFO(#name);                                          \
    CHECK(state.name == before.name);
#include "kernels/fields.def"
#include "validation/unit/catch.hpp"
}

TEST_CASE("the snapshot visits the fields that the state visits, with the same names and sizes")
{
    State state = crumpled_state(unit_strengths());
    Snapshot snapshot;
    keep(state, snapshot);
    std::vector<std::pair<std::string_view, std::size_t>> of_state, of_snapshot;
    visit_kept(state, [&](std::string_view name, const auto& field) { of_state.emplace_back(name, field.size()); });
    visit_kept(snapshot,
               [&](std::string_view name, const auto& field) { of_snapshot.emplace_back(name, field.size()); });
    CHECK(of_state == of_snapshot);
    CHECK(of_state.size() > 1);
    for (const auto& [name, size] : of_state) {
        INFO(name);
        CHECK(size > 0);  // all strengths are set, so the state has every field
    }
}
