#include "host/styles/panel_parts.hpp"

#include <array>
#include <cctype>
#include <cstdlib>
#include <span>
#include <vector>

namespace selvage {
namespace {

// Words of a name: runs of letters in lower case, and of digits.
std::vector<std::string> words_of(std::string_view name)
{
    std::vector<std::string> words;
    char before = ' ';
    for (const char c : name) {
        const bool letter = std::isalpha(static_cast<unsigned char>(c)),
                   digit = std::isdigit(static_cast<unsigned char>(c));
        const bool begins =
            (letter &&
             (!std::isalpha(static_cast<unsigned char>(before)) ||
              (std::isupper(static_cast<unsigned char>(c)) && std::islower(static_cast<unsigned char>(before))))) ||
            (digit && !std::isdigit(static_cast<unsigned char>(before)));
        if (begins) words.emplace_back();
        if (letter || digit) words.back() += char(std::tolower(static_cast<unsigned char>(c)));
        before = c;
    }
    return words;
}

struct PartWord {
    std::string_view word;
    GarmentPart part;
};

// Of several in one name the first of this list counts: a shirt's sleeve is a sleeve.
constexpr std::array part_words = {PartWord{"cuff", GarmentPart::cuff},
                                   PartWord{"sleeve", GarmentPart::sleeve},
                                   PartWord{"arm", GarmentPart::sleeve},
                                   PartWord{"hood", GarmentPart::hood},
                                   PartWord{"collar", GarmentPart::collar},
                                   PartWord{"neckband", GarmentPart::collar},
                                   PartWord{"waistband", GarmentPart::waistband},
                                   PartWord{"wb", GarmentPart::waistband},
                                   PartWord{"belt", GarmentPart::waistband},
                                   PartWord{"skirt", GarmentPart::skirt},
                                   PartWord{"godet", GarmentPart::skirt},
                                   PartWord{"pant", GarmentPart::leg},
                                   PartWord{"trouser", GarmentPart::leg},
                                   PartWord{"short", GarmentPart::leg},
                                   PartWord{"leg", GarmentPart::leg},
                                   PartWord{"torso", GarmentPart::torso},
                                   PartWord{"bodice", GarmentPart::torso},
                                   PartWord{"body", GarmentPart::torso},
                                   PartWord{"top", GarmentPart::torso},
                                   PartWord{"up", GarmentPart::torso},
                                   PartWord{"yoke", GarmentPart::torso},
                                   PartWord{"shirt", GarmentPart::torso},
                                   PartWord{"tee", GarmentPart::torso},
                                   PartWord{"vest", GarmentPart::torso},
                                   PartWord{"jacket", GarmentPart::torso},
                                   PartWord{"coat", GarmentPart::torso},
                                   PartWord{"dress", GarmentPart::torso}};

constexpr std::array<std::string_view, 3> left_words = {"left", "l", "lt"}, right_words = {"right", "r", "rt"};
constexpr std::array<std::string_view, 4> front_words = {"front", "f", "fr", "anterior"},
                                          back_words = {"back", "b", "bk", "rear"};

bool one_of(const std::string& word, std::span<const std::string_view> list)
{
    for (const std::string_view known : list)
        if (word == known) return true;
    return false;
}

// Takes a side or a face out of a word, also from the front of one such as `ftorso`, `lfsleeve` or `Rhood`.
bool take_place(const std::string& word, PanelRole& role)
{
    if (one_of(word, left_words))
        role.side = 1;
    else if (one_of(word, right_words))
        role.side = -1;
    else if (one_of(word, front_words))
        role.face = 1;
    else if (one_of(word, back_words))
        role.face = -1;
    else
        return false;
    return true;
}

std::optional<std::size_t> part_at(std::string word)
{
    if (word.size() > 3 && word.back() == 's') word.pop_back();
    for (std::size_t k = 0; k < part_words.size(); ++k)
        if (word == part_words[k].word) return k;
    return std::nullopt;
}

// Letters in front of a part or a place: l, r, f, b in any order.
bool take_prefixed(const std::string& word, PanelRole& role, std::optional<std::size_t>& part)
{
    for (std::size_t letters = 1; letters <= 2 && letters < word.size(); ++letters) {
        const std::string rest = word.substr(letters);
        PanelRole found = role;
        bool fits = rest.size() > 2;
        for (std::size_t k = 0; k < letters; ++k) fits = fits && take_place(word.substr(k, 1), found);
        const std::optional<std::size_t> named = part_at(rest);
        if (!fits || (!named && !take_place(rest, found))) continue;
        role = found;
        if (named) part = part ? std::min(*part, *named) : *named;
        return true;
    }
    return false;
}

}  // namespace

std::optional<PanelRole> panel_role(std::string_view name)
{
    PanelRole role;
    std::optional<std::size_t> part;
    bool known = false;
    for (const std::string& word : words_of(name)) {
        if (std::isdigit(static_cast<unsigned char>(word.front()))) {
            role.order = std::atoi(word.c_str());
        } else if (take_place(word, role) || take_prefixed(word, role, part)) {
            known = true;
        } else if (const auto named = part_at(word)) {
            part = part ? std::min(*part, *named) : *named;
            known = true;
        }
    }
    if (!known) return std::nullopt;
    if (part) role.part = part_words[*part].part;
    return role;
}

}  // namespace selvage
