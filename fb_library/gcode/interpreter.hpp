#pragma once
// A program's text into what has to be done, item by item. RS274/NGC as NIST describes it (NISTIR 6556), with LinuxCNC's later words and its decisions where NIST leaves one open;
// what is different here, and why, stands in docs/gcode.md.
//
// The order inside a block is fixed, whatever the order of its words: message, feed mode, F, S, T, M6, M3 to M5, M7 to M9, user M, G4, plane, units, G40, tool length, coordinate system,
// path mode, distance mode, G10, G28, G30, G92, the motion, M0 to M2 and M30.
//
// Memory is bounded and allocated when it is made; work is linear in the bytes read. One thread. Not for the cycle: it asks its source for text.

#include <array>
#include <string_view>

#include "fb_library/gcode/block.hpp"
#include "fb_library/gcode/modal_state.hpp"
#include "fb_library/gcode/source_lines.hpp"

namespace taktwerk::gcode {

class Interpreter {
public:
    enum class Step : std::uint8_t {
        item,
        need_text,  ///< the source has nothing now: ask again later
        end,        ///< the end was handed out
        fault,      ///< fault() says what; nothing of its block was handed out, and nothing comes behind it
    };

    /// `source` outlives it.
    Interpreter(TextSource& source, const InterpreterOptions& options);

    /// `item` is written only with Step::item.
    Step next(ProgramItem& item) noexcept;

    [[nodiscard]] const Fault& fault() const noexcept { return fault_; }
    /// Of the last item, where that is a message; until the next call.
    [[nodiscard]] std::string_view message() const noexcept { return block_.message; }
    /// Valid with an item `resume`, until the next call.
    [[nodiscard]] const ProgramOutputs& resume_state() const noexcept { return resumed_; }

    /// Where the program is, in machine coordinates: the end of all blocks read so far.
    [[nodiscard]] const AxisValues& position() const noexcept { return position_; }
    [[nodiscard]] const ModalState& state() const noexcept { return state_; }
    [[nodiscard]] const ProgramOutputs& outputs() const noexcept { return outputs_; }

    struct Counts {
        std::uint32_t lines = 0;           ///< read
        std::uint32_t blocks = 0;          ///< with a word that means something
        std::uint32_t left_out = 0;        ///< by block delete
        std::uint32_t standing = 0;        ///< moves that led nowhere, and are not handed out
        std::uint32_t optional_stops = 0;  ///< M1 passed by
    };
    [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
    struct Rest {
        std::uint32_t first_line = 0, lines = 0;  ///< that are not blank
    };
    /// After Step::end: what stands behind M2 or M30 and is never carried out. Reads the rest of the text.
    [[nodiscard]] Rest rest() noexcept;

private:
    friend class BlockRun;
    enum class Phase : std::uint8_t { skipping, running, ended };

    bool emit(const ProgramItem& item) noexcept;
    Step read_block() noexcept;
    void begin_here(const Block& block) noexcept;
    Step failed(FaultKind kind, std::uint32_t line) noexcept;

    static constexpr std::size_t most_items = 16;  ///< a block has at most 14

    InterpreterOptions options_;
    SourceLines lines_;
    Block block_;
    ModalState state_;
    ProgramOutputs outputs_, resumed_;
    OffsetTable offsets_;
    AxisValues position_;
    std::array<ProgramItem, most_items> items_;
    std::size_t first_ = 0, count_ = 0;
    Phase phase_;
    Fault fault_;
    Counts counts_;
};

}  // namespace taktwerk::gcode
