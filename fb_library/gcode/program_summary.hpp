#pragma once
// A program added up, item by item: how far, how long, how much. Bounded memory but for the list of tools, which grows with the tools that occur.

#include <array>
#include <cstdint>
#include <vector>

#include "fb_library/gcode/program_item.hpp"

namespace taktwerk::gcode {

/// [mm], [deg]; along the whole path, arcs included.
struct Extent {
    double least = 0, most = 0;
    bool moved = false;  ///< whether a move led along this axis
};

class ProgramSummary {
public:
    void add(const ProgramItem& item);

    /// From the first move's start on; machine coordinates. Meaningful where moves() > 0.
    [[nodiscard]] const std::array<Extent, axis_count>& extents() const noexcept { return extents_; }
    struct Moves {
        std::uint64_t count = 0;
        double length_mm = 0;  ///< of the tool's point
    };
    [[nodiscard]] const Moves& rapids() const noexcept { return rapids_; }
    [[nodiscard]] const Moves& lines() const noexcept { return lines_; }  ///< with a feed
    [[nodiscard]] const Moves& arcs() const noexcept { return arcs_; }
    [[nodiscard]] std::uint64_t moves() const noexcept { return rapids_.count + lines_.count + arcs_.count; }

    /// At the programmed feeds, reached at once, with pauses; without rapids and without what others take to acknowledge: no machine is faster.
    [[nodiscard]] double least_seconds() const noexcept { return seconds_; }
    struct Dwells {
        std::uint64_t count = 0;
        double seconds = 0, longest = 0;
        std::uint32_t longest_line = 0;
    };
    [[nodiscard]] const Dwells& dwells() const noexcept { return dwells_; }
    struct Feeds {
        double least = 0, most = 0;  ///< mm/s; 0 and 0: none occurs
    };
    [[nodiscard]] const Feeds& feeds() const noexcept { return feeds_; }  ///< of moves with a feed in mm/s or a time
    struct Spindle {
        double least = 0, most = 0;  ///< 1/min
        bool used = false;
    };
    [[nodiscard]] const Spindle& spindle() const noexcept { return spindle_; }
    [[nodiscard]] const std::vector<std::uint32_t>& tools() const noexcept { return tools_; }  ///< put in by M6, each once, in their order
    [[nodiscard]] const std::array<std::uint64_t, 14>& handshakes() const noexcept { return handshakes_; }  ///< by Handshake::Kind
    [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }

private:
    void add_move(const Move& move);
    void add_handshake(const Handshake& handshake);
    void reach(const AxisValues& point) noexcept;

    std::array<Extent, axis_count> extents_{};
    Moves rapids_, lines_, arcs_;
    Dwells dwells_;
    Feeds feeds_;
    Spindle spindle_;
    double seconds_ = 0;
    std::vector<std::uint32_t> tools_;
    std::array<std::uint64_t, 14> handshakes_{};
    std::uint64_t messages_ = 0;
};

/// Of the tool's point along a move [mm].
[[nodiscard]] double length_of(const Move& move) noexcept;
/// Where a move is at a share (0 to 1) of its way.
[[nodiscard]] AxisValues point_of(const Move& move, double share) noexcept;

}  // namespace taktwerk::gcode
