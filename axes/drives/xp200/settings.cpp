#include "axes/drives/xp200/settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace taktwerk::axes::xp200 {

namespace {

constexpr int emergency_open = -15;  // EMG in negative logic: on while the contact is open (5.4.2)

/// What decides how the drive behaves.
constexpr Settings::Block opening_blocks[] = {{4, 1},   {25, 2},  {60, 4},  {75, 4},  {82, 1},  {97, 2},
                                              {100, 6}, {108, 4}, {120, 5}, {136, 4}, {145, 3}, {160, 7}};
/// What must not change behind our back.
constexpr Settings::Block watched_blocks[] = {{4, 1}, {25, 2}, {97, 2}, {120, 5}};

bool inside(std::uint16_t number, const Settings::Block& block) noexcept {
    return number >= block.first && number < block.first + block.count;
}

}  // namespace

Settings::Settings(const DriveConfig& config)
    : config_(config), wanted_(config.parameters), blocks_(std::begin(opening_blocks), std::end(opening_blocks)) {
    for (const auto& setting : wanted_) {
        const bool read = std::any_of(blocks_.begin(), blocks_.end(), [&](const Block& block) { return inside(setting.number, block); });
        if (!read) blocks_.push_back({setting.number, 1});
    }
    // Internal speeds count, the first of them is rest, and nothing is forced on.
    for (const auto& own : {ParameterSetting{pr::speed_source, 1},
                            {pr::torque_source, 1},
                            {pr::speed_1, 0},
                            {pr::torque_1, 0},
                            {pr::force_1, 0},
                            {pr::force_2, 0},
                            {pr::force_3, 0},
                            {pr::force_4, 0},
                            {pr::force_5, 0}})
        wanted_.push_back(own);
}

bool Settings::owns(std::uint16_t number) noexcept {
    return number == pr::acceleration_time || number == pr::deceleration_time || number == pr::torque_speed_limit ||
           (number >= pr::force_1 && number <= pr::force_5) || (number >= pr::speed_1 && number <= pr::speed_1 + 2) ||
           (number >= pr::torque_1 && number <= pr::torque_1 + 2) || number == pr::speed_source || number == pr::torque_source ||
           number == pr::forced_enable;
}

bool Settings::is_signed(std::uint16_t number) const noexcept {
    for (const auto& p : config_.profile->parameters)
        if (p.address.index == number) return p.is_signed;
    return false;
}

void Settings::learn(std::uint16_t first, std::span<const std::uint16_t> words) noexcept {
    for (std::size_t i = 0; i < words.size(); ++i)
        if (first + i < known_.size()) known_[first + i] = words[i];
}

std::int64_t Settings::known(std::uint16_t number) const noexcept {
    const auto word = known_[number].value_or(0);
    return is_signed(number) ? static_cast<std::int16_t>(word) : static_cast<std::int64_t>(word);
}

// --- opening ------------------------------------------------------------------------------------------------------------------

std::optional<Settings::Block> Settings::unread() const noexcept {
    if (step_ >= blocks_.size()) return std::nullopt;
    return blocks_[step_];
}

std::optional<ParameterSetting> Settings::unwritten() noexcept {
    for (; step_ < wanted_.size(); ++step_) {
        const auto& setting = wanted_[step_];
        if (knows(setting.number, setting.value)) continue;
        const auto& rows = config_.profile->parameters;
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& p) { return p.address.index == setting.number; });
        if (row == rows.end() || row->effect == ParameterEffect::after_restart || row->change == ParameterChange::never) continue;
        return setting;
    }
    return std::nullopt;
}

void Settings::judge() {
    problems_.clear();
    const auto say = [&](std::string text) { problems_.push_back(std::move(text)); };
    for (const auto& setting : wanted_)
        if (has(setting.number) && !knows(setting.number, setting.value))
            say(fmt::format("Pr{:03} is {} and shall be {}; it counts after a restart only: set it at the panel, save, switch off and on",
                            setting.number, known(setting.number), setting.value));
    const auto mode = known(pr::control_mode);
    if (mode != 1 && mode != 5)
        say(fmt::format(
            "Pr004 is {}: only speed control (1), or speed and torque (5), can be driven over the line. Set it, save, switch off "
            "and on [5.4.1, 9]",
            mode));
    if (4 * known(pr::encoder_lines) != config_.counts_per_turn)
        say(fmt::format("Pr082 is {} lines, which are {} counts a turn, but the axis says {} [4.2.3]", known(pr::encoder_lines),
                        4 * known(pr::encoder_lines), config_.counts_per_turn));
    if (known(pr::forced_enable) != 0) say("Pr098 is 1: the drive enables itself. Set it to 0 and save [5.4.1]");
    judge_terminals();
}

void Settings::judge_terminals() {
    bool shows_run = false, stops_open = false;
    for (std::uint16_t i = 0; i < output_count; ++i)
        shows_run = shows_run || std::abs(known(static_cast<std::uint16_t>(pr::output_function + i))) == static_cast<int>(Output::running);
    for (std::uint16_t i = 0; i < input_count; ++i)
        stops_open = stops_open || known(static_cast<std::uint16_t>(pr::input_function + i)) == emergency_open;
    if (!shows_run)
        problems_.emplace_back(
            "no output shows RUN, so nobody knows whether the drive is enabled: give one of Pr108 to Pr111 the function 9 [5.3]");
    if (config_.has_watchdog_output && !stops_open)
        problems_.emplace_back(
            "no input has the function -15 (EMG, open = stop) for the watchdog output: set one of Pr100 to Pr105 to it [5.2, 5.4.2]");
}

void Settings::object(std::string why) {
    if (std::find(problems_.begin(), problems_.end(), why) == problems_.end()) problems_.push_back(std::move(why));
}

// --- running ------------------------------------------------------------------------------------------------------------------

Settings::Block Settings::watched() const noexcept { return watched_blocks[watch_]; }

void Settings::compare() {
    for (const auto& setting : wanted_) {
        if (!inside(setting.number, watched_blocks[watch_]) || knows(setting.number, setting.value)) continue;
        if (owns(setting.number) && setting.number != pr::speed_source) continue;  // commands use it, and write it again
        object(fmt::format("Pr{:03} was changed to {} while the line was running; it shall be {}", setting.number, known(setting.number),
                           setting.value));
    }
    watch_ = (watch_ + 1) % std::size(watched_blocks);
}

}  // namespace taktwerk::axes::xp200
