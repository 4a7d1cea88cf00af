#include "host/run/failure_report.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

DivergenceFacts blocked()
{
    DivergenceFacts facts{.stage = "drape", .time = 0.33, .gap = 0.002};
    facts.step = {.fault = StepFault::blocked, .step = 2e-5, .longest = 0.02, .residual = 5};
    facts.vertices = {{"vertex 7 of `sheet` at (0.1, 0.2, 0.3) m", false}};
    return facts;
}

std::string text_of(const DivergenceFacts& facts) { return describe(explain(facts)); }

}  // namespace

TEST_CASE("bodies that close on cloth are named, with the room that they must leave")
{
    DivergenceFacts facts = blocked();
    facts.step.obstacle_body = "thumb";
    facts.bodies = {{"finger", 0.0003, 0.1, 0.3}, {"thumb", 0.0004, 0.1, 0.3}, {"floor", 0.4, 0, 0.3}};
    CHECK_THAT(text_of(facts), contains_text("diverged at 0.33 s (drape)") && contains_text("vertex 7 of `sheet`") &&
                                   contains_text("0.3 mm from `finger`, 0.4 mm from `thumb`") &&
                                   contains_text("`finger` and `thumb` close on the cloth") && contains_text("4 mm") &&
                                   !contains_text("floor"));
}

TEST_CASE("held vertices that are driven against each other are both named")
{
    DivergenceFacts facts = blocked();
    facts.vertices = {{"vertex 0 of `a`", true}, {"vertex 5 of `b`", true}};
    facts.pins_move = true;
    CHECK_THAT(text_of(facts), contains_text("driven against each other: vertex 0 of `a` and vertex 5 of `b`") &&
                                   contains_text("[[pins.motion]] before 0.33 s"));
    facts.vertices.erase(facts.vertices.begin());
    CHECK_THAT(text_of(facts), contains_text("held vertices are driven into cloth"));
    facts.step.obstacle_body = "ram";
    facts.bodies = {{"ram", 0.0003, 2, 0.3}};
    CHECK_THAT(text_of(facts), contains_text("`ram` is driven into cloth that is held: vertex 5 of `b`"));
}

TEST_CASE("cloth that is torn between a fast body and held vertices is told from a step that is not solved")
{
    DivergenceFacts facts = blocked();
    facts.step.fault = StepFault::unsolved;
    facts.bodies = {{"floor", 0.1, 0, 2}, {"car", 0.2, 6.5, 2}};
    facts.holds = true;
    CHECK_THAT(text_of(facts), contains_text("6.5 m/s, 130 mm in a step") && contains_text("solver.step"));
    facts.stretch = 0.57;
    facts.stretched = "triangle 3 of `sheet`";
    CHECK_THAT(text_of(facts), contains_text("triangle 3 of `sheet` is stretched by 57 %") &&
                                   contains_text("`car` moves at 6.5 m/s with friction 2") &&
                                   contains_text("body.friction") && contains_text("[pins]"));
}

TEST_CASE("what blocks cloth that a body carries along is told as tearing, or by the body's speed")
{
    DivergenceFacts facts = blocked();
    facts.bodies = {{"floor", 0.1, 0, 2}, {"car", 0.2, 6.5, 2}};
    CHECK_THAT(text_of(facts), contains_text("`car` moves at 6.5 m/s and carries cloth along"));
    facts.stretch = 0.3;
    CHECK_THAT(text_of(facts), contains_text("the cloth is torn"));
}

TEST_CASE("every fault of a step has a cause and a cure, and explicit schemes are offered implicit ones")
{
    for (StepFault fault :
         {StepFault::not_finite, StepFault::blocked, StepFault::passed, StepFault::stuck, StepFault::unsolved,
          StepFault::entered_body, StepFault::gained_energy, StepFault::unstable}) {
        DivergenceFacts facts = blocked();
        facts.step.fault = fault;
        const FailureReport report = explain(facts);
        CHECK(!report.cause.empty());
        CHECK(!report.cure.empty());
    }
    DivergenceFacts facts = blocked();
    facts.step.fault = StepFault::gained_energy;
    CHECK_THAT(text_of(facts), !contains_text("implicit_euler"));
    facts.is_explicit = true;
    CHECK_THAT(text_of(facts), contains_text("implicit_euler"));
}

TEST_CASE("cloth that is not at rest is told from where it moves, creeps, crosses or is jammed")
{
    UnrestFacts facts{.time = 30,
                      .residual = 5e-3,
                      .asked = 1e-3,
                      .pulled = "vertex 4 of `front`",
                      .net_force = 0.02,
                      .fastest = "vertex 9 of `back`",
                      .speed = 0.4,
                      .bodies = {{"mannequin", 0.001, 0, 0.3}},
                      .gap = 0.002};
    CHECK_THAT(describe(explain(facts)),
               contains_text("not at rest after 30.0 s (solver.max_time)") && contains_text("vertex 4 of `front`") &&
                   contains_text("vertex 9 of `back` moves most, at 0.4 m/s") &&
                   contains_text("1 mm from `mannequin`") && contains_text("the cloth still moves"));
    facts.speed = 1e-3;
    CHECK_THAT(explain(facts).cure, contains_text("solver.tolerance"));
    facts.residual = 0.3;
    CHECK_THAT(explain(facts).cause, contains_text("jammed"));
    facts.crossings = 12;
    CHECK_THAT(explain(facts).cure, contains_text("selvage check"));
}

TEST_CASE("a seam that stays open is told with its vertices, and whether it is gathered or a body is between")
{
    OpenSeamFacts facts{.time = 20,
                        .sides = {"front[1]", "back[3]"},
                        .lengths = {0.3, 0.31},
                        .ends = {"vertex 3 of `front`", "vertex 8 of `back`"},
                        .gap = 0.012};
    CHECK_THAT(describe(explain(facts)),
               contains_text("the seam of front[1] and back[3] is still open by 12.0 mm after 20.0 s") &&
                   contains_text("vertex 3 of `front` and vertex 8 of `back`") && contains_text("seams.stiffness"));
    facts.bodies = {{"arm", 0.003, 0, 0.3}};
    CHECK_THAT(explain(facts).cause, contains_text("`arm` stands between"));
    facts.lengths[1] = 0.6;
    CHECK_THAT(explain(facts).cause, contains_text("0.3 m and 0.6 m long"));
}
