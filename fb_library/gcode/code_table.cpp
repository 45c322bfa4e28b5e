#include "fb_library/gcode/code_table.hpp"

#include <array>
#include <iterator>

namespace taktwerk::gcode {
namespace {

using Group = CodeGroup;

constexpr std::string_view cycles = "canned cycles have to be written out as G0 and G1";
constexpr std::string_view compensation = "cutter compensation would change the programmed path; have it done by what makes the program";
constexpr std::string_view other_dialect_units = "in RS274 the units are G20 (inch) and G21 (mm)";

constexpr CodeEntry g_table[] = {
    {0, Group::motion},
    {10, Group::motion},
    {20, Group::motion},
    {30, Group::motion},
    {40, Group::non_modal},
    {50, Group::motion, "splines have to be written as G1, G2 and G3"},
    {51, Group::motion, "splines have to be written as G1, G2 and G3"},
    {52, Group::motion, "splines have to be written as G1, G2 and G3"},
    {53, Group::motion, "splines have to be written as G1, G2 and G3"},
    {70, Group::units, "diameter mode belongs to lathes"},
    {80, Group::units, "radius mode belongs to lathes, and is what holds anyway"},
    {90, Group::non_modal, "there is no exact stop for one block; use G61.1"},
    {100, Group::non_modal},
    {170, Group::plane},
    {180, Group::plane},
    {190, Group::plane},
    {171, Group::plane, "there are no axes U, V, W"},
    {181, Group::plane, "there are no axes U, V, W"},
    {191, Group::plane, "there are no axes U, V, W"},
    {200, Group::units},
    {210, Group::units},
    {280, Group::non_modal},
    {281, Group::non_modal, "reference positions are settings of the machine, not of a program"},
    {300, Group::non_modal},
    {301, Group::non_modal, "reference positions are settings of the machine, not of a program"},
    {330, Group::motion, "threading needs a spindle that is measured"},
    {331, Group::motion, "threading needs a spindle that is measured"},
    {382, Group::motion, "probing is the machine program's, not a G-code program's"},
    {383, Group::motion, "probing is the machine program's, not a G-code program's"},
    {384, Group::motion, "probing is the machine program's, not a G-code program's"},
    {385, Group::motion, "probing is the machine program's, not a G-code program's"},
    {400, Group::compensation},
    {410, Group::compensation, compensation},
    {411, Group::compensation, compensation},
    {420, Group::compensation, compensation},
    {421, Group::compensation, compensation},
    {430, Group::length},
    {431, Group::length, "lengths come from the tool table; use G43 H"},
    {432, Group::length, "only one tool's length holds at a time; use G43 H"},
    {490, Group::length},
    {500, Group::non_modal, "coordinates cannot be scaled"},
    {510, Group::non_modal, "coordinates cannot be scaled"},
    {520, Group::non_modal, "controls disagree about it; use G92, or G10 L2"},
    {530, Group::non_modal},
    {540, Group::coordinates},
    {550, Group::coordinates},
    {560, Group::coordinates},
    {570, Group::coordinates},
    {580, Group::coordinates},
    {590, Group::coordinates},
    {591, Group::coordinates},
    {592, Group::coordinates},
    {593, Group::coordinates},
    {600, Group::path_mode, "exact stop of DIN 66025; in RS274 it is G61 or G61.1"},
    {610, Group::path_mode},
    {611, Group::path_mode},
    {640, Group::path_mode},
    {680, Group::non_modal, "coordinates cannot be rotated"},
    {690, Group::non_modal, "coordinates cannot be rotated"},
    {700, Group::units, other_dialect_units},
    {710, Group::units, other_dialect_units},
    {730, Group::motion, cycles},
    {740, Group::non_modal, "homing of DIN 66025; axes are homed before a program runs"},
    {760, Group::motion, "threading needs a spindle that is measured"},
    {800, Group::motion},
    {810, Group::motion, cycles},
    {820, Group::motion, cycles},
    {830, Group::motion, cycles},
    {840, Group::motion, cycles},
    {850, Group::motion, cycles},
    {860, Group::motion, cycles},
    {870, Group::motion, cycles},
    {880, Group::motion, cycles},
    {890, Group::motion, cycles},
    {900, Group::distance},
    {910, Group::distance},
    {901, Group::arc_distance},
    {911, Group::arc_distance},
    {920, Group::non_modal},
    {921, Group::non_modal},
    {922, Group::non_modal},
    {923, Group::non_modal},
    {930, Group::feed_mode},
    {940, Group::feed_mode},
    {950, Group::feed_mode, "feed per revolution needs a spindle that is measured"},
    {960, Group::spindle_mode, "constant surface speed needs a spindle that is told a speed along the path"},
    {970, Group::spindle_mode},
    {980, Group::non_modal, cycles},
    {990, Group::non_modal, cycles},
};

constexpr std::string_view overrides = "the operator's override belongs to the operator";
constexpr std::string_view outputs = "outputs are the program's of the machine; use M100 to M199, which it acknowledges";

constexpr CodeEntry m_table[] = {
    {0, Group::stop},
    {1, Group::stop},
    {2, Group::stop},
    {30, Group::stop},
    {60, Group::stop, "there is no pallet shuttle; use M0, or M100 to M199"},
    {3, Group::spindle},
    {4, Group::spindle},
    {5, Group::spindle},
    {19, Group::spindle, "the spindle's angle is not measured"},
    {6, Group::tool_change},
    {61, Group::tool_change, "it would name a tool that nobody has put in; use M6"},
    {7, Group::coolant},
    {8, Group::coolant},
    {9, Group::coolant},
    {48, Group::user, overrides},
    {49, Group::user, overrides},
    {50, Group::user, overrides},
    {51, Group::user, overrides},
    {52, Group::user, overrides},
    {53, Group::user, overrides},
    {62, Group::user, outputs},
    {63, Group::user, outputs},
    {64, Group::user, outputs},
    {65, Group::user, outputs},
    {66, Group::user, outputs},
    {67, Group::user, outputs},
    {68, Group::user, outputs},
    {70, Group::user, "there are no subprograms, and so nothing to put aside"},
    {71, Group::user, "there are no subprograms, and so nothing to put aside"},
    {72, Group::user, "there are no subprograms, and so nothing to put aside"},
    {73, Group::user, "there are no subprograms, and so nothing to put aside"},
    {98, Group::user, "there are no subprograms; write the blocks out"},
    {99, Group::user, "there are no subprograms; write the blocks out"},
};

/// Entry 0 of an index is nothing.
template <std::size_t Size, std::size_t Count>
constexpr std::array<std::uint8_t, Size> index_of(const CodeEntry (&table)[Count]) {
    static_assert(Count < 255);
    std::array<std::uint8_t, Size> index{};
    for (std::size_t i = 0; i < Count; ++i) index[static_cast<std::size_t>(table[i].number)] = static_cast<std::uint8_t>(i + 1);
    return index;
}

constexpr int g_end = 1000, m_end = 200, first_user_code = 100;
constexpr auto g_index = index_of<g_end>(g_table);
constexpr auto m_index = index_of<m_end>(m_table);

constexpr auto user_codes = [] {
    std::array<CodeEntry, m_end - first_user_code> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = {first_user_code + static_cast<int>(i), Group::user, {}};
    return all;
}();

}  // namespace

const CodeEntry* find_g(int tenths) noexcept {
    if (tenths < 0 || tenths >= g_end) return nullptr;
    const auto at = g_index[static_cast<std::size_t>(tenths)];
    return at == 0 ? nullptr : &g_table[at - 1];
}

const CodeEntry* find_m(int number) noexcept {
    if (number < 0 || number >= m_end) return nullptr;
    if (number >= first_user_code) return &user_codes[static_cast<std::size_t>(number - first_user_code)];
    const auto at = m_index[static_cast<std::size_t>(number)];
    return at == 0 ? nullptr : &m_table[at - 1];
}

}  // namespace taktwerk::gcode
