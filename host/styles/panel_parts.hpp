#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace selvage {

/// What a panel covers.
enum class GarmentPart { torso, skirt, leg, waistband, sleeve, cuff, collar, hood };

/// The place of a panel on a body, as its name tells it.
struct PanelRole {
    GarmentPart part = GarmentPart::torso;
    int side = 0;    ///< 1: the wearer's left, -1: right, 0: both or not said.
    int face = 0;    ///< 1: front, -1: back, 0: both or not said.
    int order = -1;  ///< Number of a panel among like ones side by side; -1: it has none.
};

/// Reads a name such as `left_ftorso`, `skirt_back_2`, `LeftSleeve` or `pant_f_r`: the labels of GarmentCode and common
/// English words, in any order, joined by signs or capitals.
/// @return nothing for a name without a word that means a part, a face or a side
std::optional<PanelRole> panel_role(std::string_view name);

}  // namespace selvage
