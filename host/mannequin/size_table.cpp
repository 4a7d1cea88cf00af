#include "host/mannequin/size_table.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/errors.hpp"

namespace selvage {
namespace {

// What a size fixes, in [cm], in the order of MannequinMeasures.
struct SizeRow {
    double stature, bust, waist, hips, shoulder_width, neck, arm_length;
};

// In the order of BodySize from XS to XXL. docs/mannequin.md names the sources of each column.
constexpr std::array<SizeRow, 6> women{{{162, 76, 60, 86, 32.0, 32.0, 56.5},
                                        {166, 84, 66, 93, 33.0, 33.5, 58.0},
                                        {170, 92, 74, 100, 34.0, 35.0, 59.5},
                                        {174, 100, 83, 108, 35.5, 37.0, 61.0},
                                        {176, 110, 94, 117, 37.0, 39.0, 62.0},
                                        {178, 122, 106, 127, 38.5, 41.5, 62.5}}};
constexpr std::array<SizeRow, 6> men{{{162, 80, 70, 82, 36.5, 34.0, 58.0},
                                      {168, 88, 78, 90, 37.5, 36.0, 60.0},
                                      {174, 96, 86, 98, 38.5, 38.0, 62.0},
                                      {180, 104, 94, 106, 40.0, 40.0, 64.0},
                                      {184, 112, 104, 116, 41.5, 42.0, 65.5},
                                      {188, 120, 116, 124, 43.0, 44.5, 67.0}}};
// By stature; sizes between two rows are interpolated.
constexpr std::array<SizeRow, 5> children{{{110, 60, 56, 64, 23.5, 27.0, 38.0},
                                           {116, 62, 57, 66, 24.8, 27.6, 40.0},
                                           {122, 64, 58, 68, 26.0, 28.2, 42.0},
                                           {140, 70, 61, 75, 29.8, 30.2, 48.0},
                                           {152, 76, 64, 81, 32.4, 31.8, 52.0}}};

// The sizes of children in the order of BodySize [cm].
constexpr std::array<double, 11> child_statures{110, 116, 120, 122, 128, 130, 134, 140, 146, 150, 152};

MannequinMeasures in_metres(const SizeRow& row, BodyFigure figure)
{
    MannequinMeasures measures;
    measures.figure = figure;
    measures.stature = row.stature / 100;
    measures.bust = row.bust / 100;
    measures.waist = row.waist / 100;
    measures.hips = row.hips / 100;
    measures.shoulder_width = row.shoulder_width / 100;
    measures.neck = row.neck / 100;
    measures.arm_length = row.arm_length / 100;
    return measures;
}

SizeRow child_of(double stature)
{
    const auto above = std::find_if(children.begin() + 1, children.end() - 1,
                                    [&](const SizeRow& row) { return row.stature >= stature; });
    const SizeRow &b = *above, &a = *(above - 1);
    const double w = (stature - a.stature) / (b.stature - a.stature);
    const auto between = [&](double SizeRow::*column) { return (1 - w) * a.*column + w * b.*column; };
    return {stature,
            between(&SizeRow::bust),
            between(&SizeRow::waist),
            between(&SizeRow::hips),
            between(&SizeRow::shoulder_width),
            between(&SizeRow::neck),
            between(&SizeRow::arm_length)};
}

}  // namespace

bool is_child_size(BodySize size) { return size >= BodySize::child110; }

BodyFigure figure_of(BodySize size, BodyFigure figure, const InputPlace& place)
{
    const bool child = is_child_size(size);
    if (figure == BodyFigure::automatic) return child ? BodyFigure::children : BodyFigure::women;
    if (child != (figure == BodyFigure::children)) {
        InputPlace key = place;
        key.key += ".figure";
        throw InputError(
            key, fmt::format("\"{}\" with size \"{}\"", word_of(figure), word_of(size)),
            child ? "children, or automatic" : "women, men or automatic; sizes of children are child110 to child152");
    }
    return figure;
}

MannequinMeasures mannequin_size(BodySize size, BodyFigure figure, const InputPlace& place)
{
    const BodyFigure of = figure_of(size, figure, place);
    if (of == BodyFigure::children)
        return in_metres(child_of(child_statures[std::size_t(size) - std::size_t(BodySize::child110)]), of);
    return in_metres((of == BodyFigure::men ? men : women)[std::size_t(size) - std::size_t(BodySize::XS)], of);
}

}  // namespace selvage
