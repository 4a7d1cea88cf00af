#include <set>
#include <string>

#include "host/solver/stepping/integrator.hpp"
#include "io/choices.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

template <class Choice>
void check_words()
{
    std::set<std::string_view> seen;
    for (std::size_t k = 0; k < words_of<Choice>().size(); ++k) {
        const std::string_view word = words_of<Choice>()[k];
        INFO(word);
        CHECK(seen.insert(word).second);
        REQUIRE(find_word<Choice>(word).has_value());
        CHECK(find_word<Choice>(word) == Choice(k));
        CHECK(word_of(Choice(k)) == word);
    }
    CHECK_FALSE(find_word<Choice>("no such word").has_value());
}

}  // namespace

TEST_CASE("every word of a choice stands for one value, and each value has its word")
{
#define CHECK_CHOICE(Type, words) check_words<Type>();
    CHOICES(CHECK_CHOICE)
#undef CHECK_CHOICE
}

TEST_CASE("words that are no identifiers are those that scene files have")
{
    CHECK(word_of(IntegratorChoice::quasistatic) == "static");
    CHECK(word_of(PrecisionChoice::in_float) == "float");
    CHECK(word_of(PrecisionChoice::in_double) == "double");
    CHECK(word_of(PreconditionerChoice::automatic) == "auto");
    CHECK(word_of(PatternAxis::automatic) == "auto");
    CHECK(word_of(PositionGrid::fine_8um) == "8um");
}

TEST_CASE("a word for what is not given is not among the accepted ones")
{
    CHECK(find_word<CurveShape>("") == CurveShape::not_given);
    CHECK(accepted_words(words_of<CurveShape>()) == std::vector<std::string>{"piecewise", "smooth"});
}

TEST_CASE("a scene offers every integrator of the program, by its name, besides the automatic one")
{
    std::vector<std::string> names{"automatic"};
    for (const IntegratorInfo& info : integrators()) names.emplace_back(info.name);
    CHECK(accepted_words(words_of<IntegratorChoice>()) == names);
}
