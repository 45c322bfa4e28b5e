#pragma once
// Who stands where on a bus in operation, by the addresses that the slaves have: those of the bring-up, those of groups, and newcomers. And
// the propagation delays that follow from it. Service side only; for buses without a ring.

#include <cstdint>
#include <optional>
#include <vector>

#include "ecat/bringup/bus.hpp"
#include "ecat/dc/propagation.hpp"

namespace taktwerk::ecat {

class CableSurvey {
public:
    /// Asks everybody. Errors: bus.no_frame, bus.no_slave (somebody came or left meanwhile).
    [[nodiscard]] Script<Result<void>> take(Bus& bus);
    /// Positions of those who are neither slaves that are always there nor in a group that is.
    [[nodiscard]] const std::vector<std::uint16_t>& newcomers() const noexcept { return newcomers_; }
    [[nodiscard]] std::size_t size() const noexcept { return seen_.size(); }
    /// All who are not always there: newcomers, and groups in operation.
    [[nodiscard]] std::uint16_t guests() const noexcept { return guests_; }
    /// An address for a newcomer, by its position. Should it be pulled in this very moment, another slave stands in its place and gets the
    /// address: that one has its own again before anybody misses it. Error bus.no_slave (it is gone).
    [[nodiscard]] Script<Result<void>> give_address(Bus& bus, std::uint16_t position, std::uint16_t station);
    /// Who stands there is this slave from now on.
    void take_for(std::uint16_t position, const BusSlave& slave) noexcept { seen_[position].slave = &slave; }
    /// Latches at all who were there when they were asked last, and writes the delay (0928h) of those whose changed. Nothing without clocks.
    [[nodiscard]] Script<Result<void>> measure_delays(Bus& bus);

private:
    struct Seen {
        std::uint16_t station = 0, dl_status = 0, features = 0;
        bool in_op = false, answered = false;
        const BusSlave* slave = nullptr;  ///< as which it is known
    };
    [[nodiscard]] static Script<void> ask(Bus& bus, std::uint16_t position, Seen& seen);
    void recognise(Bus& bus);
    [[nodiscard]] bool is_seen(const BusSlave& slave) const noexcept;
    [[nodiscard]] Script<bool> all_there(Bus& bus, std::uint16_t position);
    [[nodiscard]] Script<void> give_back(Bus& bus, std::uint16_t station);
    [[nodiscard]] static Script<void> read_latched(Bus& bus, std::uint16_t position, std::optional<LatchedTimes>& times);
    /// By position; `reference`: whose time tells whether all are of one frame.
    [[nodiscard]] Script<Result<std::vector<LatchedTimes>>> latch(Bus& bus, std::size_t reference);

    std::vector<Seen> seen_;  ///< by position
    std::vector<std::uint16_t> newcomers_;
    std::uint16_t guests_ = 0;
    std::optional<Instant> missed_since_;  ///< somebody who is always there
};

}  // namespace taktwerk::ecat
