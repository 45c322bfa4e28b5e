#pragma once
// Carries one block out on an Interpreter's state. Its own file because it is all there is to know about what words mean.

#include "fb_library/gcode/interpreter.hpp"

namespace taktwerk::gcode {

class BlockRun {
public:
    BlockRun(Interpreter& program, const Block& block) noexcept : program_(program), block_(block), state_(program.state_) {}

    /// False: the program's fault says why.
    bool run() noexcept;

private:
    using Group = CodeGroup;
    enum class Frame : std::uint8_t { program, machine };

    // Words: each belongs to one code.
    [[nodiscard]] bool has(char letter) const noexcept { return block_.has(letter); }
    /// Marks it as used. Fails where another code had it.
    bool take(char letter, double& value) noexcept;
    bool take_whole(char letter, double most, std::uint32_t& value) noexcept;
    bool take_axes() noexcept;
    bool all_used() noexcept;
    [[nodiscard]] std::uint32_t axis_words() const noexcept;
    [[nodiscard]] std::uint16_t first_axis_column() const noexcept;
    [[nodiscard]] std::uint16_t code_column(Group group) const noexcept { return block_.code(group).column; }
    [[nodiscard]] int g(Group group) const noexcept { return block_.number_of(group); }

    bool fail(FaultKind kind, std::uint32_t column, double a = 0, double b = 0) noexcept;
    bool fail_missing(std::uint32_t column, std::string_view what) noexcept;
    void put(Handshake::Kind kind, std::uint32_t number = 0, double value = 0, double second = 0) noexcept;
    void put_move(const Move& move) noexcept;
    [[nodiscard]] ProgramItem item(ProgramItem::Kind kind) const noexcept;

    // In the order in which they are carried out.
    bool rotary() noexcept;
    bool feed_mode() noexcept;
    bool feed() noexcept;
    bool speed_and_tool() noexcept;
    bool machine_words() noexcept;
    bool user_word() noexcept;
    bool dwell() noexcept;
    void plane_and_units() noexcept;
    bool tool_length() noexcept;
    bool path_mode() noexcept;
    void modes() noexcept;
    bool non_modal() noexcept;
    bool set_system() noexcept;
    bool to_reference(const AxisValues& reference) noexcept;
    bool set_shift() noexcept;
    bool motion() noexcept;
    bool straight(bool rapid) noexcept;
    bool arc(bool clockwise) noexcept;
    bool centre_of(PlanePoint& centre) noexcept;
    bool turns(double& more) noexcept;
    bool move_feed(const AxisValues& to, Feed& feed) noexcept;
    void stop() noexcept;

    /// What is added to a program's number to make it a machine's.
    [[nodiscard]] double zero(std::size_t axis) const noexcept;
    [[nodiscard]] double unit(std::size_t axis) const noexcept { return axis < linear_axes ? state_.unit_mm : 1; }
    bool target(Frame frame, AxisValues& to) noexcept;

    Interpreter& program_;
    const Block& block_;
    ModalState& state_;
    std::uint32_t used_ = 0;
    std::uint16_t motion_column_ = 0;
    bool axes_taken_ = false;
};

}  // namespace taktwerk::gcode
