#pragma once
// Which request goes to one drive next, and what its answer means: opening (stop it, read and set its parameters), then polling, with
// commands in between. Knows requests, no line and no thread: schedule.next() says what to ask, take() gets the answer. What the parameters
// are and shall be is kept by settings.hpp. Service side.
//
//   closed --echo--> opening: stop, disable, read settings, write settings --> running --silence--> closed
//
// Whatever ran before a silence is over before anything else counts: the drive is disabled, and until RUN has been seen off nothing is
// acknowledged and nothing enabled. A drive that keeps its power all the same is not enabled either; the problems say so. Whose power RUN shows
// in operation: power_orders.hpp.
//
// Torque control is CMODE with Pr004 = 5, chosen at standstill. Out of it: EMG first (Pr123, with Pr164 = 1 the drive brakes by Pr063 and keeps
// its power), then no torque selected, and at standstill back to speed control, whose speed 1 is rest, and out of EMG in one word.
//
// Running, of several things to do the first of: stop, disable, clear, enable, ramps, speed or torque; never more than two commands
// without looking at the position; parameters that somebody asked for when nothing else waits.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/drives/xp200/drive_config.hpp"
#include "axes/drives/xp200/drive_mailbox.hpp"
#include "axes/drives/xp200/index_pulse.hpp"
#include "axes/drives/xp200/power_orders.hpp"
#include "axes/drives/xp200/registers.hpp"
#include "axes/drives/xp200/service_queue.hpp"
#include "axes/drives/xp200/settings.hpp"
#include "modbus/client/client.hpp"

namespace taktwerk::axes::xp200 {

class Schedule {
public:
    explicit Schedule(const DriveConfig& config);

    /// Nothing: nothing to ask now (it saves, or rests after silence).
    [[nodiscard]] std::optional<modbus::Request> next(const Wish& wish, Instant now);
    void take(const modbus::Answer& answer, Instant now);
    /// A stop waits to be sent: this drive goes first.
    [[nodiscard]] bool urgent(const Wish& wish) const noexcept;

    [[nodiscard]] const Sample& sample() const noexcept { return sample_; }
    /// Why it must not be enabled, in words.
    [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return settings_.problems(); }

    // --- parameters and services, one after another -------------------------------------------------------------------------
    using Service = xp200::Service;
    /// Full: false.
    bool queue(const Service& service) { return services_.push(service); }
    /// The answer to a service, once.
    std::optional<std::pair<ServiceTicket, modbus::Answer>> served() { return services_.served(); }
    [[nodiscard]] bool saved_would_be_harmless() const noexcept;

private:
    enum class Phase : std::uint8_t { closed, stopping, disabling, reading, setting, running };
    enum class Asked : std::uint8_t { nothing, echo, parameters, write, servo, clear, position, turn, terminals, alarm, service };
    enum class Drives : std::uint8_t { speed, torque };

    std::optional<modbus::Request> open(Instant now);
    std::optional<modbus::Request> command(const Wish& wish, Instant now);
    std::optional<modbus::Request> drive(Drives what, std::int16_t value);
    modbus::Request poll(Instant now);
    void watch_settings();
    void watch_release(Instant now);
    void take_position(const modbus::Answer& answer, Instant now);
    void watch_index(Instant now);
    void show_index(Instant now);
    void follow_latch(const Wish& wish, Instant now) noexcept;
    void take_terminals(std::uint16_t inputs, std::uint16_t outputs, Instant now);
    void take_running(bool running);
    void show_running(bool running);
    void lost(Instant now);
    [[nodiscard]] modbus::Request ask(Asked what, const modbus::Request& request) noexcept;
    [[nodiscard]] modbus::Request write(std::uint16_t number, std::int64_t value) noexcept;
    [[nodiscard]] bool moves_by_itself() const noexcept;
    [[nodiscard]] bool stands() const noexcept;
    [[nodiscard]] bool may_enable(const Wish& wish) const noexcept;
    [[nodiscard]] bool drives_torque() const noexcept;
    [[nodiscard]] bool must_brake(const Wish& wish) const noexcept;
    std::optional<modbus::Request> change_mode(std::uint16_t word);

    const DriveConfig& config_;
    Phase phase_ = Phase::closed;
    Asked asked_ = Asked::nothing;
    Settings settings_;

    Sample sample_;
    std::uint32_t obeyed_ = 0;          // of the wish: nothing of it is left to be sent
    std::optional<std::uint32_t> raw_;  // position as read last
    bool doubtful_ = false;             // the last position leapt
    IndexPulse index_;
    bool rests_ = false;                       // the last two positions are the same
    std::optional<std::int64_t> single_turn_;  // read after the last position
    Instant disabled_at_{}, latch_since_{}, last_try_{}, clear_tried_{}, alarm_read_{}, terminals_read_{}, settings_read_{};
    PowerOrders orders_;
    bool look_for_alarm_ = false, read_again_ = false;
    int commands_in_a_row_ = 0, turn_ = 0;
    std::optional<std::uint16_t> selects_;  // Pr122 to be written after the value it selects

    ServiceQueue services_;
};

}  // namespace taktwerk::axes::xp200
