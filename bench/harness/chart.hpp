#pragma once
#include <string>
#include <vector>

#include "io/image.hpp"

namespace selvage {

/// One line of a chart.
struct ChartSeries {
    std::string name;
    std::vector<double> x, y;  ///< Positive and finite; same length; drawn in this order.
};

/// A chart with two logarithmic axes and a legend at its right.
struct LogChart {
    std::string title, x_label, y_label;
    std::vector<ChartSeries> series;  ///< Series of the same name have the same colour and marker in every chart.
    double guide_y = 0;               ///< Value of a dashed horizontal line; 0: none.
    std::string guide_label;
};

/// Draws a chart. Colours and markers are assigned in the order of `names`, so they agree among several charts.
/// @param names  the names of all series that can appear in any of the charts
/// @param width, height  of the picture [pixels]
Image draw_log_chart(const LogChart& chart, const std::vector<std::string>& names, int width, int height);

/// A table of coloured cells.
struct CellMap {
    std::string title, column_label, row_label;
    std::vector<std::string> columns, rows;
    std::vector<int> kind;  ///< Row by row, per cell: index into the kinds.
};

/// The meaning of one kind of cell and its colour.
struct CellKind {
    std::string name;
    Rgb colour;
};

/// Writes 3e-4 instead of 0.0003 or 3e-04, for labels; a fraction of the leading digit is rounded away.
std::string power_label(double value);

/// Draws a table of cells with its labels.
Image draw_cell_map(const CellMap& map, const std::vector<CellKind>& kinds, int width, int height);

/// Draws a line of coloured boxes with their meanings.
Image draw_cell_legend(const std::vector<CellKind>& kinds, int width);

/// Scales a picture into a field of a contact sheet, with a line of text below it; one that is empty leaves it white.
/// @param width, height  of the field [pixels]
Image captioned(const Image& picture, const std::string& text, int width, int height);

/// Puts pictures of one size side by side, row by row, on white.
Image tile(const std::vector<Image>& pictures, int columns);

/// Puts one picture above another, on white.
Image stack(const Image& above, const Image& below);

}  // namespace selvage
