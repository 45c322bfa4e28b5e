#pragma once
// The parameters of one drive: what they are as far as we know, what they shall be, and why the drive must not be enabled. Knows no order of
// requests: the schedule asks it what to read and write next and tells it what came of that. Service side.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axes/drives/xp200/drive_config.hpp"
#include "axes/drives/xp200/registers.hpp"

namespace taktwerk::axes::xp200 {

class Settings {
public:
    /// Parameters one after another; at most 8 words in one reading (9.6.2).
    struct Block {
        std::uint16_t first = 0, count = 0;
    };

    explicit Settings(const DriveConfig& config);

    /// The schedule writes it itself: nobody else may.
    [[nodiscard]] static bool owns(std::uint16_t number) noexcept;

    // --- what they are ------------------------------------------------------------------------------------------------------
    void forget() noexcept { known_ = {}; }
    /// A write is under way: until it is confirmed it may be either.
    void doubt(std::uint16_t number) noexcept { known_[number].reset(); }
    void learn(std::uint16_t first, std::span<const std::uint16_t> words) noexcept;
    [[nodiscard]] bool has(std::uint16_t number) const noexcept { return known_[number].has_value(); }
    [[nodiscard]] bool knows(std::uint16_t number, std::int64_t value) const noexcept {
        return known_[number] && *known_[number] == static_cast<std::uint16_t>(value);
    }
    /// 0 when nobody knows.
    [[nodiscard]] std::int64_t known(std::uint16_t number) const noexcept;

    // --- bringing them to what they shall be: read all, then write what differs --------------------------------------------------
    void restart() noexcept { step_ = 0; }
    /// Nothing: all are read.
    [[nodiscard]] std::optional<Block> unread() const noexcept;
    /// Nothing: all that counts at once is as it shall be.
    [[nodiscard]] std::optional<ParameterSetting> unwritten() noexcept;
    /// What was asked last is done, or refused by the drive: said by judge(), not asked for again in this session.
    void done() noexcept { ++step_; }
    /// After both: the problems, anew.
    void judge();

    // --- while it runs: what somebody may turn at the panel (3.4) ------------------------------------------------------------------
    [[nodiscard]] Block watched() const noexcept;
    /// The block watched() has been learnt. Adds to the problems; the next block's turn.
    void compare();

    /// Something else that forbids enabling it, until judge() is asked again.
    void object(std::string why);
    /// Why it must not be enabled, in words.
    [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }

private:
    [[nodiscard]] bool is_signed(std::uint16_t number) const noexcept;
    void judge_terminals();

    const DriveConfig& config_;
    std::vector<ParameterSetting> wanted_;  // those of the configuration, then our own
    std::vector<Block> blocks_;
    std::array<std::optional<std::uint16_t>, parameter_count> known_{};
    std::size_t step_ = 0, watch_ = 0;
    std::vector<std::string> problems_;
};

}  // namespace taktwerk::axes::xp200
